#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/report.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/tree.hpp"

namespace scree::core {

/// Gives the component of a kind and name, or throws Refusal(Exit::plugin).
using OpenComponent = std::function<const Component&(Kind, const std::string&)>;

/// A file that a scene may read: below the scene's folder, or below a folder given on the command line.
struct Folders {
  std::filesystem::path scene;
  std::vector<std::filesystem::path> others;
};

/// What a rule or process is made of, for `set`.
struct Known {
  const Component* component = nullptr;
  std::optional<uint32_t> form;  ///< input form that its own settings chose
};

/// What every part of the reader needs while it reads one scene.
struct Context {
  Report& report;
  const OpenComponent& open;
  Folders folders;
  std::map<std::string, double> vars;
  std::map<std::string, std::string> var_units;  ///< unit of a var written as a number, "" for plain numbers
  std::map<std::string, Known> rules, processes;
  bool rules_doubtful = false;  ///< a rule could not be read: pairs without one prove nothing
};

}  // namespace scree::core
