#pragma once
#include <scree/abi.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/plugin/catalogue.hpp"
#include "core/plugin/elf_check.hpp"

namespace scree::core {

/// Version and sizes, from the file, before any of its code is loaded. Throws Refusal(Exit::plugin).
void check_numbers(const HeaderNumbers& numbers, const std::filesystem::path& file);

/// The component of this kind and name in a loaded library. Throws Refusal(Exit::plugin) when it is missing, has
/// another kind, or the list of components is not sound.
const scree_component& find_component(const scree_plugin_header& header, Kind kind, const std::string& name,
                                      const std::filesystem::path& file);

/// Kind and name of every component of a loaded library. Throws Refusal(Exit::plugin) when the list is not sound.
std::vector<std::pair<Kind, std::string>> components_of(const scree_plugin_header& header,
                                                        const std::filesystem::path& file);

}  // namespace scree::core
