#pragma once
#include <Eigen/Dense>
#include <cstdint>

#include "core/contact/links.hpp"

namespace scree::core {

using Block = Eigen::Matrix<double, 6, 6>;

/// Adds one end of a link to the block of its ball, in units that make the ball's mass and inertia 1: `weight` over the
/// mass times normal and shear springs kn, ks and bending and twist springs kb, kt. Only the lower triangle.
void add_end(Block& block, const Link& link, int end, double kn, double ks, double kb, double kt,
             double weight_per_mass, double radius);

/// Largest eigenvalue of a symmetric block that has no negative one, from its lower triangle, by powers: within a few
/// thousandths, from below. 0 for a zero block.
double nearly_largest(const Block& block);

/// Whether limit - h^2 stiffness - h damping is positive definite.
bool stable(const Block& stiffness, const Block& damping, double h, double limit);

/// The largest h for which limit - h^2 stiffness - h damping has no negative eigenvalue, to rounding. `high` is not
/// stable.
double largest_stable(const Block& stiffness, const Block& damping, double high, double limit);

}  // namespace scree::core
