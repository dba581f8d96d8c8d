#include "core/contact/pair_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/grid.hpp"
#include "core/contact/near_run.hpp"
#include "core/contact/search_cost.hpp"

namespace scree::core {

namespace {

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
  std::vector<Grid> grids;
};

Levels make_levels(const Balls& balls, const PeriodicCell& cell, double margin) {
  const std::size_t n = balls.size();
  const double* radius = balls[Column::radius];
  const auto [least, most] = std::minmax_element(radius, radius + n);
  Levels levels;
  std::vector<uint8_t> of_row(n, 0);
  if (*most > 2 * *least)
    for (std::size_t row = 0; row < n; ++row)
      of_row[row] = static_cast<uint8_t>(std::min(63, std::ilogb(radius[row] / *least)));
  std::vector<std::vector<uint32_t>> rows(64);
  std::vector<double> largest(64, 0);
  for (std::size_t row = 0; row < n; ++row) {
    rows[of_row[row]].push_back(static_cast<uint32_t>(row));
    largest[of_row[row]] = std::max(largest[of_row[row]], radius[row]);
  }
  while (rows.size() > 1 && rows.back().empty()) rows.pop_back();
  levels.grids.resize(rows.size());
  for (std::size_t level = 0; level < rows.size(); ++level)
    if (!rows[level].empty()) levels.grids[level].build(balls, cell, rows[level], 2 * largest[level] + margin);
  return levels;
}

// Image code of a separation along one axis; at most one image can be within reach, as the cell's edge was checked.
uint32_t image_of(double separation, const PeriodicCell& cell, int axis) {
  const double half = 0.5 * cell.length(axis);
  return (separation > half ? 2u : separation < -half ? 1u : 0u) << (2 * axis);
}

// The image code turned around: what the pair's lower row must add is the opposite of what the higher one must.
uint8_t opposite(uint8_t image) { return static_cast<uint8_t>(((image & 0x15u) << 1) | ((image & 0x2au) >> 1)); }

/// Calls f(place, grid, first, last, own) for the stretches of places that a place of the level looks at. `own`: they
/// are of the same level, and pairs come up from both sides.
template <class F>
void each_stretch(const Levels& levels, std::size_t level, std::size_t first, std::size_t last, F f) {
  const Grid& own = levels.grids[level];
  const bool wide = own.wide();
  for (std::size_t place = first; place < last; ++place) {
    const double point[3] = {own.centre(0)[place], own.centre(1)[place], own.centre(2)[place]};
    if (wide) own.onward(place, [&](uint32_t a, uint32_t b) { f(place, own, a, b, false); });
    for (std::size_t other = level + (wide ? 1 : 0); other < levels.grids.size(); ++other)
      if (const Grid& grid = levels.grids[other]; grid.size() > 0)
        grid.around(point, [&](uint32_t a, uint32_t b) { f(place, grid, a, b, other == level); });
  }
}

/// Looks for pairs from places of one level.
class Search {
 public:
  Search(const Balls& balls, const PeriodicCell& cell, double margin, int isa)
      : cell_(cell), near_(near_stage(isa)), at_{balls[Column::x], balls[Column::y], balls[Column::z]} {
    for (int axis = 0; axis < 3; ++axis) {
      run_.edge[axis] = cell.periodic[axis] ? cell.length(axis) : 0.0;
      run_.half[axis] = cell.periodic[axis] ? 0.5 * cell.length(axis) : std::numeric_limits<double>::infinity();
    }
    run_.margin = margin;
  }
  void look(const Levels& levels, std::size_t level, std::size_t first, std::size_t last, Hits& hits);

 private:
  void add(uint32_t me, uint32_t other, Hits& hits) const;
  const PeriodicCell& cell_;
  const NearStage near_;
  const double* at_[3];
  NearRun run_{};
};

void Search::add(uint32_t me, uint32_t other, Hits& hits) const {
  uint8_t image = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (cell_.periodic[axis])
      image = static_cast<uint8_t>(image | image_of(at_[axis][other] - at_[axis][me], cell_, axis));
  if (me < other)
    hits.add(me, other, image);
  else
    hits.add(other, me, opposite(image));
}

void Search::look(const Levels& levels, std::size_t level, std::size_t first, std::size_t last, Hits& hits) {
  const Grid& own = levels.grids[level];
  uint32_t found[NearRun::most];
  each_stretch(levels, level, first, last,
               [&](std::size_t place, const Grid& grid, uint32_t a, uint32_t b, bool twice) {
                 const uint32_t me = own.row(place);
                 for (int axis = 0; axis < 3; ++axis) run_.at[axis] = own.centre(axis)[place];
                 run_.own = own.radius()[place];
                 for (; a < b; a += NearRun::most) {
                   run_.x = grid.centre(0) + a;
                   run_.y = grid.centre(1) + a;
                   run_.z = grid.centre(2) + a;
                   run_.radius = grid.radius() + a;
                   run_.count = std::min(NearRun::most, b - a);
                   const uint32_t n = near_(run_, found);
                   for (uint32_t k = 0; k < n; ++k) {
                     const uint32_t other = grid.row(a + found[k]);
                     if (!twice || other > me) add(me, other, hits);
                   }
                 }
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

PairTable find_pairs(const Balls& balls, const PeriodicCell& cell, double margin, Team& team, int isa) {
  const std::size_t n = balls.size();
  if (n == 0) return by_row({}, 0);
  constexpr std::size_t part = 1024;
  struct Part {
    std::size_t level, first, last;
  };
  std::vector<Part> parts;
  std::vector<Hits> hits;
  {
    const Levels levels = make_levels(balls, cell, margin);
    for (std::size_t level = 0; level < levels.grids.size(); ++level)
      for (std::size_t first = 0; first < levels.grids[level].size(); first += part)
        parts.push_back({level, first, std::min(levels.grids[level].size(), first + part)});
    hits.resize(parts.size());
    team.each_block(parts.size(), [&](std::size_t p) {
      hits[p].reserve(part * 5);  // a dense packing lists between four and five pairs a ball
      Search(balls, cell, margin, isa).look(levels, parts[p].level, parts[p].first, parts[p].last, hits[p]);
    });
  }
  PairTable table = by_row(std::move(hits), n);
  team.each_block((n + part - 1) / part, [&](std::size_t p) {
    for (std::size_t row = p * part; row < std::min(n, (p + 1) * part); ++row) sort_row(table, row);
  });
  return table;
}

uint64_t candidates(const Balls& balls, const PeriodicCell& cell, double margin) {
  uint64_t count = 0;
  if (balls.size() == 0) return 0;
  const Levels levels = make_levels(balls, cell, margin);
  for (std::size_t level = 0; level < levels.grids.size(); ++level)
    each_stretch(levels, level, 0, levels.grids[level].size(),
                 [&](std::size_t, const Grid&, uint32_t first, uint32_t last, bool) { count += last - first; });
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
