#pragma once
#include <cstdint>
#include <vector>

#include "core/base/threads.hpp"
#include "core/contact/slices.hpp"
#include "core/world/balls.hpp"

namespace scree::core {

constexpr uint64_t monitor_every = 100;  ///< cycles

/// The frequency of the motion as the forces show it: q = dt v.(F_old - F_new) / (v.M v) over all balls, with v the
/// velocity that led from the one force to the other. A network that moves in its highest mode shows dt^2 w^2, which is
/// 4 at the stable limit and more beyond it (the idea of Park and Underwood, Comput. Methods Appl. Mech. Eng. 23 (1980)
/// 259). Contact forces only: others do not oscillate with the network. Reads, and never changes the motion.
class FrequencyWatch {
 public:
  /// After a kick: forces of this time, velocities of the half step after it.
  void note(const Balls& balls, Slices& slices, Team& team);
  bool noted() const { return noted_; }
  /// With the forces of the next time: q; 0 where the motion is too small to tell from rounding.
  double measure(const Balls& balls, Slices& slices, double dt, double least_radius, Team& team);
  void forget() {
    noted_ = false;
    streak_ = 0;
  }
  /// Measurements in a row that were beyond the limit.
  int streak() const { return streak_; }
  /// Counts one; true when it is the last that can be put down to chance.
  bool beyond(bool above) { return (streak_ = above ? streak_ + 1 : 0) >= 4; }

 private:
  struct Sums {
    double power = 0, inertia = 0, mass = 0;
  };
  static Sums sums(const Balls& balls, Slices& slices, Team& team);
  double power_ = 0;
  bool noted_ = false;
  int streak_ = 0;
};

/// Which rules have been found to be stiffer than their law reports, and warned of.
struct HonestyWatch {
  std::vector<uint8_t> warned;
};

}  // namespace scree::core
