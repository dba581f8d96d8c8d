#include "core/base/crash_note.hpp"

#include <algorithm>
#include <mutex>

namespace scree::core {

namespace {

struct Shown {
  std::mutex mutex;
  std::vector<const ThreadNote*> notes;
};

// Never destroyed: threads may end after the statics of the program.
Shown& shown() {
  static Shown& all = *new Shown;
  return all;
}

/// The entry of one thread, which leaves with it.
class Entry {
 public:
  Entry() {
    const std::lock_guard lock(shown().mutex);
    shown().notes.push_back(&crash_note);
  }
  ~Entry() {
    const std::lock_guard lock(shown().mutex);
    auto& notes = shown().notes;
    notes.erase(std::remove(notes.begin(), notes.end(), &crash_note), notes.end());
  }
  Entry(const Entry&) = delete;
  Entry& operator=(const Entry&) = delete;
};

}  // namespace

void show_crash_note() { static thread_local Entry entry; }

std::vector<CrashNote> shown_crash_notes() {
  const std::lock_guard lock(shown().mutex);
  std::vector<CrashNote> busy;
  for (const ThreadNote* note : shown().notes)
    if (const CrashNote now = note->read(); now.plugin != nullptr) busy.push_back(now);
  return busy;
}

}  // namespace scree::core
