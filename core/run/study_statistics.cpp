#include "core/run/study_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree::core {

std::optional<double> fitted_order(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0;
  for (const auto& [step, error] : points) {
    x += std::log(step) / static_cast<double>(points.size());
    y += std::log(error) / static_cast<double>(points.size());
  }
  double xx = 0, xy = 0;
  for (const auto& [step, error] : points) {
    xx += (std::log(step) - x) * (std::log(step) - x);
    xy += (std::log(step) - x) * (std::log(error) - y);
  }
  if (points.size() < 2 || !(xx > 0)) return std::nullopt;
  return xy / xx;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double t_quantile(std::size_t freedom) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2.
  static constexpr double few[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};
  if (freedom <= std::size(few)) return few[std::max<std::size_t>(freedom, 1) - 1];
  // Abramowitz & Stegun, Handbook of Mathematical Functions (1964), 26.7.5.
  const double z = 1.959963984540054, n = static_cast<double>(freedom), z2 = z * z;
  return z + z * ((z2 + 1) / 4 / n + ((5 * z2 + 16) * z2 + 3) / 96 / (n * n) +
                  (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384 / (n * n * n));
}

Mean mean_of(const std::vector<double>& values) {
  Mean out;
  const double n = static_cast<double>(values.size());
  for (double value : values) out.mean += value / n;
  if (values.size() < 2) {
    out.interval = std::numeric_limits<double>::infinity();
    return out;
  }
  double squares = 0;
  for (double value : values) squares += (value - out.mean) * (value - out.mean);
  out.deviation = std::sqrt(squares / (n - 1));
  out.interval = t_quantile(values.size() - 1) * out.deviation / std::sqrt(n);
  return out;
}

std::optional<Slope> slope_of(const std::vector<std::pair<double, double>>& points) {
  constexpr std::size_t stretches = 10;
  if (points.size() < 2 * stretches || !(points.back().first > points.front().first)) return std::nullopt;
  double x[stretches] = {}, y[stretches] = {}, middle = 0, level = 0;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t first = s * points.size() / stretches, last = (s + 1) * points.size() / stretches;
    for (std::size_t k = first; k < last; ++k) {
      x[s] += points[k].first / static_cast<double>(last - first);
      y[s] += points[k].second / static_cast<double>(last - first);
    }
    middle += x[s] / stretches;
    level += y[s] / stretches;
  }
  double xx = 0, xy = 0, squares = 0;
  for (std::size_t s = 0; s < stretches; ++s) {
    xx += (x[s] - middle) * (x[s] - middle);
    xy += (x[s] - middle) * (y[s] - level);
  }
  Slope out{xy / xx, 0};
  for (std::size_t s = 0; s < stretches; ++s) {
    const double off = y[s] - level - out.slope * (x[s] - middle);
    squares += off * off;
  }
  out.interval = t_quantile(stretches - 2) * std::sqrt(squares / (stretches - 2) / xx);
  return out;
}

}  // namespace scree::core
