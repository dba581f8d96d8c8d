#pragma once
#include "core/run/simulation.hpp"

namespace scree::core {

/// Refuses (exit 3, all places at once) actions of stages that name balls which set-up did not bring and no `add` will:
/// mistyped sub-groups, and sets that a saved state does not hold. Call when the balls of the start are there.
void targets_exist(const Simulation& simulation);

}  // namespace scree::core
