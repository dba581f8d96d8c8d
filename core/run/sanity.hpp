#pragma once
#include <string>
#include <vector>

#include "core/run/simulation.hpp"

namespace scree::core {

/// What a scene can say without an error and rarely means: a ball that its own weight presses deep into its contacts
/// (often a length in the wrong unit), balls of which one swings hundreds of times as slowly as another, a step close
/// to the stable limit, and what rule_doubts.hpp and far_away.hpp say. Each is a sentence for the log. Call once the
/// forces of the first time are there; nothing changes. Throws Refusal for what cannot be computed at all. [one thread]
std::vector<std::string> doubts(Simulation& simulation);

}  // namespace scree::core
