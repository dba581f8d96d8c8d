#pragma once
#include <string>
#include <vector>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// One plug-in for a reader: what it is, its keys, what it remembers and asks for, and lines to paste into a scene.
std::string component_text(const Component& component);
std::string component_json(const Component& component);

/// Lines of a scene that use it: what must be given, and the rest as comments with its defaults.
std::string snippet(const Component& component);
/// What the plug-in declares beside its keys, one line each.
std::vector<std::string> declared(const Component& component);

}  // namespace scree::core
