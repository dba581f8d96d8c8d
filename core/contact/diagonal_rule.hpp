#pragma once
#include "core/contact/contacts.hpp"

namespace scree::core {

/// The rule that most programs choose their step by, over the contacts of now.
struct DiagonalRule {
  /// The least sqrt(m/k) and sqrt(I/k_rot) over balls and axes x, y, z, with k the diagonal of the summed stiffness of
  /// a ball's contacts, s; 0 while nothing touches. The usual step is 0.8 of it (Itasca, PFC manual; the same sums in
  /// Smilauer & Chareyre, Yade formulation). No bound, as it depends on the axes: for comparison only.
  double step = 0;
  bool dashpots = false;  ///< one of the contacts has a dashpot
};

/// [between passes]
DiagonalRule diagonal_rule(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                           const PeriodicCell& cell, Team& team);

}  // namespace scree::core
