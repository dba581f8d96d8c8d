#pragma once
#include <string>
#include <vector>

#include "core/cycle/engine.hpp"

namespace scree::core {

/// What doubles cannot hold far from the origin. A free ball whose position is coarser than 1e-8 of its radius, and one
/// that a cycle should move and does not, are each a sentence for the log; a position coarser than 1e-6 of the radius
/// is no longer small beside an overlap and is refused (exit 3) unless the scene says `unsafe`. `net_force`: the size
/// of the whole force on every ball, N.
std::vector<std::string> far_away(const Engine& engine, const std::vector<double>& net_force);

}  // namespace scree::core
