#pragma once
#include "core/scene/context.hpp"

namespace scree::core {

/// Everything about names and pairs: duplicates, names that do not exist (any more) where a stage uses them, pairs
/// without a rule, properties that neither rule nor pieces give, quantities in a circle. Fills in the input form of
/// rules whose properties come from the pieces.
void check_scene(Scene& scene, Context& context);

}  // namespace scree::core
