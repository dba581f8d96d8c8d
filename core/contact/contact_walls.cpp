#include <algorithm>
#include <tuple>

#include "core/base/crash_note.hpp"
#include "core/contact/contacts.hpp"

// Contacts with walls: their lists, the pass over those of a block, and which are bonded.

namespace scree::core {

void Contacts::run_walls(std::size_t block, const Balls& balls, const std::vector<Wall>& walls,
                         const PassOptions& options, Excess& worst, Scratch& s) {
  const BallView view(balls);
  const std::size_t begin = wall_first_[block], end = wall_first_[block + 1];
  for (std::size_t k = begin; k < end; ++k) {
    WallList& list = wall_lists_[k];
    const BoundRule& rule = book.rules[list.rule];
    const WallPass pass{&view,
                        balls.id(),
                        &walls[list.wall],
                        &rule,
                        block * block_rows,
                        slices_.slice(block),
                        slices_.stride(),
                        options.dt,
                        options.overlap_limit,
                        options.sums,
                        options.report,
                        options.cycle,
                        options.energy ? &block_energy_[block] : nullptr,
                        bonds_beside(wall_lists_, k),
                        &wall_breaks,
                        &broke_[block]};
    crash_note = {rule.model_name.c_str(), rule.name.c_str(), options.cycle, block};
    const std::size_t broken = broke_[block].size();
    const WallExcess excess = run_wall_list(list, pass, s);
    if (excess.slot >= 0 && !worst.found) {
      const uint32_t row = list.slots[static_cast<std::size_t>(excess.slot)].row;
      const double r = view.radius[row];
      worst = {true,           rule.name, rule.model_name, balls.id()[row], 0, walls[list.wall].name,
               excess.overlap, r,         excess.useless,  excess.value};
    }
    if (broke_[block].size() == broken) continue;
    WallList* touch = nullptr;
    for (std::size_t other = begin; other < k; ++other)
      if (!wall_lists_[other].bonded && wall_lists_[other].wall == list.wall && wall_lists_[other].rule == list.rule)
        touch = &wall_lists_[other];
    release_broken(list, touch, rule, view, block_energy_[block]);
  }
}

double Contacts::wall_stiffness(std::size_t wall, const Balls& balls, const std::vector<Wall>& walls) {
  if (!built_) return 0;
  if (scratch_.empty()) scratch_.resize(1);  // a resumed run may ask before its first pass
  const BallView view(balls);
  double sum = 0;
  for (std::size_t k = 0; k < wall_lists_.size(); ++k) {
    const WallList& list = wall_lists_[k];
    if (list.wall != wall || book.rules[list.rule].model == nullptr) continue;
    const WallPass pass{
        &view, balls.id(), &walls[wall], &book.rules[list.rule],       0,           nullptr, 0, 0, 1, false,
        false, 0,          nullptr,      bonds_beside(wall_lists_, k), &wall_breaks};
    sum += wall_list_stiffness(list, pass, scratch_[0]);
  }
  return sum;
}

void Contacts::rebuild_wall_lists(const Balls& balls, const std::vector<Wall>& walls,
                                  const std::vector<uint32_t>& new_row, double skin, Team& team) {
  const std::size_t blocks = (balls.size() + block_rows - 1) / block_rows;
  std::vector<std::vector<WallList>> fresh(blocks);
  const BallView view(balls);
  team.each_block(blocks, [&](std::size_t block) {
    const std::size_t first = block * block_rows, last = std::min(balls.size(), first + block_rows);
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const std::vector<uint32_t> near = wall_candidates(view, walls[w], first, last, skin + book.reach());
      for (std::size_t rule = 0; rule < book.rules.size() && !near.empty(); ++rule) {
        if (book.rules[rule].model == nullptr) continue;
        WallList list;
        list.block = static_cast<uint32_t>(block);
        list.wall = static_cast<uint16_t>(w);
        list.rule = static_cast<uint16_t>(rule);
        for (uint32_t row : near)
          if (book.wall(balls.group()[row], list.wall) == rule) list.candidates.push_back(row);
        if (!list.candidates.empty()) fresh[block].push_back(std::move(list));
      }
    }
  });
  std::vector<WallList> old;
  old.swap(wall_lists_);
  for (WallList& list : rebuilt_wall_bonds(old, fresh_walls_, {&balls, &walls, &book, &new_row, &wall_breaks})) {
    auto& part = fresh[list.block];
    const auto key = [](const WallList& one) { return std::tuple(one.wall, one.bonded, one.rule); };
    const auto at = std::upper_bound(part.begin(), part.end(), list,
                                     [&](const WallList& a, const WallList& b) { return key(a) < key(b); });
    part.insert(at, std::move(list));
  }
  fresh_walls_.clear();
  wall_first_.assign(1, 0);
  for (auto& part : fresh) {
    for (WallList& list : part) wall_lists_.push_back(std::move(list));
    wall_first_.push_back(wall_lists_.size());
  }
  give_wall_slots(old, new_row);
}

