// The a-priori error of an impact against leapfrog itself.
#include "core/run/error_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"

using scree::core::worst_impact_error;

namespace {

// A unit mass meets a spring of stiffness 1, whose limit is 2, with speed 1; the worst over all phases of the step.
double worst_of_phases(double share) {
  const double step = 2 * share;
  double worst = 0;
  for (int phase = 0; phase < 500; ++phase) {
    double x = step * (phase + 0.5) / 500, v = -1;
    do {
      v += x < 0 ? -x * step : 0;
      x += v * step;
    } while (v < 0 || x < 0);
    worst = std::max(worst, std::fabs(v - 1));
  }
  return worst;
}

}  // namespace

TEST_CASE("the error of an impact is the worst over the phases of its entry", "[run]") {
  for (const double share : {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8}) {
    INFO("share of the limit " << share);
    CHECK(worst_impact_error(share) == Approx(worst_of_phases(share)).epsilon(0.1));
  }
  // Between the steps of the table it rises steadily, and a step of nothing has no error.
  CHECK(worst_impact_error(0.25) > worst_impact_error(0.2));
  CHECK(worst_impact_error(0.25) < worst_impact_error(0.3));
  CHECK(worst_impact_error(0) == 0);
}
