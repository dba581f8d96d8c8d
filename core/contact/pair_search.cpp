#include "core/contact/pair_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/search_cost.hpp"

namespace scree::core {

namespace {

int64_t modulo(int64_t value, int64_t count) {
  const int64_t rest = value % count;
  return rest < 0 ? rest + count : rest;
}

// Far-away or non-finite coordinates must fold, not overflow.
int64_t floor_of(double value) { return std::abs(value) < 9e15 ? static_cast<int64_t>(std::floor(value)) : 0; }

/// Pairs found by one part of the rows, as columns: all parts together are the largest thing a rebuild holds.
struct Hits {
  std::vector<uint32_t> low, high;
  std::vector<uint8_t> image;

  void reserve(std::size_t n) {
    low.reserve(n);
    high.reserve(n);
    image.reserve(n);
  }
  void add(uint32_t a, uint32_t b, uint8_t code) {
    low.push_back(a);
    high.push_back(b);
    image.push_back(code);
  }
};

struct Levels {
  std::vector<uint8_t> of_row;
  std::vector<Grid> grids;
};

Levels make_levels(const Balls& balls, const PeriodicCell& cell, double margin) {
  const std::size_t n = balls.size();
  const double* radius = balls[Column::radius];
  const auto [least, most] = std::minmax_element(radius, radius + n);
  Levels levels;
  levels.of_row.assign(n, 0);
  if (*most > 2 * *least)
    for (std::size_t row = 0; row < n; ++row)
      levels.of_row[row] = static_cast<uint8_t>(std::min(63, std::ilogb(radius[row] / *least)));
  std::vector<std::vector<uint32_t>> rows(64);
  std::vector<double> largest(64, 0);
  for (std::size_t row = 0; row < n; ++row) {
    rows[levels.of_row[row]].push_back(static_cast<uint32_t>(row));
    largest[levels.of_row[row]] = std::max(largest[levels.of_row[row]], radius[row]);
  }
  while (rows.size() > 1 && rows.back().empty()) rows.pop_back();
  levels.grids.resize(rows.size());
  for (std::size_t level = 0; level < rows.size(); ++level)
    if (!rows[level].empty()) levels.grids[level].build(balls, cell, rows[level], 2 * largest[level] + margin);
  return levels;
}

// Image of a separation along one axis; at most one image can be within reach, as the cell's edge was checked.
double nearest_image(double separation, const PeriodicCell& cell, int axis, uint8_t& image) {
  if (!cell.periodic[axis]) return separation;
  const double edge = cell.length(axis);
  const int shift = 2 * axis;
  if (separation > 0.5 * edge) {
    image = static_cast<uint8_t>(image | (2u << shift));
    return separation - edge;
  }
  if (separation < -0.5 * edge) {
    image = static_cast<uint8_t>(image | (1u << shift));
    return separation + edge;
  }
  return separation;
}

// The image code turned around: what the pair's lower row must add is the opposite of what the higher one must.
uint8_t opposite(uint8_t image) { return static_cast<uint8_t>(((image & 0x15u) << 1) | ((image & 0x2au) >> 1)); }

/// Calls f(row, point, other, own) for every ball that the rows look at; `own`: it is of the same level, where each
/// pair comes up from both sides.
template <class F>
void each_candidate(const Balls& balls, const Levels& levels, std::size_t first, std::size_t last, F f) {
  const double *x = balls[Column::x], *y = balls[Column::y], *z = balls[Column::z];
  for (std::size_t row = first; row < last; ++row) {
    const double point[3] = {x[row], y[row], z[row]};
    for (std::size_t level = levels.of_row[row]; level < levels.grids.size(); ++level) {
      if (levels.grids[level].empty()) continue;
      const bool own = level == levels.of_row[row];
      levels.grids[level].around(point, [&](uint32_t other) { f(row, point, other, own); });
    }
  }
}

void search_rows(const Balls& balls, const PeriodicCell& cell, double margin, const Levels& levels, std::size_t first,
                 std::size_t last, Hits& hits) {
  const double *x = balls[Column::x], *y = balls[Column::y], *z = balls[Column::z], *radius = balls[Column::radius];
  each_candidate(balls, levels, first, last, [&](std::size_t row, const double* point, uint32_t other, bool own) {
    if (own && other <= row) return;
    uint8_t image = 0;
    const double dx = nearest_image(x[other] - point[0], cell, 0, image);
    const double dy = nearest_image(y[other] - point[1], cell, 1, image);
    const double dz = nearest_image(z[other] - point[2], cell, 2, image);
    const double limit = radius[row] + margin + radius[other];
    if (dx * dx + dy * dy + dz * dz >= limit * limit) return;
    const auto me = static_cast<uint32_t>(row);
    if (me < other)
      hits.add(me, other, image);
    else
      hits.add(other, me, opposite(image));
  });
}

PairTable by_row(std::vector<Hits> hits, std::size_t rows) {
  PairTable table;
  table.begin.resize(rows + 1);
  for (const Hits& part : hits)
    for (uint32_t low : part.low) ++table.begin[low + 1];
  for (std::size_t row = 0; row < rows; ++row) table.begin[row + 1] += table.begin[row];
  const std::size_t total = rows == 0 ? 0 : table.begin[rows];
  table.other.resize_for_overwrite(total);
  table.image.resize_for_overwrite(total);
  Array<uint64_t> next = table.begin;
  for (Hits& part : hits) {
    for (std::size_t k = 0; k < part.low.size(); ++k) {
      const uint64_t slot = next[part.low[k]]++;
      table.other[slot] = part.high[k];
      table.image[slot] = part.image[k];
    }
    part = Hits();
  }
  return table;
}

void sort_row(PairTable& table, std::size_t row) {
  // Insertion sort: rows are short and nearly sorted; a row as long as a giant ball's takes the general way.
  const uint64_t first = table.begin[row], last = table.begin[row + 1];
  if (last - first > 64) {
    std::vector<std::pair<uint32_t, uint8_t>> order;
    for (uint64_t k = first; k < last; ++k) order.emplace_back(table.other[k], table.image[k]);
    std::sort(order.begin(), order.end());
    for (uint64_t k = first; k < last; ++k) {
      table.other[k] = order[k - first].first;
      table.image[k] = order[k - first].second;
    }
    return;
  }
  for (uint64_t k = first + 1; k < last; ++k) {
    const uint32_t other = table.other[k];
    const uint8_t image = table.image[k];
    uint64_t at = k;
    for (; at > first && table.other[at - 1] > other; --at) {
      table.other[at] = table.other[at - 1];
      table.image[at] = table.image[at - 1];
    }
    table.other[at] = other;
    table.image[at] = image;
  }
}

// Spreads the low 21 bits so that two zero bits follow each.
uint64_t spread(uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffffULL;
  bits = (bits | bits << 16) & 0x1f0000ff0000ffULL;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fULL;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3ULL;
  return (bits | bits << 2) & 0x1249249249249249ULL;
}

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
  for (std::size_t k = 0; k < rows.size(); ++k) rows_[next[cell_of[k]]++] = rows[k];
}

template <class F>
void Grid::around(const double point[3], F f) const {
  int64_t base[3], span[3];
  for (int axis = 0; axis < 3; ++axis) {
    // An axis of one or two cells is visited once, not three times.
    span[axis] = std::min<int64_t>(3, count_[axis]);
    base[axis] = coordinate(point[axis], axis) - (span[axis] == 3 ? 1 : 0);
  }
  for (int64_t a = 0; a < span[2]; ++a) {
    const int64_t z = modulo(base[2] + a, count_[2]);
    for (int64_t b = 0; b < span[1]; ++b) {
      const int64_t y = modulo(base[1] + b, count_[1]);
      for (int64_t c = 0; c < span[0]; ++c) {
        const auto index = static_cast<std::size_t>((z * count_[1] + y) * count_[0] + modulo(base[0] + c, count_[0]));
        for (uint32_t k = begin_[index]; k < begin_[index + 1]; ++k) f(rows_[k]);
      }
    }
  }
}

PairTable find_pairs(const Balls& balls, const PeriodicCell& cell, double margin, Team& team) {
  const std::size_t n = balls.size();
  if (n == 0) return by_row({}, 0);
  const Levels levels = make_levels(balls, cell, margin);
  constexpr std::size_t part = 1024;
  const std::size_t parts = (n + part - 1) / part;
  std::vector<Hits> hits(parts);
  team.each_block(parts, [&](std::size_t p) {
    hits[p].reserve(part * 5);  // a dense packing lists between four and five pairs a ball
    search_rows(balls, cell, margin, levels, p * part, std::min(n, (p + 1) * part), hits[p]);
  });
  PairTable table = by_row(std::move(hits), n);
  team.each_block(parts, [&](std::size_t p) {
    for (std::size_t row = p * part; row < std::min(n, (p + 1) * part); ++row) sort_row(table, row);
  });
  return table;
}

uint64_t candidates(const Balls& balls, const PeriodicCell& cell, double margin) {
  uint64_t count = 0;
  if (balls.size() > 0)
    each_candidate(balls, make_levels(balls, cell, margin), 0, balls.size(),
                   [&](std::size_t, const double*, uint32_t, bool) { ++count; });
  return count;
}

std::vector<uint32_t> spatial_order(const Balls& balls, double edge) {
  const std::size_t n = balls.size();
  const double* at[3] = {balls[Column::x], balls[Column::y], balls[Column::z]};
  double low[3] = {0, 0, 0};
  for (int axis = 0; axis < 3 && n > 0; ++axis) low[axis] = *std::min_element(at[axis], at[axis] + n);
  struct Key {
    uint64_t cell, id;
    uint32_t row;
  };
  std::vector<Key> keys(n);
  for (std::size_t row = 0; row < n; ++row) {
    uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double c = std::floor((at[axis][row] - low[axis]) / edge);
      const uint64_t bits = c < 2097151.0 ? static_cast<uint64_t>(std::max(0.0, c)) : 2097151u;
      code |= spread(bits) << axis;
    }
    keys[row] = {code, balls.id()[row], static_cast<uint32_t>(row)};
  }
  const auto before = [](const Key& a, const Key& b) { return a.cell != b.cell ? a.cell < b.cell : a.id < b.id; };
  if (!std::is_sorted(keys.begin(), keys.end(), before)) std::sort(keys.begin(), keys.end(), before);
  std::vector<uint32_t> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = keys[k].row;
  return order;
}

}  // namespace scree::core
