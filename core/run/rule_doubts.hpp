#pragma once
#include <string>
#include <vector>

#include "core/run/simulation.hpp"

namespace scree::core {

/// Values of rules that are allowed and rarely meant: friction without a shear spring, a dashpot so strong that parting
/// pieces stick to it, a bond wider than the balls that it joins. Each is a sentence for the log, with its place.
std::vector<std::string> rule_doubts(const Simulation& simulation);

}  // namespace scree::core
