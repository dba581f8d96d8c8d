#pragma once
#include "core/base/log.hpp"
#include "core/vet/allocation_watch.hpp"
#include "core/vet/loaded_object.hpp"
#include "core/vet/outcome.hpp"
#include "core/vet/process_state.hpp"

namespace scree::core::vet {

/// Three checks of a function that runs on any thread. `each(run)` prepares calls and hands each to `run(call, text)`:
/// `call()` is watched and nothing else, `text()` says what was called.
template <class Each>
Outcome nothing_allocated(const void* code, Each each) {
  AllocationWatch watch(code);
  Worst worst;
  each([&](auto& call, const auto& text) {
    const std::size_t calls = watch.during(call);
    worst.see(static_cast<double>(calls),
              [&] { return fmt::format("{} calls of malloc, free and the like; {}", calls, text()); });
  });
  return worst.judged(0, "it runs millions of times a second on every thread: no vector, string or new in it");
}

template <class Each>
Outcome nothing_kept(const void* code, Each each) {
  const MemoryPicture before(object_of(code));
  Worst worst;
  each([&](auto& call, const auto& text) {
    call();
    const std::size_t changed = before.changed();
    worst.see(static_cast<double>(changed),
              [&] { return fmt::format("{} bytes of the library's variables have changed; {}", changed, text()); });
  });
  return worst.judged(0, "keep nothing in static or global variables: threads would race for them");
}

template <class Each>
Outcome mode_kept(Each each) {
  const ProcessState before;
  const unsigned mode = float_mode();
  Worst worst;
  each([&](auto& call, const auto& text) {
    call();
    const unsigned now = float_mode();
    worst.see(now == mode ? 0 : 1, [&] {
      return fmt::format("floating-point control {:#x} before the call, {:#x} after it; {}", mode, now, text());
    });
  });
  const std::string trace = before.difference(ProcessState());
  if (worst.figure() == 0 && !trace.empty()) return failed("running it changed " + trace, "it only computes");
  return worst.judged(0, "leave rounding, denormals and exceptions as they are: they belong to the whole program");
}

}  // namespace scree::core::vet
