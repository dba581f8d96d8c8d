#include "core/cycle/skin.hpp"

#include <algorithm>

namespace scree::core {

namespace {

constexpr double share = 0.2;  ///< of the radius
constexpr double widest = 4;   ///< times that
constexpr double step = 1.5;   ///< from one width to the next
/// Cycles that narrow lists last: less asks for more skin, more for less. A step up saves a third of the searches, each
/// worth some seven passes of forces, and lengthens the lists, by more where they are wide: those must last less.
constexpr double soon = 120, late = 420;

}  // namespace

void Skin::begin(double wanted, const Sizes& sizes) {
  const double own = share * std::min(sizes.mean, 4 * sizes.least);
  far_ = widest * own;
  narrow_ = wanted > 0 ? wanted : own;
  wide_ = wanted > 0 ? wanted : std::max(narrow_, std::min(far_, sizes.room));
  width_ = narrow_;
}

void Skin::used_up(uint64_t cycle) {
  const double lasted = static_cast<double>(cycle - since_) * width_ / narrow_;
  if (lasted < soon) width_ = std::min(wide_, step * width_);
  if (lasted > late) width_ = std::max(narrow_, width_ / step);
}

void Skin::restore(const State& state) {
  width_ = state.width;
  narrow_ = state.narrow;
  wide_ = state.wide;
  far_ = state.far;
  since_ = state.since;
}

}  // namespace scree::core