// What wall contacts remember goes to the list that now holds their row; those that are bonded now have it already.
void Contacts::give_wall_slots(const std::vector<WallList>& old, const std::vector<uint32_t>& new_row) {
  struct Kept {
    std::size_t to;
    WallSlot slot;
    const double *state, *property;
  };
  std::vector<Kept> kept;
  for (const WallList& list : old) {
    const BoundRule& rule = book.rules[list.rule];
    const std::size_t words = rule.state_words(), varying = rule.varying.size();
    if (list.bonded || list.state.size() != list.slots.size() * words ||
        list.property.size() != list.slots.size() * varying)
      continue;
    for (std::size_t k = 0; k < list.slots.size(); ++k) {
      WallSlot slot = list.slots[k];
      if (!new_row.empty()) slot.row = new_row[slot.row];
      const std::size_t block = slot.row / block_rows;
      for (std::size_t to = wall_first_[block]; to < wall_first_[block + 1]; ++to)
        if (wall_lists_[to].wall == list.wall && wall_lists_[to].rule == list.rule && !wall_lists_[to].bonded &&
            !bonded_with(slot.row, list.wall, slot.patch))
          kept.push_back({to, slot, list.state.data() + k * words, list.property.data() + k * varying});
    }
  }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) {
    if (a.to != b.to) return a.to < b.to;
    return a.slot.row != b.slot.row ? a.slot.row < b.slot.row : a.slot.patch < b.slot.patch;
  });
  for (const Kept& one : kept) {
    WallList& list = wall_lists_[one.to];
    const BoundRule& rule = book.rules[list.rule];
    list.slots.push_back(one.slot);
    list.state.insert(list.state.end(), one.state, one.state + rule.state_words());
    list.property.insert(list.property.end(), one.property, one.property + rule.varying.size());
  }
}

void Contacts::wall_gone(std::size_t wall) {
  std::erase_if(wall_lists_, [&](const WallList& list) { return list.wall == wall; });
  for (WallList& list : wall_lists_)
    if (list.wall > wall) --list.wall;
  WallBreakHistory left;
  for (const auto& [spot, count] : wall_breaks)
    if (spot.wall != wall)
      left[{spot.id, static_cast<uint16_t>(spot.wall - (spot.wall > wall ? 1 : 0)), spot.patch}] = count;
  wall_breaks.swap(left);
  built_ = false;
}

bool Contacts::bonded_with(uint32_t row, uint16_t wall, uint32_t patch) const {
  const std::size_t block = row / block_rows;
  for (std::size_t k = wall_first_[block]; k < wall_first_[block + 1]; ++k) {
    const WallList& list = wall_lists_[k];
    if (list.bonded && list.wall == wall &&
        std::any_of(list.slots.begin(), list.slots.end(),
                    [&](const WallSlot& slot) { return slot.row == row && slot.patch == patch; }))
      return true;
  }
  return false;
}

bool Contacts::between_balls(uint16_t rule) const {
  for (std::size_t a = 0; a < book.groups(); ++a)
    for (std::size_t b = a; b < book.groups(); ++b)
      if (book.balls(static_cast<uint16_t>(a), static_cast<uint16_t>(b)) == rule) return true;
  return false;
}

void Contacts::bond_walls(const BondOrder& order, const Balls& balls, const std::vector<Wall>& walls) {
  if (!order.chosen_walls && (order.chosen || between_balls(order.rule))) return;
  const BallView view(balls);
  const uint16_t* group = balls.group();
  WallTouches touches;
  std::vector<double> reach;
  std::vector<uint32_t> rows;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const auto wall = static_cast<uint16_t>(w);
    rows.clear();
    reach.clear();
    for (uint32_t row = 0; row < balls.size(); ++row) {
      if (book.wall(group[row], wall) != order.rule) continue;
      if (order.chosen_walls && !order.chosen_walls(group[row], wall)) continue;
      rows.push_back(row);
      reach.push_back(view.radius[row] * (1 + 1e-9) + order.gap);
    }
    touches.find(walls[w], view, rows, reach);
    for (const uint32_t t : touches.order) {
      const uint32_t row = rows[touches.ball[t]], patch = touches.patch[t];
      if (touches.distance[t] - view.radius[row] > order.gap + BondOrder::touching * view.radius[row]) continue;
      if (!order.again && wall_breaks.count({balls.id()[row], wall, patch}) != 0) continue;
      if (bonded_with(row, wall, patch)) continue;
      fresh_walls_.push_back(
          {order.rule, wall, row, patch, {touches.nx[t], touches.ny[t], touches.nz[t]}, touches.distance[t]});
    }
  }
}

}  // namespace scree::core
