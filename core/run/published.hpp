#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/run/instant.hpp"
#include "core/run/simulation.hpp"

namespace scree::core {

/// What reading asks of the cycle it happens in.
struct Needs {
  bool sums = false;    ///< `engine.sums_wanted` before the forces
  bool report = false;  ///< `engine.report_wanted` before the forces
  bool pass = false;    ///< a pass over balls or contacts: too dear for every cycle
  Needs& operator|=(const Needs& other) {
    sums |= other.sums;
    report |= other.report;
    pass |= other.pass;
    return *this;
  }
  friend Needs operator|(Needs a, const Needs& b) { return a |= b; }
};

/// A number that the kernel or a process publishes.
struct Published {
  std::string unit;  ///< "" where unknown, as for what processes publish
  Needs needs;
  std::function<double()> read;
};

/// Looks a name up among what the kernel publishes and what processes have published so far. Walls, balls and contacts
/// are found anew at each reading, so that a name outlives edits; of one that is gone it reads NaN. `instant` and
/// `simulation` must outlive the answer.
std::optional<Published> find_published(const std::string& name, Simulation& simulation, Instant& instant);

/// Names for suggestions: all plain ones, those of walls, those published by processes, and, when `like` names a ball
/// or a contact, those of it.
std::vector<std::string> published_names(const Simulation& simulation, const std::string& like = "");

}  // namespace scree::core
