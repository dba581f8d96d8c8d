#pragma once
#include <string>

#include "core/contact/contacts.hpp"

namespace scree::core {

/// The stable step of all listed pairs, touching or not, and what governs it.
struct StepBound {
  double step = 0;       ///< s, without any safety share; 0: nothing limits the step
  double stiffness = 0;  ///< largest weighted eigenvalue of stiffness over inertia, 1/s2
  double damping = 0;    ///< the same of the dashpots, 1/s
  uint64_t ball = 0;     ///< id of the ball that governs, 0: none
  std::string term;      ///< "contacts" or "possible pair"
};

/// Local bound: for every ball the 6x6 blocks (translation and rotation) of its contacts are summed, counted twice
/// where the other piece moves and once where it does not. As |a - b|^2 <= 2|a|^2 + 2|b|^2 in the norm of each contact,
/// the largest eigenvalue over all balls bounds the network's; the step follows from (dt/2)^2 stiffness + (dt/2)
/// damping <= 1, which holds for dashpots that use the velocity of the half step before. The result is scaled by
/// 1/sqrt(1 + local_damping) (Cundall's damping enlarges the force of a slowing ball).
StepBound step_bound(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                     const PeriodicCell& cell, double local_damping);

/// The bound from each ball's stiffest possible pair under any rule it may meet: what limits the step before anything
/// is listed.
StepBound possible_pairs(const RuleBook& book, const Balls& balls, const std::vector<Wall>& walls,
                         double local_damping);

/// Of two bounds the smaller step; a step of 0 means no limit.
StepBound smaller(const StepBound& a, const StepBound& b);

}  // namespace scree::core
