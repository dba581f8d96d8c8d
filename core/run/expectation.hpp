#pragma once
#include <vector>

#include "core/run/quantities.hpp"
#include "core/run/summary.hpp"

namespace scree::core {

/// What the scene expects, measured at the present cycle; the caller has run the forces with `expectation_needs`. A
/// value that is not a number fails. `difference` is the distance to `equals`, or to the nearer bound.
std::vector<ExpectationResult> measured_expectations(const Scene& scene, Quantities& quantities);
Needs expectation_needs(const Scene& scene, Quantities& quantities);

}  // namespace scree::core
