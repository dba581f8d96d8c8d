#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace scree::core {

/// What a progress line says; absent means not known.
struct ProgressState {
  std::string stage;
  uint64_t cycle = 0;
  double model_time = 0;  ///< s
  std::optional<double> cycles_per_second;
  std::optional<double> ball_steps_per_second;
  std::optional<double> fraction;      ///< of the stage, 0..1
  std::optional<double> seconds_left;  ///< of the stage
};

/// "settle  cycle 12000  t 0.0125 s  3410 cycles/s  9.2M ball-steps/s  41 %  1:05 left". [any thread]
std::string progress_text(const ProgressState& state);

/// Tells how a run goes on: a line on a terminal that is rewritten at most five times a second, otherwise one plain
/// line per 5 % of a stage or, without a known end, after 10, 20, 40 ... seconds. Looks at the clock only every so many
/// cycles, and nothing of the run depends on it. [one thread]
class Progress {
 public:
  struct Settings {
    bool quiet = false;
    bool terminal = false;  ///< log::on_terminal(), and no --no-color or NO_COLOR
  };
  /// Where the text goes: `in_place` lines replace each other and "" takes the last one away.
  using Show = std::function<void(const std::string& text, bool in_place)>;
  using Clock = std::function<double()>;  ///< s, monotonic

  /// The program's own: log::status_line and log::info, steady clock.
  explicit Progress(Settings settings);
  Progress(Settings settings, Show show, Clock clock);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins a stage at this cycle and model time; its length in cycles and in model time, where known.
  void stage(const std::string& name, uint64_t cycle, double model_time, std::optional<uint64_t> cycles,
             std::optional<double> duration);
  /// After every cycle.
  void tick(uint64_t cycle, double model_time, uint64_t balls) {
    if (cycle >= next_look_) look(cycle, model_time, balls);
  }
  /// Takes the line away; after it tick does nothing until the next stage.
  void finish();

 private:
  void look(uint64_t cycle, double model_time, uint64_t balls);
  void say(double now, uint64_t balls);

  Settings settings_;
  Show show_;
  Clock clock_;
  ProgressState state_;
  uint64_t next_look_ = UINT64_MAX, start_cycle_ = 0, stride_ = 1;
  double start_model_ = 0, start_ = 0, last_look_ = 0, last_said_ = 0, next_quiet_line_ = 0;
  double rate_cycle_time_ = 0;
  uint64_t rate_cycle_ = 0;
  int last_step_ = 0;  // of 5 %
  bool line_shown_ = false;
  std::optional<uint64_t> cycles_;
  std::optional<double> duration_;
};

}  // namespace scree::core
