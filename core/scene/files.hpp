#pragma once
#include <optional>
#include <string>

#include "core/scene/context.hpp"

namespace scree::core {

/// The place of a file that a scene names: absolute, and below the scene's folder or another allowed folder, links
/// resolved. `from`: the folder of the file that names it, tried first. Nothing comes back when it is refused
/// (reported).
std::optional<std::string> find_file(const std::string& name, const std::filesystem::path& from, const Place& place,
                                     const Folders& folders, Report& report);

/// Is the name free of absolute paths and of `..`? Reports when not.
bool is_inner_path(const std::string& name, const Place& place, Report& report);

}  // namespace scree::core
