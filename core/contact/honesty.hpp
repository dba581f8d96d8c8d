#pragma once
#include <cstdint>

#include "core/contact/contacts.hpp"

namespace scree::core {

/// The stiffness of one contact as its forces show it, beside what its law reports; of the parts the worst.
struct Honesty {
  std::size_t rule = 0;
  uint64_t id1 = 0, id2 = 0;
  const char* part = "";
  double reported = 0, measured = 0;  ///< N/m
  /// Measured over reported; 0 when nothing was measured.
  double share() const;
};

/// Moves copies of the contact in the slot a little along and across its normal and lets the law run on them: finite
/// differences of its force. `at` counts the slots of all lists. Nothing is changed. A slot whose law does not run
/// gives nothing. `dt` is the step of the run.
Honesty look_at_stiffness(const Contacts& contacts, const Balls& balls, const PeriodicCell& cell, uint64_t at,
                          double dt);

}  // namespace scree::core
