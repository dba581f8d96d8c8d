#pragma once
#include <scree/abi.h>

#include <filesystem>
#include <string>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

/// A component that passed every check, with what is worth telling about its loading.
struct Loaded {
  Component component;
  bool changed_float_mode = false;  ///< its start-up code changed the floating-point mode, which was put back
};

/// Checks the file, opens it and checks what it holds. None of its code runs before the file's own checks have passed.
/// Throws Refusal(Exit::plugin). [one thread]
Loaded load_component(Kind kind, const std::string& name, const std::filesystem::path& file);

}  // namespace scree::core
