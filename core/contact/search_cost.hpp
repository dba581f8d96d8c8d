#pragma once
#include <cstdint>

#include "core/world/balls.hpp"
#include "core/world/cell.hpp"

namespace scree::core {

/// How many balls a search with this margin looks at, m: what it costs, counted and not timed. For tests.
uint64_t candidates(const Balls& balls, const PeriodicCell& cell, double margin);

}  // namespace scree::core
