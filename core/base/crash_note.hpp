#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

namespace scree::core {

/// What a thread is doing right now, for the message of a crash and of the watchdog: plain words written before each
/// call into a plug-in. The texts must outlive the call (names of components and rules do).
struct CrashNote {
  const char* plugin = nullptr;
  const char* rule = nullptr;  ///< rule, process, wall or recorder
  uint64_t cycle = 0, block = 0;
  uint64_t id1 = 0, id2 = 0;   ///< first pair of the batch; 0: not known
  const char* wall = nullptr;  ///< the second piece of that pair, where it is a wall
};

/// The note of one thread, which other threads may read: relaxed words, which cost what plain ones do. A reader may
/// see words of two calls; those of a thread that is stuck in one call belong together.
class ThreadNote {
 public:
  ThreadNote& operator=(const CrashNote& note) {
    plugin_.store(note.plugin, std::memory_order_relaxed);
    rule_.store(note.rule, std::memory_order_relaxed);
    cycle_.store(note.cycle, std::memory_order_relaxed);
    block_.store(note.block, std::memory_order_relaxed);
    id1_.store(note.id1, std::memory_order_relaxed);
    id2_.store(note.id2, std::memory_order_relaxed);
    wall_.store(note.wall, std::memory_order_relaxed);
    return *this;
  }
  CrashNote read() const {
    return {plugin_.load(std::memory_order_relaxed), rule_.load(std::memory_order_relaxed),
            cycle_.load(std::memory_order_relaxed),  block_.load(std::memory_order_relaxed),
            id1_.load(std::memory_order_relaxed),    id2_.load(std::memory_order_relaxed),
            wall_.load(std::memory_order_relaxed)};
  }

 private:
  std::atomic<const char*> plugin_{nullptr}, rule_{nullptr};
  std::atomic<uint64_t> cycle_{0}, block_{0}, id1_{0}, id2_{0};
  std::atomic<const char*> wall_{nullptr};
};

inline thread_local constinit ThreadNote crash_note{};

/// Lets other threads read the note of the calling thread until that ends. [any thread]
void show_crash_note();
/// The notes of all threads that show theirs and are inside a plug-in now. [any thread]
std::vector<CrashNote> shown_crash_notes();

}  // namespace scree::core
