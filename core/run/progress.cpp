#include "core/run/progress.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/base/log.hpp"

namespace scree::core {

namespace {

constexpr double between_lines = 0.2;      // s, on a terminal
constexpr double between_looks = 0.05;     // s, what the stride of cycles aims at
constexpr double first_plain_line = 10.0;  // s, without a known end

double steady_seconds() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

std::string with_prefix(double number) {
  if (number >= 1e9) return fmt::format("{:.3g}G", number / 1e9);
  if (number >= 999.5e3) return fmt::format("{:.3g}M", number / 1e6);
  if (number >= 9999.5) return fmt::format("{:.3g}k", number / 1e3);
  return fmt::format("{:.4g}", number);
}

std::string duration_text(double seconds) {
  const double s = std::round(seconds);
  if (!(s < 8.64e6)) return "over 100 days";
  const auto whole = static_cast<uint64_t>(s);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

std::string progress_text(const ProgressState& state) {
  std::string text = fmt::format("{}  cycle {}  t {:.4g} s", state.stage, state.cycle, state.model_time);
  if (state.cycles_per_second) text += "  " + with_prefix(*state.cycles_per_second) + " cycles/s";
  if (state.ball_steps_per_second) text += "  " + with_prefix(*state.ball_steps_per_second) + " ball-steps/s";
  if (state.fraction) text += fmt::format("  {} %", static_cast<int>(*state.fraction * 100));
  if (state.seconds_left) text += "  " + duration_text(*state.seconds_left) + " left";
  return text;
}

Progress::Progress(Settings settings)
    : Progress(
          settings,
          [](const std::string& text, bool in_place) {
            if (in_place)
              log::status_line(text);
            else
              log::write(log::Level::info, text);
          },
          steady_seconds) {}

Progress::Progress(Settings settings, Show show, Clock clock)
    : settings_(settings), show_(std::move(show)), clock_(std::move(clock)) {}

Progress::~Progress() { finish(); }

void Progress::stage(const std::string& name, uint64_t cycle, double model_time, std::optional<uint64_t> cycles,
                     std::optional<double> duration) {
  if (settings_.quiet) return;
  state_ = {};
  state_.stage = name;
  start_cycle_ = rate_cycle_ = cycle;
  start_model_ = model_time;
  start_ = last_look_ = last_said_ = rate_cycle_time_ = clock_();
  next_quiet_line_ = start_ + first_plain_line;
  cycles_ = cycles;
  duration_ = duration;
  last_step_ = 0;
  stride_ = 1;
  next_look_ = cycle + 1;
}

void Progress::look(uint64_t cycle, double model_time, uint64_t balls) {
  const double now = clock_();
  const double passed = now - last_look_;
  // Doubling or halving only: one slow cycle (a save, a rebuild) must not mislead the stride.
  if (passed < between_looks / 2)
    stride_ = std::min<uint64_t>(2 * stride_, 1 << 20);
  else if (passed > between_looks * 2)
    stride_ = std::max<uint64_t>(stride_ / 2, 1);
  last_look_ = now;
  next_look_ = cycle + stride_;
  state_.cycle = cycle;
  state_.model_time = model_time;

  double fraction = -1;
  if (cycles_ && *cycles_ > 0) fraction = static_cast<double>(cycle - start_cycle_) / static_cast<double>(*cycles_);
  if (duration_ && *duration_ > 0) fraction = std::max(fraction, (model_time - start_model_) / *duration_);
  state_.fraction.reset();
  if (fraction >= 0) state_.fraction = std::min(fraction, 1.0);

  if (settings_.terminal) {
    if (now - last_said_ >= between_lines) say(now, balls);
    return;
  }
  if (state_.fraction) {
    const int step = static_cast<int>(*state_.fraction * 20 + 1e-9);
    if (step > last_step_) {
      last_step_ = step;
      say(now, balls);
    }
  } else if (now >= next_quiet_line_) {
    next_quiet_line_ = now + (now - start_);
    say(now, balls);
  }
}

void Progress::say(double now, uint64_t balls) {
  state_.cycles_per_second.reset();
  state_.ball_steps_per_second.reset();
  state_.seconds_left.reset();
  if (now > rate_cycle_time_) {
    const double rate = static_cast<double>(state_.cycle - rate_cycle_) / (now - rate_cycle_time_);
    state_.cycles_per_second = rate;
    if (balls > 0) state_.ball_steps_per_second = rate * static_cast<double>(balls);
  }
  // The rate is that of the last seconds, the time left that of the whole stage.
  if (now - rate_cycle_time_ > 5) {
    rate_cycle_time_ = now;
    rate_cycle_ = state_.cycle;
  }
  if (state_.fraction && *state_.fraction > 0)
    state_.seconds_left = (now - start_) * (1 - *state_.fraction) / *state_.fraction;
  last_said_ = now;
  line_shown_ = line_shown_ || settings_.terminal;
  show_(progress_text(state_), settings_.terminal);
}

void Progress::finish() {
  next_look_ = UINT64_MAX;
  if (line_shown_) show_("", true);
  line_shown_ = false;
}

}  // namespace scree::core
