#include "core/contact/bond_table.hpp"

#include <algorithm>

namespace scree::core {

namespace {

// The row now of each row of the old lists.
std::vector<uint32_t> rows_now(const std::vector<TouchList>& lists, const std::vector<uint32_t>& old_row,
                               std::size_t rows) {
  std::size_t before = 0;
  for (const TouchList& list : lists) before = std::max(before, list.begin.empty() ? 0 : list.begin.size() - 1);
  std::vector<uint32_t> now(before, no_row);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t old = old_row.empty() ? row : old_row[row];
    if (old < before) now[old] = static_cast<uint32_t>(row);
  }
  return now;
}

}  // namespace

bool BondTable::holds(uint32_t low, uint32_t high) const {
  if (begin_.empty()) return false;
  for (std::size_t k = begin_[low]; k < begin_[low + 1]; ++k)
    if (pairs[k].high == high) return true;
  return false;
}

void BondTable::sort(std::size_t rows) {
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  begin_.assign(pairs.empty() ? 0 : rows + 1, 0);
  for (const Pair& pair : pairs) ++begin_[pair.low + 1];
  for (std::size_t row = 1; row < begin_.size(); ++row) begin_[row] += begin_[row - 1];
}

BondTable bond_table(const std::vector<TouchList>& lists, const std::vector<NewBond>& fresh, const RuleBook& book,
                     const std::vector<uint32_t>& old_row, std::size_t rows) {
  BondTable table;
  const bool any =
      std::any_of(lists.begin(), lists.end(), [](const TouchList& list) { return list.bonded && list.size() > 0; });
  if (!any && fresh.empty()) return table;
  const std::vector<uint32_t> now = rows_now(lists, old_row, rows);
  const auto add = [&](uint32_t a, uint32_t b, uint16_t rule, std::size_t from) {
    const uint32_t x = a < now.size() ? now[a] : no_row, y = b < now.size() ? now[b] : no_row;
    if (x != no_row && y != no_row)
      table.pairs.push_back({std::min(x, y), std::max(x, y), rule, static_cast<uint32_t>(from)});
  };
  for (const TouchList& list : lists) {
    if (!list.bonded || !book.rules[list.rule].can_bond()) continue;
    for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
      for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot)
        if (list.broken[slot] == 0) add(static_cast<uint32_t>(row), list.other[slot], list.rule, slot);
  }
  for (const NewBond& bond : fresh) {
    const TouchList &touch = lists[bond.rule], &bonded = lists[lists.size() / 2 + bond.rule];
    const uint32_t slot = find_slot(touch, bond.low, bond.high);
    add(bond.low, bond.high, bond.rule, slot == no_slot ? no_slot : bonded.size() + slot);
  }
  table.sort(rows);
  return table;
}

}  // namespace scree::core
