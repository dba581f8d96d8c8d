// The straight line through the residuals of a run, against least squares done by hand.
#include <cmath>

#include "core/run/study_statistics.hpp"
#include "support/catch.hpp"

using scree::core::slope_of;

TEST_CASE("the slope of a straight line is its own, with no doubt left") {
  std::vector<std::pair<double, double>> points;
  for (int k = 0; k < 57; ++k) points.emplace_back(10 * k, 1 + 0.3 * k);
  const auto found = slope_of(points);
  REQUIRE(found);
  CHECK(found->slope == Approx(0.03));
  CHECK(found->interval < 1e-12);
}

TEST_CASE("what lies off the line widens the interval of its slope") {
  // Two points to each of ten stretches, whose means lie 1 above and below y = 2 x in turn.
  std::vector<std::pair<double, double>> points;
  for (int k = 0; k < 20; ++k) points.emplace_back(k, 2.0 * k + (k / 2 % 2 == 0 ? 1 : -1));
  const auto found = slope_of(points);
  REQUIRE(found);
  // With x - mean = 2 (s - 4.5): sum of squares 330, sum of products with the alternating ones -10.
  CHECK(found->slope == Approx(2 - 10.0 / 330));
  CHECK(found->interval == Approx(2.306 * std::sqrt((10 - 100.0 / 330) / 8 / 330)));
}

TEST_CASE("too few points have no slope") {
  const std::vector<std::pair<double, double>> points(19, {1.0, 1.0}), one_place(40, {1.0, 1.0});
  CHECK_FALSE(slope_of(points));
  CHECK_FALSE(slope_of(one_place));
}
