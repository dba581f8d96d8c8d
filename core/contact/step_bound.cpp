#include "core/contact/step_bound.hpp"

namespace scree::core {

std::string StepBound::text() const {
  if (step == 0) return "";
  std::string out = term;
  if (ball != 0) out += " of ball " + std::to_string(ball);
  if (other != 0) out += ", contact with ball " + std::to_string(other);
  if (!wall.empty()) out += ", contact with wall '" + wall + "'";
  return out;
}

const StepBound& smaller(const StepBound& a, const StepBound& b) {
  if (a.step == 0) return b;
  if (b.step == 0) return a;
  return b.step < a.step ? b : a;
}

}  // namespace scree::core
