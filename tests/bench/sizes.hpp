#pragma once
#include "core/plugin/catalogue.hpp"

namespace scree::bench {

/// A layer of 100 000 balls on one that is 100 times as large beside a block of as many equal balls, in turns: time of
/// a cycle and of a contact, rebuilds of the lists included, on one thread.
void compare_sizes(core::Catalogue& catalogue);

}  // namespace scree::bench
