#include "core/base/watchdog.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "core/base/crash_note.hpp"
#include "core/base/safe_text.hpp"
#include "core/base/threads.hpp"

namespace scree::core {

namespace {

constexpr double minute = 60;
constexpr std::size_t lengths_kept = 63;

double now() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

std::string seconds(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g s", value);
  return text;
}

}  // namespace

Watchdog::Watchdog(double patience, std::function<void(const std::string&, bool)> bite)
    : patience_(patience > 0 ? patience : minute),
      tick_(std::clamp(patience_ / 10, 0.001, 1.0)),
      chosen_(patience > 0),
      bite_(std::move(bite)) {
  const SignalsBlocked blocked;
  thread_ = std::thread([this] { watch(); });
}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  over_.notify_all();
  thread_.join();
}

void Watchdog::enter(uint64_t cycle) {
  cycle_.store(cycle, std::memory_order_relaxed);
  beat_.store(++own_);
}

// Only the watchdog changes the beat besides, and then the process is about to end.
void Watchdog::leave() {
  uint64_t inside = own_++;
  if (beat_.compare_exchange_strong(inside, own_)) return;
  for (;;) ::pause();
}

double Watchdog::limit() const {
  if (lengths_.empty()) return chosen_ ? patience_ : 10 * patience_;
  std::vector<double> sorted = lengths_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::max(patience_, 100 * *middle);
}

void Watchdog::remember(double length) {
  if (lengths_.size() < lengths_kept)
    lengths_.push_back(length);
  else
    lengths_[next_++ % lengths_kept] = length;
}

void Watchdog::watch() {
  std::unique_lock lock(mutex_);
  uint64_t seen = beat_.load();
  double waited = 0, last = now();
  while (!quit_) {
    over_.wait_for(lock, std::chrono::duration<double>(tick_));
    const double here = now();
    // A process that was stopped and goes on has not taken all that time.
    waited += std::min(here - last, 2 * tick_);
    last = here;
    const uint64_t beat = beat_.load();
    if (beat != seen) {
      if (beat / 2 != seen / 2) remember(waited / static_cast<double>(beat / 2 - seen / 2));
      seen = beat;
      waited = 0;
    } else if ((beat & 1u) == 0) {
      waited = 0;  // writing and saving take as long as the disk does
    } else if (waited > limit()) {
      // A value that the watched thread does not expect keeps it from leaving the section.
      uint64_t inside = beat;
      if (beat_.compare_exchange_strong(inside, beat + 2)) end_process();
    }
  }
}

void Watchdog::end_process() {
  std::string what = "cycle " + std::to_string(cycle_.load()) + " did not come to an end within " + seconds(limit());
  const std::vector<CrashNote> busy = shown_crash_notes();
  for (std::size_t k = 0; k < std::min<std::size_t>(busy.size(), 4); ++k) {
    SafeText text;
    text << (k == 0 ? ": stuck in " : "; and in ") << busy[k];
    what += text.view();
  }
  if (busy.empty()) what += ": stuck in the kernel";
  bite_(what, !busy.empty());
}

}  // namespace scree::core
