#pragma once
#include <functional>
#include <string>

namespace scree::core::vet {

/// How a child process ended.
struct ChildEnd {
  std::string bytes;       ///< what the work returned; "" unless it returned
  bool finished = false;   ///< it returned
  bool timed_out = false;  ///< it was killed after `limit`
  int signal = 0;          ///< the signal that ended it
  int code = 0;            ///< its exit code, where no signal ended it
};

/// Runs `work` in a child process and brings back what it returns, so that whatever the code of a plug-in does - crash,
/// loop for ever, exit, ruin the process - is something to report. The child writes to no stream of ours. `work` must
/// not throw. `limit` in seconds of wall time. Call while the program has one thread.
ChildEnd isolated(const std::function<std::string()>& work, double limit);

}  // namespace scree::core::vet
