#include "core/contact/grid.hpp"

#include <algorithm>
#include <cmath>

namespace scree::core {

namespace {

// Far-away or non-finite coordinates must fold, not overflow.
int64_t floor_of(double value) { return std::abs(value) < 9e15 ? static_cast<int64_t>(std::floor(value)) : 0; }

}  // namespace

int64_t Grid::coordinate(double value, int axis) const { return floor_of((value - low_[axis]) / edge_[axis]); }

void Grid::build(const Balls& balls, const PeriodicCell& cell, const std::vector<uint32_t>& rows, double edge) {
  const double* at[3] = {balls[Column::x], balls[Column::y], balls[Column::z]};
  const auto most = static_cast<double>(2 * rows.size() + 27);
  double wanted[3];
  for (int axis = 0; axis < 3; ++axis) {
    double low = at[axis][rows[0]], high = low;
    for (uint32_t row : rows) {
      low = std::min(low, at[axis][row]);
      high = std::max(high, at[axis][row]);
    }
    low_[axis] = cell.periodic[axis] ? cell.low[axis] : low;
    edge_[axis] = edge;
    wanted[axis] = std::max(1.0, std::floor((high - low) / edge) + 1);
    if (cell.periodic[axis]) wanted[axis] = std::max(1.0, std::floor(cell.length(axis) / edge));
  }
  // Fold the longest axis until the number of cells follows the number of balls.
  while (!(wanted[0] * wanted[1] * wanted[2] <= most)) {
    double* longest = std::max_element(wanted, wanted + 3);
    const double rest = wanted[0] * wanted[1] * wanted[2] / *longest;
    *longest = std::isfinite(rest) ? std::max(1.0, std::min(std::floor(most / rest), std::floor(*longest / 2))) : 1.0;
  }
  for (int axis = 0; axis < 3; ++axis) {
    count_[axis] = static_cast<int64_t>(wanted[axis]);
    // On a periodic axis whole cells must fill the edge, or the wrap would skip a part of one.
    if (cell.periodic[axis]) edge_[axis] = cell.length(axis) / wanted[axis];
  }
  const auto cells = static_cast<std::size_t>(count_[0] * count_[1] * count_[2]);
  constexpr std::size_t beyond = 8;  // vectors read past the last place
  std::vector<uint32_t> cell_of(rows.size());
  begin_ = Array<uint32_t>(cells + 1);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int64_t cx = modulo(coordinate(at[0][rows[k]], 0), count_[0]);
    const int64_t cy = modulo(coordinate(at[1][rows[k]], 1), count_[1]);
    const int64_t cz = modulo(coordinate(at[2][rows[k]], 2), count_[2]);
    cell_of[k] = static_cast<uint32_t>((cz * count_[1] + cy) * count_[0] + cx);
    ++begin_[cell_of[k] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) begin_[c + 1] += begin_[c];
  rows_.resize_for_overwrite(rows.size());
  Array<uint32_t> next = begin_;
  cell_.resize_for_overwrite(rows.size());
  for (Array<double>* column : {&centre_[0], &centre_[1], &centre_[2], &radius_})
    *column = Array<double>(rows.size() + beyond);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t place = next[cell_of[k]]++;
    rows_[place] = rows[k];
    cell_[place] = cell_of[k];
    for (int axis = 0; axis < 3; ++axis) centre_[axis][place] = at[axis][rows[k]];
    radius_[place] = balls[Column::radius][rows[k]];
  }
}

}  // namespace scree::core
