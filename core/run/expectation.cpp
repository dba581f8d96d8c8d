#include "core/run/expectation.hpp"

#include <algorithm>
#include <cmath>

namespace scree::core {

namespace {

ExpectationResult measured(const Expect& expect, double value) {
  ExpectationResult result;
  result.text = expect.text;
  result.quantity = expect.quantity->text();
  result.value = value;
  result.low = expect.low;
  result.high = expect.high;
  result.equals = expect.equals;
  result.tolerance = expect.tolerance;
  result.source = expect.source;
  result.passed = !std::isnan(value);
  if (expect.equals) {
    result.difference = std::abs(value - *expect.equals);
    result.passed = result.passed && *result.difference <= expect.tolerance.value_or(0);
  }
  if (expect.low) result.passed = result.passed && value >= *expect.low;
  if (expect.high) result.passed = result.passed && value <= *expect.high;
  if (!result.difference && (expect.low || expect.high)) {
    const double to_low = expect.low ? std::abs(value - *expect.low) : INFINITY;
    const double to_high = expect.high ? std::abs(value - *expect.high) : INFINITY;
    result.difference = std::isnan(value) ? value : std::min(to_low, to_high);
  }
  return result;
}

}  // namespace

std::vector<ExpectationResult> measured_expectations(const Scene& scene, Quantities& quantities) {
  std::vector<ExpectationResult> results;
  for (const Expect& expect : scene.expect) results.push_back(measured(expect, quantities.value(*expect.quantity)));
  return results;
}

Needs expectation_needs(const Scene& scene, Quantities& quantities) {
  Needs sum;
  for (const Expect& expect : scene.expect) sum |= quantities.needs(*expect.quantity);
  return sum;
}

}  // namespace scree::core
