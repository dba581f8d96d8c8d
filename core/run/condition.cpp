#include "core/run/condition.hpp"

#include <cmath>

namespace scree::core {

Condition::Condition(Simulation& simulation, Quantities& quantities, const RunAction& action)
    : simulation_(simulation), quantities_(quantities), action_(action) {}

bool Condition::due() const {
  const uint64_t gone = simulation_.engine.clock.cycle - simulation_.position.start_cycle;
  return !action_.until.empty() && gone > 0 && gone % test_every == 0;
}

Needs Condition::needs() const {
  Needs sum;
  for (const Until& until : action_.until) sum |= quantities_.needs(*until.quantity);
  return sum;
}

/// A value that is not a number fulfils nothing. Shares are taken of positive extremes only: a share of zero or of a
/// negative number would be met at once.
bool Condition::passed(const Until& until, double value, double& extreme) const {
  switch (until.test) {
    case Until::Test::below:
      return value < until.value;
    case Until::Test::above:
      return value > until.value;
    case Until::Test::falls_to:
      if (!std::isnan(value) && (std::isnan(extreme) || value > extreme)) extreme = value;
      return extreme > 0 && value <= until.value * extreme;
    case Until::Test::rises_to:
      if (value > 0 && (std::isnan(extreme) || value < extreme)) extreme = value;
      return extreme > 0 && value >= until.value * extreme;
  }
  return false;
}

std::optional<std::size_t> Condition::met() {
  std::vector<double>& extreme = simulation_.position.extreme;
  extreme.resize(action_.until.size(), std::nan(""));
  std::optional<std::size_t> first;
  for (std::size_t k = 0; k < action_.until.size(); ++k) {
    const Until& until = action_.until[k];
    if (passed(until, quantities_.value(*until.quantity), extreme[k]) && !first) first = k;
  }
  return first;
}

}  // namespace scree::core
