#pragma once
#include "core/contact/links.hpp"

namespace scree::core {

/// Whether a step holds for the contacts of the scene.
struct Holding {
  bool holds = true;            ///< no ball's block under equal weights forbids the step, see network_bound
  bool larger = true;           ///< nor one that is larger by the factor asked about
  StepBound impact, kinematic;  ///< see Links
  std::size_t links = 0;        ///< contacts that were looked at
};

/// The question of network_bound where the answer is mostly yes: one look at the contacts, no limit is sought and
/// nothing is kept. `step` in s; `factor` at least 1. The same for any number of threads.
Holding step_holds(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                   const PeriodicCell& cell, const LinkQuery& query, double local_damping, double step, double factor,
                   Team& team);

}  // namespace scree::core
