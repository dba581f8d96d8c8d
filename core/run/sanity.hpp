#pragma once
#include <string>
#include <vector>

#include "core/run/simulation.hpp"

namespace scree::core {

/// What a scene can say without an error and rarely means: a ball that its own weight presses deep into its contacts
/// (often a length in the wrong unit), and friction without a shear spring. Each is a sentence for the log. Call once
/// the forces of the first time are there; nothing changes. [one thread]
std::vector<std::string> doubts(Simulation& simulation);

}  // namespace scree::core
