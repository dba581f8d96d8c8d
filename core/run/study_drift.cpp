#include "core/run/study_drift.hpp"

#include <cmath>

#include "core/run/study_statistics.hpp"

namespace scree::core {

void ResidualTrace::look(Simulation& simulation) {
  Engine& engine = simulation.engine;
  const uint64_t cycle = engine.clock.cycle;
  if (!engine.ledger.on || cycle == 0 || cycle == last_ || cycle % every_ != 0) return;
  last_ = cycle;
  points_.emplace_back(static_cast<double>(cycle), engine.ledger.residual_share(engine.stored_energy()));
  if (points_.size() < most) return;
  // Twice as far apart from now on: of those that are there every second one stays.
  every_ *= 2;
  std::erase_if(points_, [this](const auto& point) { return static_cast<uint64_t>(point.first) % every_ != 0; });
}

std::vector<StudyDrift> drifts(const Study& study) {
  std::vector<StudyDrift> out;
  for (const StudyPoint& point : study.points) {
    if (!point.done()) continue;
    const StudyRun& run = point.runs[0];
    const std::optional<Slope> found = slope_of(run.residual);
    if (found && std::isfinite(found->slope))
      out.push_back({point.name, 1e6 * found->slope, 1e6 * found->interval, run.cycles});
  }
  return out;
}

}  // namespace scree::core
