#pragma once
#include <cstdint>
#include <vector>

#include "core/base/array.hpp"
#include "core/base/threads.hpp"
#include "core/contact/touch_list.hpp"

namespace scree::core {

/// Force records. A block of rows adds only into its own slice: first a record per row of the block, then a record per
/// row of other blocks that it touches (its halo). Halos are added in block order, so sums do not depend on threads.
/// A record is fx fy fz and the sum of contact force sizes, with spin fx fy fz mx my mz sum and one unused word.
class Slices {
 public:
  static constexpr std::size_t lean = 4, with_spin = 8;  ///< doubles in a record

  /// Lays out the halos and writes every slot's record into `where`.
  void build(std::vector<TouchList>& lists, std::size_t rows, std::size_t stride, Team& team);

  std::size_t blocks() const { return blocks_; }
  std::size_t rows() const { return rows_; }
  std::size_t stride() const { return stride_; }
  std::size_t block_size(std::size_t block) const;
  double* slice(std::size_t block) { return records_.data() + first_[block] * stride_; }
  const double* record(std::size_t row) const {
    return records_.data() + (first_[row / block_rows] + row % block_rows) * stride_;
  }
  void clear(std::size_t block);
  /// Adds what other blocks hold for the rows of this block, and empties it, so that a second call adds nothing.
  void fold(std::size_t block);
  std::size_t bytes() const;

  /// For records kept elsewhere in the same layout: how many there are, and the first of each block.
  std::size_t records() const { return blocks_ == 0 ? 0 : first_[blocks_]; }
  std::size_t first_record(std::size_t block) const { return first_[block]; }
  /// Calls f(row within the block, record) for what other blocks hold for the rows of this one, in block order.
  template <class F>
  void each_halo(std::size_t block, F f) const {
    for (const Segment& segment : incoming_[block])
      for (std::size_t k = 0; k < segment.count; ++k)
        f(halo_row_[segment.row + k] - block * block_rows, segment.record + k);
  }

  /// Net contact forces of all rows as `fold` would leave them, for a checkpoint. Changes nothing.
  std::vector<double> save() const;
  /// After `build`. Needs rows times stride values.
  void load(const std::vector<double>& records);

 private:
  struct Segment {
    uint64_t record;  ///< first of the source's records
    uint64_t row;     ///< first entry of halo_row_
    uint32_t count;
  };
  std::size_t rows_ = 0, blocks_ = 0, stride_ = lean;
  Array<double> records_;
  Array<uint64_t> first_;                       ///< first record of each block; blocks + 1
  Array<uint32_t> halo_row_;                    ///< rows of all halo records, block by block, ascending
  std::vector<std::vector<Segment>> incoming_;  ///< per block, in order of the source block
};

}  // namespace scree::core
