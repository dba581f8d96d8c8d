#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/plugin/catalogue.hpp"
#include "core/vet/check.hpp"

namespace scree::core::vet {

/// One check that was made.
struct Row {
  std::string component;  ///< "contact_model NAME"; "library" for a check of the whole library
  std::string check, shows;
  Outcome outcome;
  double seconds = 0;
};

struct Options {
  std::string only;       ///< the name of one check; "": all
  std::string component;  ///< the name of one component; "": the library and all that it holds
  double limit = 30;      ///< s, wall time of one check
};

/// Makes every check of a library and of each component in it, each check in a process of its own; `done` hears of each
/// as it ends. Throws Refusal(Exit::usage) when `only` names no check. [one thread, and no other thread may run]
std::vector<Row> vet(const std::filesystem::path& file, const Options& options,
                     const std::function<void(const Row&)>& done);

/// The names of all checks, with what they show; the same name may be there for several kinds.
std::vector<std::pair<std::string, std::string>> all_checks();

}  // namespace scree::core::vet
