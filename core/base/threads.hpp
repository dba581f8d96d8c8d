#pragma once
#include <signal.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace scree::core {

/// While it lives, INT, TERM, HUP, USR1 and XCPU are blocked on this thread and on those it starts: the caller starts
/// helpers so that a signal interrupts its own thread, never one of theirs.
class SignalsBlocked {
 public:
  SignalsBlocked();
  ~SignalsBlocked();
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

/// A fixed team of threads; the caller is thread 0. Between phases the others spin for a moment and then sleep, so a
/// phase costs about a microsecond while phases follow each other and nothing while none does.
/// Calls come from the thread that made the team; a call from inside a phase runs on its own thread alone.
class Team {
 public:
  using Task = void (*)(void* context, unsigned thread);

  /// `on_start(thread)` runs first on every thread but the caller's (signal stacks and the like); it must not throw.
  /// INT, TERM, HUP, USR1 and XCPU are blocked on them, so the caller's thread is the one that a signal interrupts.
  explicit Team(unsigned threads, std::function<void(unsigned thread)> on_start = {});
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  unsigned size() const { return size_; }

  /// Calls task(context, thread) once on every thread and returns when all are done. What a task throws is thrown again
  /// here, that of the lowest thread if several do.
  void run(Task task, void* context);

  /// Calls f(block) or f(block, thread) for every block in [0, count); thread t takes the contiguous range
  /// [count t / N, count (t+1) / N) in order. If blocks throw, the exception of the lowest one is thrown again: the
  /// same one for every number of threads. The other blocks of that thread are then left out.
  template <class F>
  void each_block(size_t count, F&& f) {
    if (size_ == 1 || count <= 1 || inside()) {
      for (size_t block = 0; block < count; ++block) call(f, block, 0);
      return;
    }
    struct Context {
      std::remove_reference_t<F>* f;
      size_t count, threads;
    } context{&f, count, size_};
    run(
        [](void* raw, unsigned thread) {
          const Context& c = *static_cast<Context*>(raw);
          const size_t end = c.count * (thread + 1) / c.threads;
          for (size_t block = c.count * thread / c.threads; block < end; ++block) call(*c.f, block, thread);
        },
        &context);
  }

 private:
  template <class F>
  static void call(F& f, size_t block, unsigned thread) {
    if constexpr (std::is_invocable_v<F&, size_t, unsigned>)
      f(block, thread);
    else
      f(block);
  }

  static bool inside();
  void serve(unsigned thread);
  void do_part(unsigned thread);
  void wait_while(std::atomic<uint32_t>& word, uint32_t value, std::atomic<uint32_t>& sleepers) const;
  void wake(std::atomic<uint32_t>& word, std::atomic<uint32_t>& sleepers) const;

  unsigned size_;
  double spin_seconds_;
  Task task_ = nullptr;
  void* context_ = nullptr;
  bool quit_ = false;
  // The two words that threads wait on, each on a cache line of its own.
  alignas(64) std::atomic<uint32_t> epoch_{0};
  std::atomic<uint32_t> epoch_sleepers_{0};
  alignas(64) std::atomic<uint32_t> pending_{0};
  std::atomic<uint32_t> pending_sleepers_{0};
  std::vector<std::exception_ptr> thrown_;
  std::function<void(unsigned)> on_start_;
  std::vector<std::thread> threads_;
};

/// The cores this process may use, at least 1.
unsigned usable_cores();

}  // namespace scree::core
