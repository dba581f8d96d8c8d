#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/contact/contacts.hpp"

// Bonds of all contacts: making them, dropping them, and what broke.

namespace scree::core {

namespace {

double gap_of(const Balls& balls, const PeriodicCell& cell, std::size_t low, std::size_t high, uint8_t image) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double* x = balls[static_cast<Column>(static_cast<int>(Column::x) + axis)];
    const uint32_t code = (static_cast<uint32_t>(image) >> (2 * axis)) & 3u;
    const double edge = code == 0 ? 0.0 : code == 1 ? cell.length(axis) : -cell.length(axis);
    const double apart = x[high] - x[low] + edge;
    square += apart * apart;
  }
  return std::sqrt(square) - (balls[Column::radius][low] + balls[Column::radius][high]);
}

}  // namespace

uint64_t Contacts::bond(const BondOrder& order, const Balls& balls, const std::vector<Wall>& walls,
                        const PeriodicCell& cell, Team& team) {
  const std::size_t n = balls.size();
  double largest = 0;
  for (std::size_t row = 0; row < n; ++row) largest = std::max(largest, balls[Column::radius][row]);
  const PairTable pairs = find_pairs(balls, cell, std::max(0.0, order.gap) + 1e-9 * largest, team, isa);
  const uint16_t* group = balls.group();
  const uint64_t* id = balls.id();
  const std::size_t rules = book.rules.size(), before = fresh_.size() + fresh_walls_.size();
  const auto bonded_already = [&](uint32_t low, uint32_t high) {
    for (std::size_t k = rules; k < lists_.size(); ++k)
      if (const uint32_t slot = find_slot(lists_[k], low, high); slot != no_slot && lists_[k].broken[slot] == 0)
        return true;
    return false;
  };
  for (std::size_t row = 0; row < n; ++row)
    for (uint64_t k = pairs.begin[row]; k < pairs.begin[row + 1]; ++k) {
      const auto low = static_cast<uint32_t>(row);
      const uint32_t high = pairs.other[k];
      if (book.balls(group[low], group[high]) != order.rule) continue;
      const double sum = balls[Column::radius][low] + balls[Column::radius][high];
      if (gap_of(balls, cell, low, high, pairs.image[k]) > order.gap + BondOrder::touching * sum) continue;
      if (order.chosen && !order.chosen(group[low], group[high])) continue;
      if (!order.again && breaks.count({std::min(id[low], id[high]), std::max(id[low], id[high])}) != 0) continue;
      if (bonded_already(low, high)) continue;
      fresh_.push_back({order.rule, low, high});
    }
  bond_walls(order, balls, walls);
  const std::size_t made = fresh_.size() + fresh_walls_.size() - before;
  if (made > 0) built_ = false;
  return made;
}

void Contacts::drop_bonds(std::size_t rule) {
  for (TouchList& list : lists_) {
    if (!list.bonded || list.rule != rule) continue;
    const uint16_t of = list.rule;
    list = TouchList();
    list.rule = of;
    list.bonded = true;
  }
  std::erase_if(wall_lists_, [&](const WallList& list) { return list.bonded && list.rule == rule; });
  built_ = false;
}

std::vector<Break> Contacts::take_breaks() {
  std::vector<Break> all;
  for (std::vector<Break>& block : broke_) {
    all.insert(all.end(), block.begin(), block.end());
    block.clear();
  }
  std::sort(all.begin(), all.end(), [](const Break& a, const Break& b) {
    return std::tie(a.ids, a.wall, a.patch) < std::tie(b.ids, b.wall, b.patch);
  });
  for (const Break& one : all) {
    if (one.wall == no_wall_index)
      ++breaks[one.ids];
    else
      ++wall_breaks[{one.ids.first, one.wall, one.patch}];
    ++broken_bonds[one.mode == 1 ? 0 : 1];
  }
  return all;
}

uint64_t Contacts::bonded() const {
  uint64_t sum = 0;
  for (const TouchList& list : lists_)
    for (std::size_t k = 0; k < list.broken.size(); ++k) sum += list.broken[k] == 0;
  for (const WallList& list : wall_lists_) sum += list.bonds.size();
  return sum;
}

}  // namespace scree::core
