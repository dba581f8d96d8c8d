#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace scree::core {

/// What the program returns to the shell; docs/cli.md lists the same table.
enum class Exit : int {
  done = 0,
  internal = 1,
  usage = 2,
  scene = 3,
  plugin = 4,
  numerical = 5,
  io = 6,
  expectation = 7,
  memory = 8,
  folder_in_use = 9,
  time_limit = 75,
  interrupted = 130,
  terminated = 143
};

/// A point in a text file. Line and column count from 1; 0 means unknown.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
  std::string text() const;  ///< "file:line:column", as far as known
};

/// A refusal with the exit code it leads to. `what()` is the whole message: what, where, why, what next.
class Refusal : public std::runtime_error {
 public:
  Refusal(Exit code, const std::string& message) : std::runtime_error(message), code_(code) {}
  Exit code() const { return code_; }

 private:
  Exit code_;
};

}  // namespace scree::core
