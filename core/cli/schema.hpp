#pragma once
#include <string>
#include <vector>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// The JSON Schema (draft-07) of scenes that use these components: keys of the kernel and of each component with units,
/// ranges, defaults and docs. What no schema can tell (units, names, arithmetic) is left to `scree check`.
std::string schema_text(const std::vector<const Component*>& components);

/// The same for all plug-ins that are found; those that are refused are warned of and left out.
std::string schema_text(Catalogue& catalogue);

}  // namespace scree::core
