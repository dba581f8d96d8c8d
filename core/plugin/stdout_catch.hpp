#pragma once
#include <string>

namespace scree::core {

/// While it lives, what anybody writes to stdout is kept: stdout carries results that programs read, and the start-up
/// code of a library may write there. [one thread]
class StdoutCatch {
 public:
  StdoutCatch();
  ~StdoutCatch();
  StdoutCatch(const StdoutCatch&) = delete;
  StdoutCatch& operator=(const StdoutCatch&) = delete;

  /// Gives stdout back and returns what was written, on one line and cut at 200 bytes.
  std::string take();

 private:
  int kept_ = -1, real_ = -1;  ///< a file in memory; the stdout of before
};

}  // namespace scree::core
