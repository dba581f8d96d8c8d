#pragma once
#include <cstdint>

namespace scree::core {

/// What a thread is doing right now, for the message of a crash: plain words written before each call into a plug-in,
/// read by nothing but the crash handler. The texts must outlive the call (names of components and rules do).
struct CrashNote {
  const char* plugin = nullptr;
  const char* rule = nullptr;  ///< rule, process, wall or recorder
  uint64_t cycle = 0, block = 0;
  uint64_t id1 = 0, id2 = 0;  ///< first pair of the batch; 0: not known
};

inline thread_local constinit CrashNote crash_note{};

}  // namespace scree::core
