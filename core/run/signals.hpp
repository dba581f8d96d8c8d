#pragma once
#include <atomic>
#include <string>

#include "core/base/error.hpp"

namespace scree::core {

/// Asked for by signals, read by the run loop between cycles. [any thread]
namespace requests {
inline std::atomic<int> stop{0};  ///< the signal that asked to stop, 0: none
inline std::atomic<int> save{0};  ///< 1 after SIGUSR1
}  // namespace requests

/// The signal that asked the run to stop, 0 if none. One relaxed load.
inline int stop_signal() { return requests::stop.load(std::memory_order_relaxed); }
/// True once per SIGUSR1.
inline bool take_save_request() {
  return requests::save.load(std::memory_order_relaxed) != 0 && requests::save.exchange(0) != 0;
}
/// The exit code of a run that a signal stopped: INT 130, TERM and HUP 143, XCPU 75 (all resumable).
Exit stop_exit(int signal);

/// INT, TERM, HUP (unless ignored, as under nohup) and XCPU: the first asks to stop, the second ends the process at
/// once. USR1 asks for a save. PIPE and XFSZ are ignored, so that the write fails instead. Call once, at start. [one
/// thread]
void install_signal_handlers();

/// SEGV, BUS, FPE, ILL and ABRT: prints what the thread was doing (core/base/crash_note.hpp) and the last good
/// checkpoint, then dies of the same signal, so that a core file and the shell see the truth. Nothing is saved: the
/// state may be broken. Call once, at start. [one thread]
void install_crash_handler();
/// Gives the calling thread a stack of its own for the crash handler, without which a stack overflow dies in silence,
/// and lets the watchdog read what it is doing.
/// install_crash_handler does it for its thread; others call it first thing (Team's on_start).
void use_crash_stack();
/// What the crash message names as the file to go on from; "" for none. Cut at 1000 bytes. [one thread]
void set_last_checkpoint(const std::string& path);
/// What was set; "" for none. [any thread]
std::string last_checkpoint();

}  // namespace scree::core
