#include "core/contact/wall_bonds.hpp"

#include <algorithm>
#include <tuple>

#include "core/contact/touch_list.hpp"

namespace scree::core {

namespace {

using V = std::array<double, 3>;

V centre_of(const BallView& balls, uint32_t row) { return {balls.x[row], balls.y[row], balls.z[row]}; }

template <class A, class B>
bool before(const A& a, const B& b) {
  return a.row != b.row ? a.row < b.row : a.patch < b.patch;
}

// Of the plane that the bond remembers, where the wall is now.
uint32_t add_plane(WallTouches& out, const WallBond& bond, const Wall& wall, const V& centre) {
  const V local = wall.to_frame(centre);
  double away = 0;
  for (std::size_t c = 0; c < 3; ++c) away += (bond.foot[c] - local[c]) * bond.axis[c];
  return out.add(wall.from_frame(bond.axis), away);
}

// The first `words` of a slot of a list that has `in_list` of them a slot.
template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, std::size_t slot, std::size_t in_list, std::size_t words) {
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(slot * in_list);
  to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(words));
}

/// Copies one slot after the other into fresh lists.
class Transfer {
 public:
  explicit Transfer(const WallBondCarry& carry) : carry_(carry) {}

  void keep(const WallList& old, std::size_t slot);
  void make(const NewWallBond& bond, const std::vector<WallList>& old);
  std::vector<WallList> lists();

 private:
  struct Part {
    uint32_t block;
    uint16_t wall, rule;
    WallSlot slot;
    WallBond bond;
    std::vector<double> state, property;
  };
  void draw_properties(Part& part) const;
  uint32_t row_now(uint32_t row) const { return carry_.new_row->empty() ? row : (*carry_.new_row)[row]; }
  Part& add(uint16_t wall, uint16_t rule, uint32_t row);

  const WallBondCarry carry_;
  std::vector<Part> parts_;
};

Transfer::Part& Transfer::add(uint16_t wall, uint16_t rule, uint32_t row) {
  return parts_.emplace_back(Part{static_cast<uint32_t>(row / block_rows), wall, rule, {}, {}, {}, {}});
}

void Transfer::keep(const WallList& old, std::size_t slot) {
  const BoundRule& rule = carry_.book->rules[old.rule];
  const std::size_t words = rule.memory_words(true), varying = rule.varying.size();
  const uint32_t row = row_now(old.slots[slot].row);
  Part& part = add(old.wall, old.rule, row);
  part.slot = old.slots[slot];
  part.slot.row = row;
  part.bond = old.bonds[slot];
  append(part.state, old.state, slot, words, words);
  // Pieces that came since may let more words vary.
  if (old.property.size() == old.slots.size() * varying)
    append(part.property, old.property, slot, varying, varying);
  else
    draw_properties(part);
}

void Transfer::make(const NewWallBond& bond, const std::vector<WallList>& old) {
  const BoundRule& rule = carry_.book->rules[bond.rule];
  const Wall& wall = (*carry_.walls)[bond.wall];
  const BallView balls(*carry_.balls);
  const uint32_t row = row_now(bond.row);
  Part& part = add(bond.wall, bond.rule, row);
  part.slot = {row, bond.patch, bond.normal, 0};
  const V centre = centre_of(balls, row);
  for (std::size_t c = 0; c < 3; ++c) part.bond.foot[c] = centre[c] + bond.distance * bond.normal[c];
  part.bond.foot = wall.to_frame(part.bond.foot);
  part.bond.axis = wall.direction_to_frame(bond.normal);
  part.bond.distance = bond.distance;
  const std::size_t words = rule.state_words();
  for (const WallList& list : old) {
    if (list.bonded || list.wall != bond.wall || list.rule != bond.rule) continue;
    const auto at = std::lower_bound(list.slots.begin(), list.slots.end(), bond,
                                     [](const WallSlot& a, const NewWallBond& b) { return before(a, b); });
    if (at == list.slots.end() || before(bond, *at) || list.state.size() != list.slots.size() * words) continue;
    part.slot.normal = at->normal;
    part.slot.dashpot = at->dashpot;
    append(part.state, list.state, static_cast<std::size_t>(at - list.slots.begin()), words, words);
  }
  part.state.resize(rule.memory_words(true), 0.0);
  draw_properties(part);
}

