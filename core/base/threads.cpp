#include "core/base/threads.hpp"

#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace scree::core {

namespace {

thread_local bool inside_phase = false;

void pause_core() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

// std::atomic::wait would do, but its spinning cannot be set and its waiter count is shared by the whole process.
void futex(std::atomic<uint32_t>& word, int operation, uint32_t value) {
  static_assert(sizeof(std::atomic<uint32_t>) == sizeof(uint32_t));
  ::syscall(SYS_futex, reinterpret_cast<uint32_t*>(&word), operation | FUTEX_PRIVATE_FLAG, value, nullptr, nullptr, 0);
}

double now() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace

unsigned usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0)
    return static_cast<unsigned>(CPU_COUNT(&set));
  return std::max(1u, std::thread::hardware_concurrency());
}

SignalsBlocked::SignalsBlocked() {
  sigset_t blocked;
  sigemptyset(&blocked);
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU}) sigaddset(&blocked, s);
  pthread_sigmask(SIG_BLOCK, &blocked, &before_);
}

SignalsBlocked::~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

bool Team::inside() { return inside_phase; }

Team::Team(unsigned threads, std::function<void(unsigned)> on_start)
    : size_(threads == 0 ? 1 : threads), thrown_(size_), on_start_(std::move(on_start)) {
  // With more threads than cores a spinning thread keeps the core from the one it waits for.
  spin_seconds_ = size_ <= usable_cores() ? 50e-6 : 1e-6;
  const SignalsBlocked blocked;
  try {
    for (unsigned t = 1; t < size_; ++t) threads_.emplace_back([this, t] { serve(t); });
  } catch (...) {
    quit_ = true;
    epoch_.fetch_add(1);
    futex(epoch_, FUTEX_WAKE, INT32_MAX);
    for (auto& t : threads_) t.join();
    throw;
  }
}

Team::~Team() {
  if (threads_.empty()) return;
  quit_ = true;
  epoch_.fetch_add(1);
  wake(epoch_, epoch_sleepers_);
  for (auto& t : threads_) t.join();
}

void Team::wait_while(std::atomic<uint32_t>& word, uint32_t value, std::atomic<uint32_t>& sleepers) const {
  const double until = now() + spin_seconds_;
  do {
    for (int k = 0; k < 32; ++k) {
      if (word.load(std::memory_order_acquire) != value) return;
      pause_core();
    }
  } while (now() < until);
  // Announce, then let the kernel compare: with the waker's store-then-look (both seq_cst) no wake-up can be lost.
  sleepers.fetch_add(1);
  while (word.load() == value) futex(word, FUTEX_WAIT, value);
  sleepers.fetch_sub(1);
}

void Team::wake(std::atomic<uint32_t>& word, std::atomic<uint32_t>& sleepers) const {
  if (sleepers.load() != 0) futex(word, FUTEX_WAKE, INT32_MAX);
}

void Team::do_part(unsigned thread) {
  inside_phase = true;
  try {
    task_(context_, thread);
  } catch (...) {
    thrown_[thread] = std::current_exception();
  }
  inside_phase = false;
}

void Team::serve(unsigned thread) {
  if (on_start_) on_start_(thread);
  uint32_t seen = 0;
  for (;;) {
    wait_while(epoch_, seen, epoch_sleepers_);
    ++seen;  // a new phase opens only when all have closed the last one
    if (quit_) return;
    do_part(thread);
    // The caller waits for any change of `pending_`; only the last one out needs to wake it.
    if (pending_.fetch_sub(1) == 1) wake(pending_, pending_sleepers_);
  }
}

void Team::run(Task task, void* context) {
  if (inside_phase) {
    task(context, 0);
    return;
  }
  if (size_ == 1) {
    task(context, 0);
    return;
  }
  task_ = task;
  context_ = context;
  pending_.store(size_ - 1, std::memory_order_relaxed);
  epoch_.fetch_add(1);
  wake(epoch_, epoch_sleepers_);
  do_part(0);
  for (uint32_t left = pending_.load(std::memory_order_acquire); left != 0;
       left = pending_.load(std::memory_order_acquire))
    wait_while(pending_, left, pending_sleepers_);
  for (auto& thrown : thrown_)
    if (thrown) {
      const std::exception_ptr first = std::exchange(thrown, nullptr);
      for (auto& other : thrown_) other = nullptr;
      std::rethrow_exception(first);
    }
}

}  // namespace scree::core
