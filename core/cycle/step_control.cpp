#include "core/cycle/step_control.hpp"

#include <cmath>

namespace scree::core {

double StepControl::six_bits(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 0;
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::floor(mantissa * 64), exponent - 6);
}

void StepControl::take(const StepBound& bound, uint64_t cycle) {
  if (!bound.open) bound_ = bound;
  const double target = six_bits(safety * bound.step);
  if (target == 0) return;
  if (step_ == 0 || target < step_) {
    step_ = target;
    since_ = never;
  } else if (target >= rise * step_) {
    if (since_ == never) since_ = cycle;
    if (cycle - since_ >= patience) {
      step_ = target;
      since_ = never;
    }
  } else {
    since_ = never;
  }
}

}  // namespace scree::core
