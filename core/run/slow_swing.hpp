#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/cycle/engine.hpp"

namespace scree::core {

/// How slowly a long body of bonded balls swings.
struct SlowSwing {
  double square = 0;       ///< rad2/s2, of its slowest swing at most; 0: there is no such body
  std::size_t balls = 0;   ///< in the body
  std::size_t length = 0;  ///< bonds on the way from one end to the other
  uint64_t id = 0;         ///< of a ball at an end
};

/// The slowest of the bodies that are at least a hundred bonds long. By Rayleigh and Ritz: a motion of a few degrees of
/// freedom (bending in two directions, of rigid sections across the longest axis of the body) that leaves fixed balls
/// where they are, or that a free body can make without moving as a whole, swings at least as fast as the slowest one
/// of all. For a straight body that is the bending of a beam. Bodies that reach round a periodic cell, and mechanisms,
/// which have motions without force, are left out. Call between cycles, with lists that hold the bonds. [one thread]
SlowSwing slow_swing(Engine& engine);

/// A sentence for the log when one swing of it takes more than a million cycles, else "".
std::string slow_bonds(Engine& engine);

}  // namespace scree::core
