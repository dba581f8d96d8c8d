#pragma once
#include <scree/abi.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// A component that passed every check, with what is worth telling about its loading.
struct Loaded {
  Component component;
  std::vector<std::string> remarks;  ///< what its start-up code did that it should not, and what was done about it
};

/// Checks the file, opens it and checks what it holds. None of its code runs before the file's own checks have passed.
/// Throws Refusal(Exit::plugin). [one thread]
Loaded load_component(Kind kind, const std::string& name, const std::filesystem::path& file);

}  // namespace scree::core
