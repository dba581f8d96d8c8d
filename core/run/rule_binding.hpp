#pragma once
#include "core/contact/rule.hpp"
#include "core/run/simulation.hpp"

namespace scree::core {

/// The law of one rule with its properties resolved: uniform values once, the rest as a function of a new contact.
/// Throws SceneErrors with places: a property that is given nowhere, a law that refuses its values.
BoundRule bind_rule(const Simulation& simulation, const Rule& rule);

}  // namespace scree::core