// Those of a bond, which a ball that is bonded anew draws anew.
void Transfer::draw_properties(Part& part) const {
  const BoundRule& rule = carry_.book->rules[part.rule];
  if (rule.varying.empty()) return;
  WallList one;
  one.wall = part.wall;
  one.rule = part.rule;
  one.bonded = true;
  one.slots = {part.slot};
  one.bonds = {part.bond};
  renew_wall_list(one, rule, *carry_.balls, (*carry_.walls)[part.wall], *carry_.breaks);
  part.property = one.property;
}

std::vector<WallList> Transfer::lists() {
  std::sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
    return std::tie(a.block, a.wall, a.rule, a.slot.row, a.slot.patch) <
           std::tie(b.block, b.wall, b.rule, b.slot.row, b.slot.patch);
  });
  std::vector<WallList> lists;
  for (const Part& part : parts_) {
    if (lists.empty() || lists.back().block != part.block || lists.back().wall != part.wall ||
        lists.back().rule != part.rule) {
      WallList& list = lists.emplace_back();
      list.block = part.block;
      list.wall = part.wall;
      list.rule = part.rule;
      list.bonded = true;
    }
    WallList& list = lists.back();
    list.slots.push_back(part.slot);
    list.bonds.push_back(part.bond);
    list.state.insert(list.state.end(), part.state.begin(), part.state.end());
    list.property.insert(list.property.end(), part.property.begin(), part.property.end());
  }
  return lists;
}

// One slot into its place among those of a list, with the first words of its state.
void insert_slot(WallList& to, const WallList& from, std::size_t slot, std::size_t words, std::size_t in_list,
                 std::size_t varying) {
  const auto at = std::lower_bound(to.slots.begin(), to.slots.end(), from.slots[slot], before<WallSlot, WallSlot>);
  const auto place = at - to.slots.begin();
  const auto put = [&](std::vector<double>& column, const std::vector<double>& source, std::size_t n,
                       std::size_t source_n) {
    const auto first = source.begin() + static_cast<std::ptrdiff_t>(slot * source_n);
    column.insert(column.begin() + place * static_cast<std::ptrdiff_t>(n), first,
                  first + static_cast<std::ptrdiff_t>(n));
  };
  constexpr std::size_t report = WallList::report_words;
  if (from.report.size() == from.slots.size() * report && to.report.size() == to.slots.size() * report)
    put(to.report, from.report, report, report);
  put(to.state, from.state, words, in_list);
  put(to.property, from.property, varying, varying);
  to.slots.insert(at, from.slots[slot]);
}

template <class T>
void erase_slots(std::vector<T>& column, std::size_t per_slot, const std::vector<WallBond>& bonds) {
  if (column.size() != per_slot * bonds.size()) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < bonds.size(); ++k) {
    if (bonds[k].broke != 0) continue;
    for (std::size_t w = 0; w < per_slot; ++w) column[kept * per_slot + w] = column[k * per_slot + w];
    ++kept;
  }
  column.resize(kept * per_slot);
}

}  // namespace

