#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/run/simulation.hpp"

namespace scree::core {

/// What a scene opens, runs, stores and leaves out, with the reasons.
struct Explanation {
  struct Opened {
    std::string kind, name, version, file;
  };
  struct Phase {
    std::string name;
    std::vector<std::string> steps;
  };
  struct Stored {
    std::string name, reason;
    std::size_t bytes = 0;  ///< of one ball or contact
  };
  struct RuleStorage {
    std::string rule, model;
    uint64_t listed = 0;  ///< ball-ball pairs in its list, touching or not
    std::vector<Stored> parts;
  };
  struct Step {
    double used = 0;   ///< s
    double bound = 0;  ///< s, without the safety share; 0: nothing limits it
    bool automatic = true;
    std::string governed_by;
  };
  struct StageLength {
    std::string name;
    std::optional<uint64_t> cycles;  ///< absent when no length is known
    bool at_most = false;            ///< a test may end it earlier
  };
  struct Memory {
    uint64_t balls = 0, contacts = 0;  ///< bytes that the kernel's columns and lists hold now
    uint64_t dense = 0;                ///< the same in a dense packing of these balls, with a list rebuild under way
  };

  std::string scene;
  uint64_t balls = 0, walls = 0, listed = 0;
  std::size_t plugins_found = 0;
  std::vector<Opened> plugins;
  std::vector<Phase> cycle;
  std::vector<Stored> per_ball, per_wall_contact;
  std::vector<RuleStorage> per_contact;
  std::vector<std::string> left_out;  ///< each "what: why"
  std::optional<Step> step;           ///< absent while there is nothing to take it from
  std::vector<StageLength> stages;
  Memory memory;
};

/// Brings a simulation that is set up to where its first cycle would begin: the edits that come before the first run of
/// the stages, columns, the first lists and the step. Everything a run refuses before its first cycle is refused here.
void stand_before_first_cycle(Simulation& simulation);

/// Reads only: the simulation may be anywhere in its run.
Explanation explain(const Simulation& simulation);

/// What the simulation does not do or store, each "what: why"; also in summary.json.
std::vector<std::string> left_out(const Simulation& simulation);

std::string to_text(const Explanation& explanation);
std::string to_json(const Explanation& explanation);

}  // namespace scree::core
