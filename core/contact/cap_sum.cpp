#include "core/contact/cap_sum.hpp"

#include <algorithm>

namespace scree::core {

double cap_sum(const ContactShape& one, double cosine) {
  // Degrees 1 and 2 of a field, averaged over a cap.
  const double first = (1 + cosine) / 2, second = cosine * (1 + cosine) / 2;
  const double mean_u = (one.along + 2 * one.across) / 3, mean_w = (one.twist + 2 * one.bend) / 3;
  const double apart_u = (one.along - one.across) / second, apart_w = (one.twist - one.bend) / second;
  // The field whose averages are the contact's own, and what it lacks along n to be nowhere negative.
  const double along = mean_u + 2 * apart_u / 3, twist = mean_w + 2 * apart_w / 3;
  const double across = mean_u - apart_u / 3, bend = mean_w - apart_w / 3, mixed = one.mixed / first;
  const double least_u = mean_u + std::max(0.0, -along) / 3, least_w = mean_w + std::max(0.0, -twist) / 3;
  const auto enough = [&](double most) {
    const double a = across + 1.5 * (most - least_u), b = bend + 1.5 * (most - least_w);
    return a >= 0 && b >= 0 && a * b >= mixed * mixed;
  };
  double low = std::max(least_u, least_w);
  if (enough(low)) return caps(cosine) * low;
  double high = low;
  do high *= 2;
  while (!enough(high) && high < 1e300);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (enough(middle) ? high : low) = middle;
  }
  return caps(cosine) * high;
}

}  // namespace scree::core
