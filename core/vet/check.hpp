#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/plugin/catalogue.hpp"
#include "core/vet/outcome.hpp"

namespace scree::core::vet {

/// What a check looks at. Every check runs in a process of its own.
struct Subject {
  std::filesystem::path file;            ///< absolute
  const Component* component = nullptr;  ///< null for a check of the library, which is then not loaded yet
};

/// One conformance check.
struct Check {
  const char* name;   ///< as in `--check`
  const char* shows;  ///< one line: what a pass shows
  Outcome (*run)(const Subject& subject);
};

/// The checks of a library, whatever it holds, in order; of a component of a kind, those of every kind included.
const std::vector<Check>& library_checks();
std::vector<Check> component_checks(Kind kind);

}  // namespace scree::core::vet
