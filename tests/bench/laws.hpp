#pragma once
#include "core/plugin/catalogue.hpp"

namespace scree::bench {

/// Prints what a ball-step of the dense packing costs under each law, one thread, the best instruction set, in turns.
void compare_all_laws(core::Catalogue& catalogue);

}  // namespace scree::bench
