#pragma once
#include <cstdint>
#include <vector>

#include "core/base/array.hpp"
#include "core/cycle/energy_balance.hpp"

namespace scree::core {

/// What is read at time n, after the force pass and before the motion. Sums follow blocks, so they do not depend on
/// threads.
struct Observation {
  uint64_t cycle = ~uint64_t{0};
  double unbalanced = 0;      ///< mean |net force| over free balls divided by mean sum of |contact force|
  double unbalanced_max = 0;  ///< largest |net force| over that mean
  double kinetic = 0;         ///< translation and rotation, with v(n), J
  double kinetic_shadow = 0;  ///< with the product of the two half-step velocities: constant for a linear oscillator, J
  double kinetic_shadow_back = 0;  ///< the same with the step of the last drift, J
  RowWork work_before;  ///< of the forces of this time over half of the drift that led here; only with a ledger
  /// Velocity and spin at time n, net force (contacts, applied, body), all by row.
  Array<double> velocity[3], spin[3], force[3];
};

}  // namespace scree::core
