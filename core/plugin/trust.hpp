#pragma once
#include <filesystem>

namespace scree::core {

/// Loading a library runs its code with the user's rights, so only files that nobody else can change are loaded: the
/// file and its folder must belong to root or to the user, and neither the world nor a shared group may write to them.
/// Throws Refusal(Exit::plugin). [any thread]
void require_trusted(const std::filesystem::path& path);

}  // namespace scree::core
