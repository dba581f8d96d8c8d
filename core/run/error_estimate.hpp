#pragma once
#include <optional>

#include "core/cycle/engine.hpp"
#include "core/run/summary.hpp"

namespace scree::core {

/// The largest relative error of the speed after an undamped impact over all phases of entry, at a step that is this
/// share (0 to 1) of the stable limit of the pair: that of a linear spring; Hertz's law has less. [any thread]
double worst_impact_error(double share);

/// What can be said of the error of a run before any reference, from the step and what limits it; absent where no
/// contact does. [one thread]
std::optional<Summary::Error> error_before_any_reference(const Engine& engine);

}  // namespace scree::core
