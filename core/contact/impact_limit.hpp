#pragma once
#include "core/contact/rule.hpp"
#include "core/contact/run_law.hpp"
#include "core/contact/scratch.hpp"

namespace scree::core {

/// Stiffness at the deepest point of the collision of each pair in the batch, N/m: where the work of the law's normal
/// force equals m v^2 / 2 with the effective mass and the closing speed `v` (m/s). For a law whose stiffness does not
/// change that is its tangent. Uses the gaps of the scratch and leaves them as they were.
void peak_stiffness(const BoundRule& rule, uint32_t n, const double* v, const Tangents& now, Scratch& s, double* peak);

/// Whether the pair is in or before a collision: open and closing, or touching with more energy in its motion than in
/// its spring, so that it opens again. `v` is the speed of opening along the normal, m/s.
inline bool collides(double gap, double v, double mass, double kn) {
  return gap > 0 ? v < 0 : mass * v * v > kn * gap * gap;
}

}  // namespace scree::core
