#pragma once
#include <algorithm>
#include <cmath>

#include "core/contact/scratch.hpp"

namespace scree::core {

/// Energies of contacts in one pass, J: what is stored now, and what the drift that led here cost.
struct ContactEnergy {
  double strain = 0;    ///< stored in contacts without a bond
  double bond = 0;      ///< stored in bonded pairs: in the bond and in the contact beside it
  double friction = 0;  ///< lost to slip
  double dashpot = 0;   ///< lost to dashpots
  double broken = 0;    ///< held by the bonds that broke

  ContactEnergy& operator+=(const ContactEnergy& other) {
    strain += other.strain;
    bond += other.bond;
    friction += other.friction;
    dashpot += other.dashpot;
    broken += other.broken;
    return *this;
  }
  /// The work of dashpots by the trapezoidal rule. A law knows only the velocity of the half step before its force, and
  /// with it says what the dashpots took; the velocity of the half step after it is seen one pass later. Half of each
  /// counts; as both are squares of a velocity, their geometric mean is the mixed product. `last` is what the pass
  /// before said.
  static double dashpot_work(double now, double last) {
    return 0.5 * now + 0.5 * std::sqrt(std::max(0.0, now) * std::max(0.0, last));
  }
  /// A contact ended: the second half of its last force.
  static double dashpot_end(double last) { return 0.5 * last; }
  /// The first n contacts of a batch whose law filled the energies.
  void add(bool bonded, uint32_t n, const Scratch& s) {
    double stored = 0;
    for (uint32_t k = 0; k < n; ++k) {
      stored += s.energy[0][k];
      friction += s.energy[1][k];
      dashpot += s.energy[2][k];
      broken += s.energy[3][k];
    }
    (bonded ? bond : strain) += stored;
  }
};

}  // namespace scree::core
