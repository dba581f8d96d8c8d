#pragma once
#include <string>

#include "core/base/error.hpp"

namespace scree::core {

/// Refuses the table of one component: where it is, what is wrong, what to do.
struct TableRefusal {
  std::string where;  ///< file, kind and name
  [[noreturn]] void operator()(const std::string& why) const {
    throw Refusal(Exit::plugin, where + why + ": build the plug-in with this SDK, or report it to its author");
  }
};

}  // namespace scree::core
