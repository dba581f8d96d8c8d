#include "core/run/error_estimate.hpp"

#include <cmath>
#include <iterator>

#include "core/cycle/impact_share.hpp"

namespace scree::core {

namespace {

// Leapfrog against the exact impact, the worst of 2000 phases of entry at each step; docs/verification.md, case C1.
struct Impact {
  double share, error;
};
constexpr Impact impacts[] = {{0.01, 1.4e-5}, {0.02, 2.0e-4}, {0.05, 1.2e-3}, {0.1, 4.4e-3},
                              {0.2, 1.3e-2},  {0.3, 2.5e-2},  {0.4, 5.4e-2},  {0.6, 0.25},
                              {0.8, 0.56},    {0.9, 1.24},    {1.0, 2.0}};

}  // namespace

double worst_impact_error(double share) {
  if (!(share > 0)) return 0;
  std::size_t k = 1;
  while (k + 1 < std::size(impacts) && share > impacts[k].share) ++k;
  const Impact &low = impacts[k - 1], &high = impacts[k];
  const double order = std::log(high.error / low.error) / std::log(high.share / low.share);
  return low.error * std::pow(share / low.share, order);
}

std::optional<Summary::Error> error_before_any_reference(const Engine& engine) {
  const StepBound& bound = engine.step.bound();
  // A step that only the way of a ball in one cycle limits says nothing about contacts.
  if (!(bound.step > 0) || !(engine.clock.dt > 0) || bound.term == "kinematic") return std::nullopt;
  const double ratio = engine.clock.dt / bound.step;
  if (bound.term == "pair" || bound.term == "possible pair") {
    const double of_limit = bound.term == "pair" ? (engine.step.accurate ? accurate_share : impact_share) : 1.0;
    return Summary::Error{worst_impact_error(ratio * of_limit), std::nullopt,
                          "a priori: largest relative error of the speed after one undamped impact at this step, over "
                          "all phases of entry, linear law; scree study measures it"};
  }
  // Leapfrog turns a frequency w into (2/dt) asin(w dt/2), too high by (w dt)^2/24 of it to leading order, and no mode
  // of the contacts is faster than 2/limit.
  return Summary::Error{
      ratio * ratio / 6, std::nullopt,
      "a priori: relative frequency error (w dt)^2/24 of the fastest contact mode, w = 2/certified, for contacts that "
      "last; impacts may be worse: scree study measures it"};
}

}  // namespace scree::core
