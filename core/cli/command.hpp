#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace CLI {
class App;
}

namespace scree::core {

/// What a command does once its flags are read.
using Deed = std::function<Exit()>;

/// One command of the program: a word, what follows it, a line for the help, and its flags.
struct Command {
  std::string name, operands, line;
  Deed (*declare)(CLI::App& app);  ///< declares the flags and returns what reads them
};

/// All commands, in the order of the help.
const std::vector<Command>& commands();

Deed declare_run(CLI::App& app);
Deed declare_resume(CLI::App& app);
Deed declare_check(CLI::App& app);
Deed declare_explain(CLI::App& app);
Deed declare_list(CLI::App& app);
Deed declare_show(CLI::App& app);
Deed declare_vet(CLI::App& app);
Deed declare_new(CLI::App& app);
Deed declare_schema(CLI::App& app);
Deed declare_study(CLI::App& app);
Deed declare_demo(CLI::App& app);

}  // namespace scree::core
