#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/array.hpp"
#include "core/world/balls.hpp"
#include "core/world/cell.hpp"

namespace scree::core {

/// One level of the hierarchical hash: a grid that wraps around in every direction, so its size follows the number of
/// balls and not the space they spread over; balls that fold onto each other are told apart by distance. Balls of a
/// cell lie one behind the other, and so do the cells along x.
class Grid {
 public:
  /// `rows` are the balls of this level, ascending.
  void build(const Balls& balls, const PeriodicCell& cell, const std::vector<uint32_t>& rows, double edge);
  std::size_t size() const { return rows_.size(); }
  uint32_t row(std::size_t place) const { return rows_[place]; }
  /// Centre and radius by place, m; readable up to eight places beyond the last.
  const double* centre(int axis) const { return centre_[axis].data(); }
  const double* radius() const { return radius_.data(); }

  /// Calls f(first, last) for the stretches of places in the up to 27 cells around a point.
  template <class F>
  void around(const double point[3], F f) const;
  /// Whether no cell is its own neighbour, nor twice another's.
  bool wide() const { return *std::min_element(count_, count_ + 3) >= 3; }
  /// Of a wide grid: the stretches around a place so that two places meet once, whichever is asked about.
  template <class F>
  void onward(std::size_t place, F f) const;

 private:
  static int64_t modulo(int64_t value, int64_t count) {
    const int64_t rest = value % count;
    return rest < 0 ? rest + count : rest;
  }
  int64_t coordinate(double value, int axis) const;
  /// The cells from x - 1 to x + 1 of a line of cells.
  template <class F>
  void three(std::size_t line, int64_t x, F f) const;
  std::size_t line(int64_t y, int64_t z) const {
    return static_cast<std::size_t>((modulo(z, count_[2]) * count_[1] + modulo(y, count_[1])) * count_[0]);
  }
  double edge_[3] = {1, 1, 1}, low_[3] = {0, 0, 0};
  int64_t count_[3] = {1, 1, 1};
  Array<uint32_t> begin_, rows_, cell_;  ///< by cell, place and place
  Array<double> centre_[3], radius_;
};

template <class F>
void Grid::three(std::size_t line, int64_t x, F f) const {
  const auto at = line + static_cast<std::size_t>(x), last = line + static_cast<std::size_t>(count_[0] - 1);
  const bool low = x == 0, high = x == count_[0] - 1;
  f(begin_[low ? at : at - 1], begin_[high ? at + 1 : at + 2]);
  if (low) f(begin_[last], begin_[last + 1]);
  if (high) f(begin_[line], begin_[line + 1]);
}

template <class F>
void Grid::around(const double point[3], F f) const {
  int64_t base[3], span[3];
  for (int axis = 0; axis < 3; ++axis) {
    // An axis of one or two cells is visited once, not three times.
    span[axis] = std::min<int64_t>(3, count_[axis]);
    base[axis] = coordinate(point[axis], axis) - (span[axis] == 3 ? 1 : 0);
  }
  for (int64_t a = 0; a < span[2]; ++a)
    for (int64_t b = 0; b < span[1]; ++b) {
      const std::size_t cells = line(base[1] + b, base[2] + a);
      if (span[0] == 3)
        three(cells, modulo(base[0] + 1, count_[0]), f);
      else
        f(begin_[cells], begin_[cells + static_cast<std::size_t>(span[0])]);
    }
}

template <class F>
void Grid::onward(std::size_t place, F f) const {
  const std::size_t cell = cell_[place], nx = static_cast<std::size_t>(count_[0]),
                    ny = static_cast<std::size_t>(count_[1]);
  const auto x = static_cast<int64_t>(cell % nx), y = static_cast<int64_t>(cell / nx % ny),
             z = static_cast<int64_t>(cell / nx / ny);
  const std::size_t own = line(y, z);
  const auto after = static_cast<uint32_t>(place + 1);
  if (x + 1 < count_[0]) {
    f(after, begin_[cell + 2]);
  } else {
    f(after, begin_[cell + 1]);
    f(begin_[own], begin_[own + 1]);
  }
  three(line(y + 1, z), x, f);
  for (const int64_t way : {-1, 0, 1}) three(line(y + way, z + 1), x, f);
}

}  // namespace scree::core
