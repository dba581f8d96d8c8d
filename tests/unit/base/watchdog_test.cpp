#include "core/base/watchdog.hpp"

#include <time.h>
#include <unistd.h>

#include "core/base/crash_note.hpp"
#include "support/catch.hpp"
#include "support/child.hpp"

using namespace scree::core;

namespace {

void sleep_for(double seconds) {
  const timespec pause{static_cast<time_t>(seconds),
                       static_cast<long>((seconds - static_cast<double>(static_cast<time_t>(seconds))) * 1e9)};
  ::nanosleep(&pause, nullptr);
}

/// Prints what it was told and ends the child with 40 or 41.
void bite(const std::string& what, bool plugin) {
  if (::write(STDERR_FILENO, what.data(), what.size()) < 0) ::_exit(42);
  ::_exit(plugin ? 40 : 41);
}

}  // namespace

TEST_CASE("a section that does not end is told with what its threads are doing") {
  const ChildEnd stuck = in_child([] {
    show_crash_note();
    Watchdog dog(0.1, bite);
    const Watchdog::Section section(dog, 12);
    crash_note = {.plugin = "jkr", .rule = "ground", .cycle = 12, .block = 3, .id1 = 8, .wall = "floor"};
    sleep_for(30);
    return 0;
  });
  CHECK(stuck.code == 40);
  CHECK(stuck.text ==
        "cycle 12 did not come to an end within 0.1 s: stuck in plug-in 'jkr', used as 'ground', cycle 12, block 3, "
        "first contact of the batch: ball 8 and wall 'floor'");
  const ChildEnd kernel = in_child([] {
    Watchdog dog(0.1, bite);
    const Watchdog::Section section(dog, 12);
    sleep_for(30);
    return 0;
  });
  CHECK(kernel.code == 41);
  CHECK(kernel.text == "cycle 12 did not come to an end within 0.1 s: stuck in the kernel");
}

TEST_CASE("what happens between sections takes its time") {
  const ChildEnd end = in_child([] {
    Watchdog dog(0.1, bite);
    { const Watchdog::Section section(dog, 1); }
    sleep_for(0.5);
    { const Watchdog::Section section(dog, 2); }
    return 0;
  });
  CHECK(end.code == 0);
}

TEST_CASE("a section may take a hundred times the usual one") {
  const ChildEnd end = in_child([] {
    Watchdog dog(0.1, bite);
    for (uint64_t cycle = 0; cycle < 40; ++cycle) {
      const Watchdog::Section section(dog, cycle);
      sleep_for(0.02);
    }
    const Watchdog::Section section(dog, 40);
    sleep_for(0.6);
    return 0;
  });
  CHECK(end.code == 0);
}

TEST_CASE("a thread that ended shows no note") {
  CHECK(shown_crash_notes().empty());
  show_crash_note();
  crash_note = {.plugin = "jkr"};
  CHECK(shown_crash_notes().size() == 1);
  crash_note = CrashNote{};
  CHECK(shown_crash_notes().empty());
  std::thread([] {
    show_crash_note();
    crash_note = {.plugin = "hertz"};
    CHECK(shown_crash_notes().size() == 1);
  }).join();
  CHECK(shown_crash_notes().empty());
}
