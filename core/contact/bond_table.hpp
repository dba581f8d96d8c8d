#pragma once
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/contact/touch_list.hpp"

namespace scree::core {

/// A bond that is to be made: rows and slots are those of the lists as they are built now.
struct NewBond {
  uint16_t rule;
  uint32_t low, high;  ///< rows
};

/// The ids of a pair, the lower one first.
using IdPair = std::pair<uint64_t, uint64_t>;
/// How often the bond of a pair has broken; pairs that never broke are not in it.
using BreakHistory = std::map<IdPair, uint32_t>;

/// Pairs that will be bonded in the lists that are being built. They are in no touch list.
class BondTable {
 public:
  struct Pair {
    uint32_t low, high;  ///< rows now
    uint16_t rule;
    uint32_t from;  ///< slot of the rule's old bonded list, or its size plus the slot of the rule's old touch list
  };
  std::vector<Pair> pairs;  ///< by low, then high

  bool empty() const { return pairs.empty(); }
  bool holds(uint32_t low, uint32_t high) const;
  /// Pairs of one row: [first(row), first(row + 1)).
  std::size_t first(std::size_t row) const { return begin_.empty() ? 0 : begin_[row]; }
  /// Sorts the pairs, for this many rows.
  void sort(std::size_t rows);

 private:
  std::vector<std::size_t> begin_;
};

/// Bonds of the old lists that hold, and those to be made. `old_row` as in Carry.
BondTable bond_table(const std::vector<TouchList>& lists, const std::vector<NewBond>& fresh, const RuleBook& book,
                     const std::vector<uint32_t>& old_row, std::size_t rows);

}  // namespace scree::core
