#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/scene/context.hpp"
#include "core/scene/tree.hpp"

namespace scree::core {

/// Puts the fragments of `include:` into the tree, at the top and in stages. `file`: real path of the scene, "" if
/// none.
void include_fragments(Node& root, const std::string& file, const Folders& folders, Report& report);

/// Applies `--set a.b=c`: a path into mappings; in lists a number, or the name of an entry. The parent must exist.
void apply_overrides(Node& root, const std::vector<std::pair<std::string, std::string>>& set, Report& report);

}  // namespace scree::core
