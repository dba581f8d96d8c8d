#pragma once
#include <string>

#include "core/plugin/catalogue.hpp"

namespace scree::bench {

/// Runs the dense packing under two contact models in turns, in one process, and prints ns per ball-step of each and
/// the median ratio of the second to the first. 1 when the ratio is above the limit, else 0.
int compare_laws(const std::string& one, const std::string& other, double limit, core::Catalogue& catalogue);

}  // namespace scree::bench
