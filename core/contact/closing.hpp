#pragma once
#include "core/base/threads.hpp"
#include "core/contact/contacts.hpp"
#include "core/contact/step_bound.hpp"

namespace scree::core {

/// The listed pair of balls that closes by `depth` of its smaller radius first, and in what time; nothing when it takes
/// longer than `longest` (s). A look at the balls alone where none moves much beside the others. The same for any
/// number of threads.
StepBound soonest_closing(const Contacts& contacts, const Balls& balls, const PeriodicCell& cell, double depth,
                          double longest, Team& team);

}  // namespace scree::core
