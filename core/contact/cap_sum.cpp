#include "core/contact/cap_sum.hpp"

#include <algorithm>
#include <cmath>

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
  // (across + t)(bend + t) = mixed^2 with what both are given more, t, and no less than they lack by themselves.
  const double a = across - 1.5 * least_u, b = bend - 1.5 * least_w;
  const double more = 0.5 * (std::sqrt((a - b) * (a - b) + 4 * mixed * mixed) - a - b);
  return caps(cosine) * std::max({least_u, least_w, more / 1.5});
}

}  // namespace scree::core
