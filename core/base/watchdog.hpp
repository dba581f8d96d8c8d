#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace scree::core {

/// Notices a cycle that does not come to an end, as when a plug-in loops for ever. A thread of its own looks now and
/// then at a counter; the cycle itself pays two atomic instructions. It changes nothing but how a hopeless run ends.
class Watchdog {
 public:
  /// `patience`: what a cycle may take at least, s; 0 stands for a minute. A cycle may also take 100 times the usual
  /// one; the first may take ten times a minute, unless a patience was given. `bite` is called at most once, on the
  /// watchdog's thread, and must end the process; the watched thread is kept from going on meanwhile.
  Watchdog(double patience, std::function<void(const std::string& what, bool plugin)> bite);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// A part of a cycle that is watched, on one and always the same thread. Not to be nested.
  class Section {
   public:
    Section(Watchdog& dog, uint64_t cycle) : dog_(dog) { dog_.enter(cycle); }
    ~Section() { dog_.leave(); }
    Section(const Section&) = delete;
    Section& operator=(const Section&) = delete;

   private:
    Watchdog& dog_;
  };

 private:
  void enter(uint64_t cycle);
  void leave();
  void watch();
  void remember(double length);
  double limit() const;
  void end_process();

  double patience_, tick_;
  bool chosen_;
  std::function<void(const std::string&, bool)> bite_;
  uint64_t own_ = 0;               ///< what the watched thread last made of the beat
  std::atomic<uint64_t> beat_{0};  ///< odd inside a section
  std::atomic<uint64_t> cycle_{0};
  std::vector<double> lengths_;  ///< of sections lately seen, s
  std::size_t next_ = 0;
  std::mutex mutex_;
  std::condition_variable over_;
  bool quit_ = false;
  std::thread thread_;
};

}  // namespace scree::core
