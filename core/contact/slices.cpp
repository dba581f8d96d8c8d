#include "core/contact/slices.hpp"

#include <algorithm>
#include <cstring>

namespace scree::core {

namespace {

std::vector<uint32_t> halo_of(const std::vector<TouchList>& lists, std::size_t first, std::size_t last) {
  std::vector<uint32_t> rows;
  for (const TouchList& list : lists) {
    if (list.size() == 0) continue;
    for (uint64_t slot = list.begin[first]; slot < list.begin[last]; ++slot)
      if (list.other[slot] >= last) rows.push_back(list.other[slot]);
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

void point_slots(TouchList& list, std::size_t first, std::size_t last, const std::vector<uint32_t>& halo) {
  if (list.size() == 0) return;
  for (uint64_t slot = list.begin[first]; slot < list.begin[last]; ++slot) {
    const uint32_t other = list.other[slot];
    std::size_t record = other - first;
    if (other >= last)
      record =
          (last - first) + static_cast<std::size_t>(std::lower_bound(halo.begin(), halo.end(), other) - halo.begin());
    list.where[slot] = (list.where[slot] & ~target::record_mask) | static_cast<uint32_t>(record);
  }
}

}  // namespace

std::size_t Slices::block_size(std::size_t block) const { return std::min(block_rows, rows_ - block * block_rows); }

void Slices::build(std::vector<TouchList>& lists, std::size_t rows, std::size_t stride, Team& team) {
  rows_ = rows;
  stride_ = stride;
  blocks_ = (rows + block_rows - 1) / block_rows;
  std::vector<std::vector<uint32_t>> halo(blocks_);
  team.each_block(blocks_, [&](std::size_t block) {
    const std::size_t first = block * block_rows, last = first + block_size(block);
    halo[block] = halo_of(lists, first, last);
    for (TouchList& list : lists) point_slots(list, first, last, halo[block]);
  });
  first_ = Array<uint64_t>(blocks_ + 1);
  incoming_.assign(blocks_, {});
  std::size_t halos = 0;
  for (const auto& rows_of_block : halo) halos += rows_of_block.size();
  halo_row_.resize_for_overwrite(halos);
  uint64_t entry = 0;
  for (std::size_t block = 0; block < blocks_; ++block) {
    first_[block + 1] = first_[block] + block_size(block) + halo[block].size();
    uint64_t record = first_[block] + block_size(block);
    for (std::size_t k = 0; k < halo[block].size();) {
      const std::size_t owner = halo[block][k] / block_rows;
      std::size_t end = k;
      for (; end < halo[block].size() && halo[block][end] / block_rows == owner; ++end)
        halo_row_[entry + end] = halo[block][end];
      incoming_[owner].push_back({record + k, entry + k, static_cast<uint32_t>(end - k)});
      k = end;
    }
    entry += halo[block].size();
  }
  records_.release();
  records_.resize(first_[blocks_] * stride_);
}

void Slices::clear(std::size_t block) {
  std::memset(slice(block), 0, (first_[block + 1] - first_[block]) * stride_ * sizeof(double));
}

void Slices::fold(std::size_t block) {
  double* own = slice(block);
  const std::size_t base = block * block_rows;
  for (const Segment& segment : incoming_[block]) {
    double* from = records_.data() + segment.record * stride_;
    const uint32_t* row = halo_row_.data() + segment.row;
    for (std::size_t k = 0; k < segment.count; ++k) {
      double* to = own + (row[k] - base) * stride_;
      for (std::size_t w = 0; w < stride_; ++w) to[w] += from[k * stride_ + w];
    }
    std::memset(from, 0, segment.count * stride_ * sizeof(double));
  }
}

std::size_t Slices::bytes() const { return records_.bytes() + first_.bytes() + halo_row_.bytes(); }

std::vector<double> Slices::save() const {
  std::vector<double> out(rows_ * stride_);
  for (std::size_t row = 0; row < rows_; ++row) std::memcpy(&out[row * stride_], record(row), stride_ * sizeof(double));
  for (std::size_t block = 0; block < blocks_; ++block)
    for (const Segment& segment : incoming_[block])
      for (std::size_t k = 0; k < segment.count; ++k)
        for (std::size_t w = 0; w < stride_; ++w)
          out[halo_row_[segment.row + k] * stride_ + w] += records_[(segment.record + k) * stride_ + w];
  return out;
}

void Slices::load(const std::vector<double>& records) {
  for (std::size_t block = 0; block < blocks_; ++block) {
    clear(block);
    std::memcpy(slice(block), &records[block * block_rows * stride_], block_size(block) * stride_ * sizeof(double));
  }
}

}  // namespace scree::core
