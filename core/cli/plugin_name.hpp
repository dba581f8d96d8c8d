#pragma once
#include <string>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// Refuses (exit 2) what cannot name a new plug-in of this kind: other signs than letters, digits and `_`, no letter in
/// front, a word of C++ or of scenes, more than 64 signs, or the name of one that is installed.
void check_plugin_name(Kind kind, const std::string& name, const Catalogue& catalogue);

/// The name in PascalCase, as in `RollingDisc` for `rolling_disc`; with the kind behind it where the headers of the SDK
/// have such a type already, as in `BallGenerator`.
std::string struct_name(Kind kind, const std::string& name);

}  // namespace scree::core
