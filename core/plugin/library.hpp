#pragma once
#include <scree/abi.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// A component that passed every check, with what is worth telling about its loading.
struct Loaded {
  Component component;
  bool changed_float_mode = false;   ///< its start-up code changed the floating-point mode, which was put back
  std::vector<std::string> remarks;  ///< what its start-up code did that it should not, and what was done about it
};

/// Checks the file, opens it and checks what it holds. None of its code runs before the file's own checks have passed.
/// Throws Refusal(Exit::plugin). [one thread]
Loaded load_component(Kind kind, const std::string& name, const std::filesystem::path& file);

/// The whole file. Throws Refusal(Exit::plugin) when it cannot be read or is no file. [any thread]
std::vector<std::byte> read_library(const std::filesystem::path& file);

/// What a library holds, after the same checks of the file. Throws Refusal(Exit::plugin). [one thread]
std::vector<std::pair<Kind, std::string>> list_components(const std::filesystem::path& file);

}  // namespace scree::core
