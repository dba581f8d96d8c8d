#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/base/array.hpp"
#include "core/contact/pair_search.hpp"
#include "core/contact/rule.hpp"

namespace scree::core {

constexpr std::size_t block_rows = 1024;  ///< fixed, independent of threads: sums follow blocks

/// Where a slot adds its force on the other ball, and how the pair lies. Packed to keep a slot small.
namespace target {
constexpr uint32_t record_mask = 0x00ffffffu;  ///< record within the block's slice
constexpr int image_shift = 24;                ///< six bits, see PairTable::image
constexpr uint32_t flip = 0x80000000u;         ///< the higher row has the lower id
inline uint32_t image(uint32_t word) { return (word >> image_shift) & 0x3fu; }
}  // namespace target

/// The pairs of one rule, in row order, with what each contact remembers. The lower row owns a pair. A rule has two
/// lists, and a pair is in one of them: those that may touch, and those that are bonded, whose law runs at any gap.
struct TouchList {
  Array<uint64_t> begin;                ///< first slot of each row; rows + 1
  Array<uint32_t> other;                ///< the higher row
  Array<uint32_t> where;                ///< see namespace target
  Array<uint8_t> active;                ///< 1 while the law runs
  Array<uint8_t> broken;                ///< bonded list: 0 while the bond holds, else how it broke
  std::vector<Array<double>> state;     ///< one per state word; of a bonded pair then one per word of its bond
  std::vector<Array<double>> property;  ///< one per varying word of the rule
  Array<double> dashpot;                ///< J, what the dashpots took last; empty unless energy is traced
  /// Kept only for a consumer: force on piece 2 (x y z) and moment, sliding flag; empty otherwise.
  std::vector<Array<double>> report;
  uint16_t rule = 0;
  bool bonded = false;
  bool stale = false;  ///< the rule's properties changed: every contact gets them anew at the next rebuild

  std::size_t size() const { return other.size(); }
  std::size_t bytes() const;
};

/// Rebuilds the list of one rule from a fresh pair table and carries over what contacts remember.
/// `old_row` maps a row now to its row when the old list was built; empty when rows did not move.
struct Carry {
  const Balls* balls = nullptr;
  const PairTable* pairs = nullptr;
  const RuleBook* book = nullptr;
  const std::vector<uint32_t>* old_row = nullptr;
  const PeriodicCell* cell = nullptr;
  const class BondTable* bonds = nullptr;
  const std::map<std::pair<uint64_t, uint64_t>, uint32_t>* breaks = nullptr;
};
/// `bonded`: the rule's old bonded list, from which pairs come whose bond broke.
void rebuild(TouchList& list, const TouchList& bonded, const Carry& carry, Team& team);
/// The rule's new bonded list, from its old one and from its touch list, from which pairs come that are bonded now.
TouchList rebuilt_bonds(const TouchList& old, const TouchList& touch, const Carry& carry, Team& team);

constexpr uint32_t no_slot = std::numeric_limits<uint32_t>::max();
/// The slot of a pair of rows, or no_slot.
uint32_t find_slot(const TouchList& list, uint32_t a, uint32_t b);

}  // namespace scree::core
