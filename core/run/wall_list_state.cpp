#include "core/run/wall_list_state.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/contact/touch_list.hpp"
#include "core/run/section_check.hpp"

namespace scree::core {

namespace {

using V = std::array<double, 3>;

// Sizes of one list: candidates, slots, state, property.
constexpr std::size_t sizes_per_list = 4;
constexpr std::size_t resultant_words = 6, bond_words = 7;

/// All lists one after the other, array by array.
struct Columns {
  std::vector<uint32_t> block, candidate, slot_row, slot_patch;
  std::vector<uint16_t> wall, rule;
  std::vector<uint64_t> sizes;
  std::vector<double> normal, dashpot, state, property, resultant;
  std::vector<uint8_t> bonded;  ///< by list
  std::vector<double> bond;     ///< of the slots of bonded lists
};

template <class T>
void append(std::vector<T>& to, const auto& from) {
  to.insert(to.end(), from.begin(), from.end());
}

Columns columns_of(const std::vector<WallList>& lists) {
  Columns c;
  for (const WallList& list : lists) {
    c.block.push_back(list.block);
    c.wall.push_back(list.wall);
    c.rule.push_back(list.rule);
    for (std::size_t size : {list.candidates.size(), list.slots.size(), list.state.size(), list.property.size()})
      c.sizes.push_back(size);
    append(c.candidate, list.candidates);
    for (const WallSlot& slot : list.slots) {
      c.slot_row.push_back(slot.row);
      c.slot_patch.push_back(slot.patch);
      append(c.normal, slot.normal);
      c.dashpot.push_back(slot.dashpot);
    }
    c.bonded.push_back(list.bonded ? 1 : 0);
    for (const WallBond& bond : list.bonds) {
      append(c.bond, bond.foot);
      append(c.bond, bond.axis);
      c.bond.push_back(bond.distance);
    }
    append(c.state, list.state);
    append(c.property, list.property);
    append(c.resultant, list.force);
    append(c.resultant, list.moment);
  }
  return c;
}

// Sums without overflow: no size may be larger than what the file holds of that array.
uint64_t total(const Columns& c, std::size_t which, uint64_t held, const ArchiveReader& in) {
  uint64_t sum = 0;
  for (std::size_t k = which; k < c.sizes.size(); k += sizes_per_list) {
    want(c.sizes[k] <= held - sum, in, "wall_lists/sizes", "they are larger than the arrays");
    sum += c.sizes[k];
  }
  want(sum == held, in, "wall_lists/sizes", "they are smaller than the arrays");
  return sum;
}

Columns read_columns(const ArchiveReader& in) {
  Columns c;
  c.block = in.get<uint32_t>("wall_lists/block");
  const uint64_t lists = c.block.size();
  c.wall = in.get<uint16_t>("wall_lists/wall", lists);
  c.rule = in.get<uint16_t>("wall_lists/rule", lists);
  c.sizes = in.get<uint64_t>("wall_lists/sizes", lists * sizes_per_list);
  c.resultant = in.get<double>("wall_lists/resultant", lists * resultant_words);
  c.candidate = in.get<uint32_t>("wall_lists/candidate");
  c.slot_row = in.get<uint32_t>("wall_lists/slot_row");
  c.slot_patch = in.get<uint32_t>("wall_lists/slot_patch", c.slot_row.size());
  c.normal = in.get<double>("wall_lists/slot_normal", 3 * c.slot_row.size());
  c.dashpot = in.get<double>("wall_lists/slot_dashpot", c.slot_row.size());
  c.bonded = in.get<uint8_t>("wall_lists/bonded", lists);
  uint64_t bonds = 0;
  for (uint64_t k = 0; k < lists; ++k) {
    want(c.bonded[k] <= 1, in, "wall_lists/bonded", "a flag is neither 0 nor 1");
    if (c.bonded[k] == 0) continue;
    want(c.sizes[sizes_per_list * k + 1] <= c.slot_row.size(), in, "wall_lists/sizes",
         "they are larger than the arrays");
    bonds += c.sizes[sizes_per_list * k + 1];
  }
  c.bond = in.get<double>("wall_lists/bond", bond_words * bonds);
  c.state = in.get<double>("wall_lists/state");
  c.property = in.get<double>("wall_lists/property");
  total(c, 0, c.candidate.size(), in);
  total(c, 1, c.slot_row.size(), in);
  total(c, 2, c.state.size(), in);
  total(c, 3, c.property.size(), in);
  return c;
}

template <class T>
std::vector<T> part(const std::vector<T>& from, std::size_t& at, uint64_t size) {
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(at);
  at += static_cast<std::size_t>(size);
  return {first, first + static_cast<std::ptrdiff_t>(size)};
}

void check_list(const WallList& list, const WallListLimits& limits, const ArchiveReader& in) {
  want(list.wall < limits.walls, in, "wall_lists/wall", "a wall does not exist");
  want(list.rule < limits.rules, in, "wall_lists/rule", "a rule does not exist");
  want(!list.bonded || list.candidates.empty(), in, "wall_lists/bonded", "bonds have candidates");
  const auto finite = [](const V& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); };
  for (const WallBond& bond : list.bonds)
    want(finite(bond.foot) && finite(bond.axis) && std::isfinite(bond.distance), in, "wall_lists/bond",
         "a place is not a finite number");
  const uint64_t first = uint64_t{list.block} * block_rows, last = std::min(limits.rows, first + block_rows);
  want(first < limits.rows, in, "wall_lists/block", "a block does not exist");
  const auto inside = [&](uint32_t row) { return row >= first && row < last; };
  want(std::all_of(list.candidates.begin(), list.candidates.end(), inside) &&
           std::is_sorted(list.candidates.begin(), list.candidates.end()),
       in, "wall_lists/candidate", "a row is out of range or order");
  for (std::size_t k = 0; k < list.slots.size(); ++k) {
    const WallSlot &slot = list.slots[k], &before = list.slots[k == 0 ? 0 : k - 1];
    want(inside(slot.row) && std::tie(before.row, before.patch) <= std::tie(slot.row, slot.patch), in,
         "wall_lists/slot_row", "a row is out of range or order");
  }
}

}  // namespace

