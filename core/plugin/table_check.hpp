#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// Columns that a process may declare.
inline constexpr uint32_t most_needs = 64;

/// Checks the table of a component, so that the rest of the kernel may trust it: sizes, names, types, words within the
/// rule, functions that are there. Throws Refusal(Exit::plugin).
void check_table(Kind kind, const std::string& name, const void* table, const std::filesystem::path& file);

}  // namespace scree::core
