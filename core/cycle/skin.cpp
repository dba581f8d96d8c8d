#include "core/cycle/skin.hpp"

#include <algorithm>

namespace scree::core {

namespace {

constexpr double share = 0.2;             ///< of the radius
constexpr double widest = 4;              ///< times that
constexpr double step = 1.5;              ///< from one width to the next
constexpr uint64_t soon = 12, late = 60;  ///< cycles: lists that last less want more skin, those that last longer less

}  // namespace

void Skin::begin(double wanted, const Sizes& sizes) {
  narrow_ = wanted > 0 ? wanted : share * std::min(sizes.mean, 4 * sizes.least);
  wide_ = wanted > 0 ? wanted : std::max(narrow_, std::min(widest * narrow_, sizes.room));
  width_ = narrow_;
}

void Skin::used_up(uint64_t cycle) {
  const uint64_t lasted = cycle - since_;
  if (lasted < soon) width_ = std::min(wide_, step * width_);
  if (lasted > late) width_ = std::max(narrow_, width_ / step);
}

void Skin::restore(const State& state) {
  width_ = state.width;
  narrow_ = state.narrow;
  wide_ = state.wide;
  since_ = state.since;
}

}  // namespace scree::core
