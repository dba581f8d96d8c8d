#pragma once
#include <cstdint>
#include <vector>

#include "core/base/array.hpp"
#include "core/base/threads.hpp"
#include "core/world/balls.hpp"
#include "core/world/cell.hpp"

namespace scree::core {

/// All pairs of balls nearer than a margin, half of them: the lower row holds the pair. Other rows are sorted.
struct PairTable {
  Array<uint64_t> begin;  ///< rows + 1
  Array<uint32_t> other;  ///< the higher row
  Array<uint8_t> image;  ///< which periodic image of the other ball: two bits per axis, 0 own, 1 plus the edge, 2 minus

  std::size_t size() const { return other.size(); }
};

/// Finds the pairs whose surfaces are nearer than `margin`, for centres that lie inside the cell on periodic axes.
/// A level holds radii within a factor of two; a ball looks in its own level and in coarser ones. The same for any
/// instruction set (as of core/base/isa.hpp) and number of threads.
PairTable find_pairs(const Balls& balls, const PeriodicCell& cell, double margin, Team& team, int isa = 0);

/// Row order that keeps neighbours close in memory: along a Morton curve of cells with this edge, then by id.
std::vector<uint32_t> spatial_order(const Balls& balls, double edge);

}  // namespace scree::core
