#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "core/run/simulation.hpp"
#include "core/run/study.hpp"

namespace scree::core {

/// The energy residual over the cycles of a run, at a few hundred of them. Reading it costs a pass over the contacts,
/// so it is read the more seldom the longer the run is.
class ResidualTrace {
 public:
  void look(Simulation& simulation);
  /// (cycle, share of what passed through), in order.
  const std::vector<std::pair<double, double>>& points() const { return points_; }

 private:
  static constexpr std::size_t most = 400;
  uint64_t every_ = 10, last_ = ~uint64_t{0};
  std::vector<std::pair<double, double>> points_;
};

/// What the traces of the first run of each point say.
std::vector<StudyDrift> drifts(const Study& study);

}  // namespace scree::core
