#pragma once
#include "core/contact/links.hpp"

namespace scree::core {

/// What an estimate of the network's limit may use and must cover.
struct NetworkQuery {
  LinkQuery links;
  unsigned sweeps = 0;  ///< of weights, at most; 0: equal weights, the cheapest
  double enough = 0;    ///< s; with equal weights a larger step is not looked for, and the bound left open; 0: it is
  double local_damping = 0;  ///< Cundall's factor
};

struct NetworkBound {
  StepBound network;            ///< "network", or "damping" where dashpots take more than a tenth of the step
  StepBound impact, kinematic;  ///< see Links
  unsigned sweeps = 0;          ///< how many were made
  std::size_t links = 0;        ///< contacts that were looked at
};

/// Certified limit of the step for the contacts of the scene. For any s > 0 the energy of a contact obeys
/// |a - b|^2 <= (1 + s)|a|^2 + (1 + 1/s)|b|^2, so that with s = d_j/d_i any positive weights d of the balls give 6x6
/// blocks K_i and C_i whose sums over balls bound springs and dashpots of the whole network. With h = dt/2 the step is
/// stable where h^2 K_i + h C_i <= M_i / (1 + local damping) for every ball i: dashpots use the velocity of half a step
/// before, and local damping multiplies the force on a slowing ball. Sweeps improve the weights; each is a valid bound
/// and the best is kept. The same bits for any number of threads.
NetworkBound network_bound(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                           const PeriodicCell& cell, const NetworkQuery& query, Team& team);

}  // namespace scree::core
