#pragma once
#include <vector>

#include "core/contact/rule.hpp"
#include "core/contact/step_bound.hpp"
#include "core/world/balls.hpp"

namespace scree::core {

/// The limit of the step from each group's stiffest possible pair under any rule it may meet: what holds before
/// anything is listed.
StepBound possible_pairs(const RuleBook& book, const Balls& balls, const std::vector<Wall>& walls,
                         double local_damping);

}  // namespace scree::core
