#pragma once
#include <cstdint>
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

/// The pairs of one rule, in row order, with what each contact remembers. The lower row owns a pair.
struct TouchList {
  Array<uint64_t> begin;                ///< first slot of each row; rows + 1
  Array<uint32_t> other;                ///< the higher row
  Array<uint32_t> where;                ///< see namespace target
  Array<uint8_t> active;                ///< 1 while the law runs
  std::vector<Array<double>> state;     ///< one per state word
  std::vector<Array<double>> property;  ///< one per varying word of the rule
  /// Kept only for a consumer: force on piece 2 (x y z) and moment, sliding flag; empty otherwise.
  std::vector<Array<double>> report;
  bool stale = false;  ///< the rule's properties changed: every contact gets them anew at the next rebuild

  std::size_t size() const { return other.size(); }
  std::size_t bytes() const;
};

/// Rebuilds the list of one rule from a fresh pair table and carries over what contacts remember.
/// `old_row` maps a row now to its row when the old list was built; empty when rows did not move.
/// `rule_of` gives the rule index of a pair.
struct Carry {
  const Balls* balls = nullptr;
  const PairTable* pairs = nullptr;
  const RuleBook* book = nullptr;
  const std::vector<uint32_t>* old_row = nullptr;
  const PeriodicCell* cell = nullptr;
};
void rebuild(TouchList& list, uint16_t rule, const Carry& carry, Team& team);

}  // namespace scree::core
