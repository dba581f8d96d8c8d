#pragma once
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "core/base/watchdog.hpp"
#include "core/run/checkpoint_files.hpp"
#include "core/run/condition.hpp"
#include "core/run/event_log.hpp"
#include "core/run/output_folder.hpp"
#include "core/run/progress.hpp"
#include "core/run/quantities.hpp"
#include "core/run/recorder.hpp"
#include "core/run/run.hpp"
#include "core/run/simulation.hpp"

namespace scree::core {

/// One run in its folder: goes through the stages, records, saves, and says how it ended.
class Session {
 public:
  Session(std::unique_ptr<Simulation> simulation, OutputFolder folder, const RunOptions& options);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Goes on where the last checkpoint of this folder stands.
  void restore(const ArchiveReader& archive);
  /// All stages from the present position on; never throws for what a run can meet.
  RunResult run();

 private:
  enum class Ending { done, cut_short, interrupted };
  Ending stages();
  Ending act(const Stage& stage, const Action& action);
  Ending run_action(const Stage& stage, const RunAction& action);
  void begin_action(const Stage& stage, const RunAction& action);
  double idle_step(const RunAction& action) const;
  bool length_reached(const RunAction& action) const;
  bool wants_to_stop();
  /// Completes the present time with all that is due, and writes it.
  void complete(const Needs& extra);
  void read_quantities();
  /// The end of a run that was not cut short: what it is judged by.
  void finish();
  bool save_checkpoint();
  void save_named(const SaveAction& action);
  void report_overlaps();
  void report_slow_bonds();
  void write_failure(const NumericalStop& stop);
  void save_stopped(const NumericalStop& stop);
  /// A cycle does not end: says so, closes what is written, and ends the process. On the watchdog's thread.
  [[noreturn]] void end_stuck(const std::string& what, bool plugin);
  Summary summary() const;
  double seconds() const;

  std::unique_ptr<Simulation> simulation_;
  OutputFolder folder_;
  RunOptions options_;
  Quantities quantities_;
  std::vector<std::unique_ptr<Recorder>> recorders_;
  EventLog events_;
  CheckpointFiles checkpoints_;
  Progress progress_;
  std::unique_ptr<Watchdog> watchdog_;  ///< while the stages run
  Needs final_needs_;                   ///< of everything that may be read where an action ends
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point saved_ = started_;
  double loop_seconds_ = 0;
  uint64_t loop_cycles_ = 0, ball_steps_ = 0, first_cycle_ = 0;
  int signal_ = 0;
  Exit ended_ = Exit::done;
  std::string message_;
  std::vector<ExpectationResult> expectations_;
  Summary::Named values_;
  std::optional<Summary::Energy> energy_;
  uint64_t bonds_ = 0;  ///< that held when the last run action began
  bool io_failed_ = false;
  bool unseen_ = true;  ///< no cycle of this session was completed yet
};

}  // namespace scree::core
