#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// Columns that a process may declare.
inline constexpr uint32_t most_needs = 64;

/// The table of a component in this program's own shape, checked so that the rest of the kernel may trust it: sizes,
/// names, types, words within the rule, functions that are there. Throws Refusal(Exit::plugin).
std::shared_ptr<const void> checked_table(Kind kind, const std::string& name, const void* theirs,
                                          const std::filesystem::path& file);

}  // namespace scree::core
