#include "core/run/signals.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <time.h>

#include "core/base/crash_note.hpp"
#include "core/base/threads.hpp"
#include "support/catch.hpp"
#include "support/child.hpp"

using namespace scree::core;

namespace {

// Sanitizers and the test runner put handlers and stacks of their own in place; a child starts from the defaults.
void reset_signals() {
  for (const int s :
       {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, SIGPIPE, SIGXFSZ, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
    ::signal(s, SIG_DFL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
}

volatile int depth_seen = 0;
// Never ends, and no optimiser can turn it into a loop: each frame is used after the call.
[[gnu::noinline]] int recurse(int n) {
  volatile char frame[4096];
  frame[n % 4096] = static_cast<char>(n);
  depth_seen = n;
  const int deeper = n < 0 ? 0 : recurse(n + 1);
  return deeper + frame[n % 4096];
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the first signal asks to stop, the second ends the process") {
  struct Case {
    int signal, code;
  };
  for (const Case c : {Case{SIGINT, 130}, Case{SIGTERM, 143}, Case{SIGHUP, 143}, Case{SIGXCPU, 75}}) {
    const ChildEnd end = in_child([&] {
      reset_signals();
      install_signal_handlers();
      if (stop_signal() != 0) return 1;
      ::raise(c.signal);
      if (stop_signal() != c.signal || static_cast<int>(stop_exit(stop_signal())) != c.code) return 2;
      // At once again is the same request, as from `timeout`; a moment later it is a second one.
      ::raise(c.signal);
      const timespec moment{0, 300000000};
      ::nanosleep(&moment, nullptr);
      ::raise(c.signal);
      return 3;
    });
    CHECK(end.code == c.code);
  }
}

TEST_CASE("nohup is respected, USR1 asks for one save, PIPE is ignored") {
  const ChildEnd end = in_child([] {
    reset_signals();
    ::signal(SIGHUP, SIG_IGN);
    install_signal_handlers();
    ::raise(SIGHUP);
    if (stop_signal() != 0) return 1;
    if (take_save_request()) return 2;
    ::raise(SIGUSR1);
    ::raise(SIGUSR1);
    if (!take_save_request() || take_save_request()) return 3;
    ::raise(SIGPIPE);
    ::raise(SIGXFSZ);
    return stop_signal() == 0 ? 0 : 4;
  });
  CHECK(end.code == 0);
}

TEST_CASE("a crash names plug-in, place and checkpoint and dies of its signal") {
  for (const int signal : {SIGSEGV, SIGFPE, SIGBUS, SIGILL, SIGABRT}) {
    const ChildEnd end = in_child([&] {
      reset_signals();
      install_crash_handler();
      set_last_checkpoint("first.scree");
      set_last_checkpoint("job.out/checkpoint/latest.scree");
      crash_note = {.plugin = "jkr", .rule = "grains", .cycle = 12345, .block = 7, .id1 = 18, .id2 = 402};
      ::raise(signal);
      return 0;
    });
    CHECK(end.signal == signal);
    CHECK(holds(end.text,
                "in plug-in 'jkr', used as 'grains', cycle 12345, block 7, first contact of the batch: balls 18 "
                "and 402; nothing was saved now, the last good checkpoint is "
                "job.out/checkpoint/latest.scree\n"));
  }
  const ChildEnd kernel = in_child([] {
    reset_signals();
    install_crash_handler();
    ::abort();
    return 0;
  });
  CHECK(kernel.signal == SIGABRT);
  CHECK(holds(kernel.text,
              "scree: crashed (SIGABRT) in the kernel: please report it with the scene; there is no checkpoint"));
}

#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
TEST_CASE("a stack overflow is reported from any thread") {
  const ChildEnd main_thread = in_child([] {
    reset_signals();
    install_crash_handler();
    crash_note = {.plugin = "deep"};
    return recurse(0);
  });
  CHECK(main_thread.signal == SIGSEGV);
  CHECK(holds(main_thread.text, "in plug-in 'deep'"));
  const ChildEnd other = in_child([] {
    reset_signals();
    install_crash_handler();
    Team team(2, [](unsigned) { use_crash_stack(); });
    team.each_block(2, [](size_t block) {
      if (block == 1) {
        crash_note = {.plugin = "deep"};
        recurse(0);
      }
    });
    return 0;
  });
  CHECK(other.signal == SIGSEGV);
  CHECK(holds(other.text, "in plug-in 'deep'"));
}
#endif
