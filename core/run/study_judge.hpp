#pragma once
#include "core/run/study.hpp"
#include "core/run/study_flight.hpp"
#include "core/world/cell.hpp"

namespace scree::core {

/// The largest energy residual so far, as a share of what passed through: a norm of every study that can have it.
inline constexpr const char* energy_residual = "energy.residual_share.peak";

/// Errors, references and orders of all points so far, from what their runs left. `expected` are the expectations of
/// the scene: where one has a value it is the reference, otherwise the two finest rungs are extrapolated.
void judge(Study& study, const Horizon& horizon, const std::vector<ExpectationResult>& expected,
           const PeriodicCell& cell);

}  // namespace scree::core
