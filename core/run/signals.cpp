#include "core/run/signals.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "core/base/crash_note.hpp"
#include "core/base/safe_text.hpp"

namespace scree::core {

namespace {

// Written while no crash is being handled; a double buffer so that the handler never reads a text half changed.
char checkpoint_text[2][1001];
std::atomic<int> checkpoint_slot{0};

// `timeout` and job schedulers send a signal to the process and at once again to its group: that is one request.
constexpr double one_request = 0.2;  // s
std::atomic<double> asked_at{0};

double monotonic_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void ask_to_stop(int signal) {
  int none = 0;
  if (requests::stop.compare_exchange_strong(none, signal))
    asked_at.store(monotonic_seconds());
  else if (none != signal || monotonic_seconds() - asked_at.load() > one_request)
    ::_exit(static_cast<int>(stop_exit(signal)));
}

void ask_to_save(int) { requests::save.store(1); }

void print(const SafeText& text) {
  const std::string_view all = text.view();
  for (size_t done = 0; done < all.size();) {
    const ssize_t n = ::write(STDERR_FILENO, all.data() + done, all.size() - done);
    if (n <= 0 && errno != EINTR) return;
    if (n > 0) done += static_cast<size_t>(n);
  }
}

const char* name_of(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV, a wrong address or a stack overflow";
    case SIGBUS:
      return "SIGBUS, a wrong address or a file that shrank";
    case SIGFPE:
      return "SIGFPE, an integer division by zero";
    case SIGILL:
      return "SIGILL, an instruction this CPU lacks";
    case SIGABRT:
      return "SIGABRT";
    default:
      return "a signal";
  }
}

void report_crash(int signal) {
  const CrashNote note = crash_note.read();
  SafeText text;
  text << "\nscree: crashed (" << name_of(signal) << ") in ";
  if (note.plugin != nullptr)
    text << note;
  else
    text << "the kernel: please report it with the scene";
  const char* checkpoint = checkpoint_text[checkpoint_slot.load()];
  if (*checkpoint != '\0')
    text << "; nothing was saved now, the last good checkpoint is " << checkpoint << "\n";
  else
    text << "; there is no checkpoint\n";
  print(text);
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

/// A thread's signal stack with a guard page below it; given back when the thread ends.
class CrashStack {
 public:
  CrashStack() {
    memory_ = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED) return;
    ::mprotect(memory_, guard, PROT_NONE);
    stack_t stack{};
    stack.ss_sp = static_cast<char*>(memory_) + guard;
    stack.ss_size = size - guard;
    ::sigaltstack(&stack, nullptr);
  }
  ~CrashStack() {
    if (memory_ == MAP_FAILED) return;
    stack_t stack{};
    stack.ss_flags = SS_DISABLE;
    ::sigaltstack(&stack, nullptr);
    ::munmap(memory_, size);
  }
  CrashStack(const CrashStack&) = delete;
  CrashStack& operator=(const CrashStack&) = delete;

 private:
  // AVX-512 registers alone take 2.7 kB of a signal frame; 64 KiB leaves room for whatever comes.
  static constexpr size_t guard = 4096, size = guard + 65536;
  void* memory_ = MAP_FAILED;
};

}  // namespace

Exit stop_exit(int signal) {
  if (signal == SIGINT) return Exit::interrupted;
  if (signal == SIGXCPU) return Exit::time_limit;
  return Exit::terminated;
}

void install_signal_handlers() {
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU}) handle(signal, ask_to_stop, SA_RESTART);
  struct sigaction hangup {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) handle(SIGHUP, ask_to_stop, SA_RESTART);
  handle(SIGUSR1, ask_to_save, SA_RESTART);
  handle(SIGPIPE, SIG_IGN, 0);
  handle(SIGXFSZ, SIG_IGN, 0);
}

void use_crash_stack() {
  static thread_local CrashStack stack;
  show_crash_note();
}

void install_crash_handler() {
  use_crash_stack();
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
    handle(signal, report_crash, SA_ONSTACK | SA_NODEFER | static_cast<int>(SA_RESETHAND));
}

std::string last_checkpoint() { return checkpoint_text[checkpoint_slot.load()]; }

void set_last_checkpoint(const std::string& path) {
  const int slot = 1 - checkpoint_slot.load();
  const size_t size = std::min<size_t>(path.size(), 1000);
  std::memcpy(checkpoint_text[slot], path.data(), size);
  checkpoint_text[slot][size] = '\0';
  checkpoint_slot.store(slot);
}

}  // namespace scree::core