uint32_t place_bonds(const WallList& list, const Wall& wall, const BallView& balls, WallTouches& out) {
  thread_local std::vector<uint32_t> rows, order;
  thread_local std::vector<double> reach;
  rows.clear();
  reach.clear();
  for (std::size_t k = 0; k < list.slots.size(); ++k) {
    const uint32_t row = list.slots[k].row;
    // Far enough for any motion of a cycle, and no farther: a wall of many faces need not tell of all.
    const double far = 2 * (balls.radius[row] + std::max(list.bonds[k].distance, -list.bonds[k].distance));
    if (rows.empty() || rows.back() != row) {
      rows.push_back(row);
      reach.push_back(far);
    }
    reach.back() = std::max(reach.back(), far);
  }
  out.find(wall, balls, rows, reach);
  const uint32_t seen = out.count;
  order.clear();
  std::size_t next = 0;
  for (std::size_t k = 0; k < list.slots.size(); ++k) {
    const WallSlot& slot = list.slots[k];
    const auto earlier = [&](uint32_t t) {
      const uint32_t row = rows[out.ball[t]];
      return row != slot.row ? row < slot.row : out.patch[t] < slot.patch;
    };
    while (next < seen && earlier(out.order[next])) ++next;
    const uint32_t t = next < seen ? out.order[next] : 0;
    const bool told = next < seen && rows[out.ball[t]] == slot.row && out.patch[t] == slot.patch;
    order.push_back(told ? t : add_plane(out, list.bonds[k], wall, centre_of(balls, slot.row)));
  }
  out.order = order;
  return seen;
}

void keep_places(WallList& list, const Wall& wall, const BallView& balls, const WallTouches& touches, uint32_t seen) {
  for (std::size_t k = 0; k < list.slots.size(); ++k) {
    const uint32_t t = touches.order[k];
    WallBond& bond = list.bonds[k];
    bond.distance = touches.distance[t];
    if (t >= seen) continue;
    const V normal{touches.nx[t], touches.ny[t], touches.nz[t]};
    V foot = centre_of(balls, list.slots[k].row);
    for (std::size_t c = 0; c < 3; ++c) foot[c] += bond.distance * normal[c];
    bond.foot = wall.to_frame(foot);
    bond.axis = wall.direction_to_frame(normal);
  }
}

void leave_out(WallTouches& touches, const std::vector<uint32_t>& rows, const WallList& bonds) {
  struct Spot {
    uint32_t row, patch;
  };
  std::erase_if(touches.order, [&](uint32_t t) {
    const Spot spot{rows[touches.ball[t]], touches.patch[t]};
    const auto at = std::lower_bound(bonds.slots.begin(), bonds.slots.end(), spot, before<WallSlot, Spot>);
    return at != bonds.slots.end() && !before(spot, *at);
  });
  touches.count = static_cast<uint32_t>(touches.order.size());
}

void release_broken(WallList& bonds, WallList* touch, const BoundRule& rule, const BallView& balls,
                    ContactEnergy& energy) {
  const std::size_t words = rule.memory_words(true), varying = rule.varying.size();
  bool any = false;
  for (std::size_t k = 0; k < bonds.slots.size(); ++k) {
    const WallBond& bond = bonds.bonds[k];
    if (bond.broke == 0) continue;
    any = true;
    if (touch != nullptr && bond.distance - balls.radius[bonds.slots[k].row] <= rule.reach)
      insert_slot(*touch, bonds, k, rule.state_words(), words, varying);
    else
      energy.dashpot += ContactEnergy::dashpot_end(bonds.slots[k].dashpot);
  }
  if (!any) return;
  erase_slots(bonds.state, words, bonds.bonds);
  erase_slots(bonds.property, varying, bonds.bonds);
  erase_slots(bonds.report, WallList::report_words, bonds.bonds);
  erase_slots(bonds.slots, 1, bonds.bonds);
  std::erase_if(bonds.bonds, [](const WallBond& bond) { return bond.broke != 0; });
}

std::vector<WallList> rebuilt_wall_bonds(const std::vector<WallList>& old, const std::vector<NewWallBond>& fresh,
                                         const WallBondCarry& carry) {
  Transfer transfer(carry);
  for (const WallList& list : old) {
    if (!list.bonded) continue;
    const BoundRule& rule = carry.book->rules[list.rule];
    const std::size_t slots = list.slots.size();
    if (!rule.can_bond() || list.state.size() != slots * rule.memory_words(true)) continue;
    for (std::size_t k = 0; k < slots; ++k) transfer.keep(list, k);
  }
  for (const NewWallBond& bond : fresh) transfer.make(bond, old);
  return transfer.lists();
}

}  // namespace scree::core