void save_wall_lists(const std::vector<WallList>& lists, ArchiveWriter& out) {
  const Columns c = columns_of(lists);
  out.put("wall_lists/block", c.block);
  out.put("wall_lists/wall", c.wall);
  out.put("wall_lists/rule", c.rule);
  out.put("wall_lists/sizes", c.sizes);
  out.put("wall_lists/resultant", c.resultant);
  out.put("wall_lists/candidate", c.candidate);
  out.put("wall_lists/slot_row", c.slot_row);
  out.put("wall_lists/slot_patch", c.slot_patch);
  out.put("wall_lists/slot_normal", c.normal);
  out.put("wall_lists/slot_dashpot", c.dashpot);
  out.put("wall_lists/bonded", c.bonded);
  out.put("wall_lists/bond", c.bond);
  out.put("wall_lists/state", c.state);
  out.put("wall_lists/property", c.property);
}

std::vector<WallList> read_wall_lists(const ArchiveReader& in, const WallListLimits& limits) {
  const Columns c = read_columns(in);
  std::vector<WallList> lists(c.block.size());
  std::size_t candidate = 0, slot = 0, state = 0, property = 0, bond = 0;
  for (std::size_t k = 0; k < lists.size(); ++k) {
    WallList& list = lists[k];
    const uint64_t* sizes = &c.sizes[k * sizes_per_list];
    list.block = c.block[k];
    list.wall = c.wall[k];
    list.rule = c.rule[k];
    want(k == 0 || lists[k - 1].block <= list.block, in, "wall_lists/block", "blocks are out of order");
    list.candidates = part(c.candidate, candidate, sizes[0]);
    for (uint64_t left = sizes[1]; left > 0; --left, ++slot)
      list.slots.push_back({c.slot_row[slot],
                            c.slot_patch[slot],
                            {c.normal[3 * slot], c.normal[3 * slot + 1], c.normal[3 * slot + 2]},
                            c.dashpot[slot]});
    list.bonded = c.bonded[k] != 0;
    for (std::size_t left = list.bonded ? list.slots.size() : 0; left > 0; --left, bond += bond_words)
      list.bonds.push_back({{c.bond[bond], c.bond[bond + 1], c.bond[bond + 2]},
                            {c.bond[bond + 3], c.bond[bond + 4], c.bond[bond + 5]},
                            c.bond[bond + 6]});
    list.state = part(c.state, state, sizes[2]);
    list.property = part(c.property, property, sizes[3]);
    const double* sum = &c.resultant[k * resultant_words];
    list.force = {sum[0], sum[1], sum[2]};
    list.moment = {sum[3], sum[4], sum[5]};
    check_list(list, limits, in);
  }
  return lists;
}

}  // namespace scree::core
