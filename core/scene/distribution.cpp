#include "core/scene/distribution.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/log.hpp"

namespace scree::core {

namespace {

/// Normal draws of Random stay within it.
constexpr double largest_normal = 8.3;

double weibull(double shape, double scale, double above) {
  return scale * plain_exp(plain_log(-plain_log(above)) / shape);
}

}  // namespace

void Distribution::cut(double low, double high) {
  low_ = std::max(low_, low);
  high_ = std::min(high_, high);
}

double Distribution::draw(const Random& random, uint64_t index) const {
  // A cut that keeps less than 1 % is refused where the scene is read: so many tries miss with chance below 1e-80.
  constexpr uint64_t most_tries = 20000;
  for (uint64_t k = 0; k < most_tries; ++k) {
    double value = first_;
    switch (law_) {
      case Law::normal:
        value += second_ * random.normal(index, k);
        break;
      case Law::uniform:
        value = std::min(second_, first_ + random.uniform(index, k) * (second_ - first_));
        break;
      case Law::weibull:
        // 52 bits and a half step: never 0, whose logarithm is infinite, nor 1.
        value = weibull(first_, second_, (static_cast<double>(random.bits(index, k) >> 12) + 0.5) * 0x1p-52);
        break;
    }
    if (value >= low_ && value <= high_ && std::isfinite(value)) return value;
  }
  throw Refusal(Exit::scene, "a distribution gave " + std::to_string(most_tries) +
                                 " values in a row outside its bounds: widen 'low' and 'high'");
}

double Distribution::largest() const {
  double most = second_;
  if (law_ == Law::normal) most = first_ + largest_normal * second_;
  if (law_ == Law::weibull) most = weibull(first_, second_, 0x1p-53);
  return std::min({high_, most, std::numeric_limits<double>::max()});
}

double Distribution::below(double x) const {
  switch (law_) {
    case Law::normal:
      if (second_ == 0) return x >= first_ ? 1 : 0;
      return 0.5 * std::erfc((first_ - x) / (second_ * std::sqrt(2.0)));
    case Law::uniform:
      if (second_ == first_) return x >= first_ ? 1 : 0;
      return std::clamp((x - first_) / (second_ - first_), 0.0, 1.0);
    default:
      return x <= 0 ? 0 : -std::expm1(-std::pow(x / second_, first_));
  }
}

double Distribution::kept() const {
  if (high_ < low_) return 0;
  // A law that is one value has no share between two points.
  const bool single = (law_ == Law::normal && second_ == 0) || (law_ == Law::uniform && second_ == first_);
  if (single) return first_ >= low_ && first_ <= high_ ? 1 : 0;
  return below(high_) - below(low_);
}

double Distribution::quantile(double p) const {
  if (law_ == Law::normal) return first_ + second_ * inverse_normal(p);
  if (law_ == Law::uniform) return first_ + p * (second_ - first_);
  return weibull(first_, second_, 1 - p);
}

Distribution::Moments Distribution::moments() const {
  // The mean of the quantile function over the kept part, by the midpoint rule.
  constexpr int points = 20000;
  const double from = below(low_), share = kept();
  double sum = 0, squares = 0;
  for (int k = 0; k < points; ++k) {
    const double x = quantile(from + share * (k + 0.5) / points) - first_;
    sum += x / points;
    squares += x * x / points;
  }
  return {first_ + sum, std::sqrt(std::max(0.0, squares - sum * sum))};
}

std::string Distribution::text(const std::string& unit) const {
  const std::string of = unit == "1" ? "" : " " + unit;
  std::string out;
  if (law_ == Law::normal) out = fmt::format("normal, mean {:g}{}, sd {:g}{}", first_, of, second_, of);
  if (law_ == Law::uniform) out = fmt::format("uniform, from {:g} to {:g}{}", first_, second_, of);
  if (law_ == Law::weibull) out = fmt::format("weibull, shape {:g}, scale {:g}{}", first_, second_, of);
  const double share = kept();
  if (share == 1) return out;
  const Moments drawn = moments();
  // The smallest number above 0 stands for a bound that is open.
  const double low = low_ < std::numeric_limits<double>::min() && low_ > 0 ? 0 : low_;
  return out + fmt::format("; cut to [{:g}, {:g}]{}, which keeps {:.4g} %: mean {:.4g}, sd {:.4g}{}", low, high_, of,
                           100 * share, drawn.mean, drawn.sd, of);
}

}  // namespace scree::core
