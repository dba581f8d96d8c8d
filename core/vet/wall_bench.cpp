#include "core/vet/wall_bench.hpp"

#include <algorithm>

namespace scree::core::vet {

namespace {
constexpr std::size_t guard = 8;
constexpr double mark = -6.27e66;
constexpr uint32_t whole_mark = 0xdeadbeef;
}  // namespace

WallBench::WallBench(const scree_wall& table, std::size_t capacity) : table_(table) {
  for (auto* column : {&nx_, &ny_, &nz_, &distance_}) column->assign(capacity + guard, mark);
  for (auto* column : {&ball_, &patch_}) column->assign(capacity + guard, whole_mark);
}

void WallBench::prepare(const void* wall, const std::vector<Vec3>& centres, double reach, std::size_t capacity) {
  wall_ = wall;
  n_ = static_cast<uint32_t>(centres.size());
  x_.clear(), y_.clear(), z_.clear();
  for (const Vec3& c : centres) x_.push_back(c.x), y_.push_back(c.y), z_.push_back(c.z);
  reach_.assign(centres.size(), reach);
  for (auto* column : {&nx_, &ny_, &nz_, &distance_}) std::fill(column->begin(), column->end(), mark);
  for (auto* column : {&ball_, &patch_}) std::fill(column->begin(), column->end(), whole_mark);
  out_ = {
      sizeof out_,     static_cast<uint32_t>(capacity), ball_.data(), patch_.data(), nx_.data(), ny_.data(), nz_.data(),
      distance_.data()};
  count_ = 0;
}

uint32_t WallBench::ask(const void* wall, const std::vector<Vec3>& centres, double reach, std::size_t capacity) {
  prepare(wall, centres, reach, capacity);
  (*this)();
  return count_;
}

std::vector<Touch> WallBench::touches() const {
  std::vector<Touch> list;
  for (std::size_t k = 0; k < std::min<std::size_t>(count_, out_.capacity); ++k)
    list.push_back({ball_[k], patch_[k], {nx_[k], ny_[k], nz_[k]}, distance_[k]});
  return list;
}

bool WallBench::trespassed() const {
  for (const auto* column : {&nx_, &ny_, &nz_, &distance_})
    for (std::size_t k = out_.capacity; k < column->size(); ++k)
      if ((*column)[k] != mark) return true;
  for (const auto* column : {&ball_, &patch_})
    for (std::size_t k = out_.capacity; k < column->size(); ++k)
      if ((*column)[k] != whole_mark) return true;
  return false;
}

std::vector<Vec3> points(std::size_t count, uint64_t seed) {
  Numbers random(seed);
  std::vector<Vec3> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back(random.vector(0.15));
  return list;
}

}  // namespace scree::core::vet
