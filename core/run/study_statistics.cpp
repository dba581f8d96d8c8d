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

}  // namespace scree::core
