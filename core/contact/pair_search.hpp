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

/// One level of the hierarchical hash: a grid that wraps around in every direction, so its size follows the number of
/// balls and not the space they spread over; balls that fold onto each other are told apart by distance.
class Grid {
 public:
  /// `rows` are the balls of this level, ascending.
  void build(const Balls& balls, const PeriodicCell& cell, const std::vector<uint32_t>& rows, double edge);
  bool empty() const { return rows_.empty(); }
  /// Calls f(row) for every ball of this level in the up to 27 cells around a point.
  template <class F>
  void around(const double point[3], F f) const;

 private:
  int64_t coordinate(double value, int axis) const;
  double edge_[3] = {1, 1, 1}, low_[3] = {0, 0, 0};
  int64_t count_[3] = {1, 1, 1};
  Array<uint32_t> begin_, rows_;
};

/// Finds the pairs whose surfaces are nearer than `margin`, for centres that lie inside the cell on periodic axes.
/// A level holds radii within a factor of two; a ball looks in its own level and in coarser ones.
PairTable find_pairs(const Balls& balls, const PeriodicCell& cell, double margin, Team& team);

/// Row order that keeps neighbours close in memory: along a Morton curve of cells with this edge, then by id.
std::vector<uint32_t> spatial_order(const Balls& balls, double edge);

}  // namespace scree::core
