#pragma once
#include <cstddef>
#include <optional>

#include "core/run/quantities.hpp"

namespace scree::core {

/// The tests that may end a run action. They are looked at every `test_every` cycles counted from the action's start,
/// never at the start itself, so an action always runs. What `falls_to` and `rises_to` remember lies in
/// `Position::extreme`, one word per test, so that a resumed run goes on with it. [one thread]
class Condition {
 public:
  static constexpr uint64_t test_every = 10;  ///< cycles

  /// `action` must outlive the condition.
  Condition(Simulation& simulation, Quantities& quantities, const RunAction& action);

  bool due() const;
  Needs needs() const;
  /// Looks at the tests at the present cycle, after the forces; the index of the first that is met. Call when `due`.
  std::optional<std::size_t> met();

 private:
  bool passed(const Until& until, double value, double& extreme) const;
  Simulation& simulation_;
  Quantities& quantities_;
  const RunAction& action_;
};

}  // namespace scree::core
