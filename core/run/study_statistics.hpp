#pragma once
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace scree::core {

/// Slope of log(second) over log(first) by least squares; both above 0, at least two points with different firsts.
std::optional<double> fitted_order(const std::vector<std::pair<double, double>>& points);

/// The middle value, or the mean of the two middle ones; NaN of nothing.
double median(std::vector<double> values);

/// Half the width of the 95 % interval of a mean, in standard errors: Student's t at 0.975 with these degrees of
/// freedom, at least 1.
double t_quantile(std::size_t freedom);

struct Mean {
  double mean = 0, deviation = 0;  ///< deviation: of the sample, with n - 1
  double interval = 0;             ///< half the 95 % t-interval of the mean; infinite with fewer than two values
};
Mean mean_of(const std::vector<double>& values);

/// A straight line through (first, second) by least squares over the means of ten stretches of equal count, which
/// are taken as independent where neighbours are not; firsts ascend. Absent with fewer than twenty points.
struct Slope {
  double slope = 0;
  double interval = 0;  ///< half the 95 % t-interval
};
std::optional<Slope> slope_of(const std::vector<std::pair<double, double>>& points);

}  // namespace scree::core
