#include "core/run/session.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "core/base/log.hpp"
#include "core/run/expectation.hpp"
#include "core/run/sanity.hpp"
#include "core/run/signals.hpp"
#include "core/run/slow_swing.hpp"
#include "core/run/state.hpp"

namespace scree::core {

namespace {
constexpr double save_every = 600;  // s of wall time; a save never changes the trajectory

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
}  // namespace

Session::Session(std::unique_ptr<Simulation> simulation, OutputFolder folder, const RunOptions& options)
    : simulation_(std::move(simulation)),
      folder_(std::move(folder)),
      options_(options),
      quantities_(*simulation_),
      events_(folder_.files()),
      checkpoints_(folder_.path()),
      progress_({options.quiet, options.colour && log::on_terminal()}) {
  quantities_.check_scene();
  for (const Record& record : simulation_->scene.record)
    recorders_.push_back(std::make_unique<Recorder>(*simulation_, quantities_, record, folder_.files()));
  for (const auto& recorder : recorders_) {
    recorder->open();
    final_needs_ |= recorder->needs();
  }
  final_needs_ |= expectation_needs(simulation_->scene, quantities_);
  for (const Quantity& quantity : simulation_->scene.quantities) final_needs_ |= quantities_.needs(quantity.name);
  first_cycle_ = simulation_->engine.clock.cycle;
}

void Session::restore(const ArchiveReader& archive) {
  quantities_.load(archive, "quantities");
  for (const auto& recorder : recorders_) recorder->load(archive, "record/" + recorder->name());
  first_cycle_ = simulation_->engine.clock.cycle;
}

double Session::seconds() const { return since(started_); }

void Session::complete(const Needs& extra) {
  Engine& engine = simulation_->engine;
  Needs needs = extra | quantities_.following(engine.clock.cycle);
  for (const auto& recorder : recorders_)
    if (recorder->due()) needs |= recorder->needs();
  engine.sums_wanted = needs.sums;
  engine.report_wanted = needs.report;
  {
    const Watchdog::Section watched(*watchdog_, engine.clock.cycle);
    engine.forces();
    quantities_.follow();
    if (options_.at_cycle) options_.at_cycle(*simulation_);
  }
  events_.take(engine);
  for (const auto& recorder : recorders_)
    if (recorder->due()) recorder->write();
}

bool Session::length_reached(const RunAction& action) const {
  const Clock& clock = simulation_->engine.clock;
  if (action.length.cycles && clock.cycle >= simulation_->position.start_cycle + *action.length.cycles) return true;
  // The nearest whole number of cycles: a step that divides the span exactly must not fall one short by rounding.
  return action.length.time && clock.time() >= simulation_->position.start_time + *action.length.time - 0.5 * clock.dt;
}

bool Session::wants_to_stop() {
  signal_ = stop_signal();
  if (signal_ != 0) {
    ended_ = stop_exit(signal_);
    message_ = "stopped by a signal";
    return true;
  }
  if (options_.time_limit > 0 && seconds() > options_.time_limit) {
    ended_ = Exit::time_limit;
    message_ = "the time limit is reached";
    return true;
  }
  if (take_save_request()) save_checkpoint();
  return false;
}

// Without a ball only the clock and the walls move, exactly for any step: it follows from what the scene wants to see.
double Session::idle_step(const RunAction& action) const {
  double step = action.length.time ? *action.length.time / 100 : 1e-3;
  for (const Record& record : simulation_->scene.record)
    if (record.every.time) step = std::min(step, *record.every.time);
  return step;
}

void Session::begin_action(const Stage& stage, const RunAction& action) {
  Position& position = simulation_->position;
  const Clock& clock = simulation_->engine.clock;
  if (!position.inside) {
    position.inside = true;
    position.start_cycle = clock.cycle;
    position.start_time = clock.time();
    position.extreme.clear();
  }
  simulation_->engine.idle_step = idle_step(action);
  simulation_->engine.follow_idle_step();
  std::optional<double> duration;
  if (action.length.time) duration = position.start_time + *action.length.time - clock.time();
  std::optional<uint64_t> cycles;
  if (action.length.cycles) cycles = position.start_cycle + *action.length.cycles - clock.cycle;
  progress_.stage(stage.name, clock.cycle, clock.time(), cycles, duration);
}

Session::Ending Session::run_action(const Stage& stage, const RunAction& action) {
  Engine& engine = simulation_->engine;
  begin_action(stage, action);
  Condition condition(*simulation_, quantities_, action);
  const auto begun = std::chrono::steady_clock::now();
  const uint64_t first = engine.clock.cycle;
  Ending ending = Ending::done;
  uint64_t look = 0;
  bool begins = true;
  for (;;) {
    const bool over = length_reached(action), test = condition.due();
    const bool cut = options_.cycles && engine.clock.cycle >= first_cycle_ + *options_.cycles;
    const bool first_look = std::exchange(unseen_, false);
    complete(over || test || cut || first_look ? final_needs_ | condition.needs() : Needs());
    if (first_look) report_overlaps();
    if (std::exchange(begins, false)) report_slow_bonds();
    if (test && condition.met()) break;
    if (over) break;
    if (cut) {
      ending = Ending::cut_short;
      break;
    }
    // The clock and signals are looked at often enough for a person, and seldom enough to cost nothing.
    if (stop_signal() != 0 || look++ % 64 == 0) {
      if (wants_to_stop()) {
        ending = Ending::interrupted;
        break;
      }
      if (since(saved_) > save_every) save_checkpoint();
    }
    {
      const Watchdog::Section watched(*watchdog_, engine.clock.cycle);
      engine.advance();
    }
    progress_.tick(engine.clock.cycle, engine.clock.time(), engine.balls.size());
  }
  loop_seconds_ += since(begun);
  loop_cycles_ += engine.clock.cycle - first;
  ball_steps_ += (engine.clock.cycle - first) * engine.balls.size();
  progress_.finish();
  if (ending == Ending::done) simulation_->position.inside = false;
  return ending;
}

Session::Ending Session::act(const Stage& stage, const Action& action) {
  if (const auto* run = std::get_if<RunAction>(&action.what)) return run_action(stage, *run);
  if (const auto* save = std::get_if<SaveAction>(&action.what)) {
    complete(Needs());
    save_named(*save);
    return Ending::done;
  }
  simulation_->edit(action);
  quantities_.invalidate();
  return Ending::done;
}

Session::Ending Session::stages() {
  Position& position = simulation_->position;
  const auto& all = simulation_->scene.stages;
  if (position.stage == 0 && position.action == 0 && !position.inside) {
    complete(final_needs_);
    const Engine& engine = simulation_->engine;
    if (const std::string governs = engine.step.bound().text(); engine.clock.dt > 0 && !governs.empty())
      log::info("step {:.6g} s of at most {:.6g} s, governed by {}", engine.clock.dt, engine.step.bound().step,
                governs);
    const Watchdog::Section watched(*watchdog_, simulation_->engine.clock.cycle);
    for (const std::string& doubt : doubts(*simulation_)) log::warning("{}", doubt);
  }
  report_overlaps();
  for (; position.stage < all.size(); ++position.stage, position.action = 0) {
    const Stage& stage = all[position.stage];
    if (position.action == 0 && !position.inside) log::info("stage '{}'", stage.name);
    for (; position.action < stage.actions.size(); ++position.action) {
      const Ending ending = act(stage, stage.actions[position.action]);
      if (ending != Ending::done) return ending;
    }
    if (!options_.stage.empty() && stage.name == options_.stage) return Ending::cut_short;
  }
  return Ending::done;
}

void Session::report_overlaps() {
  const Engine& engine = simulation_->engine;
  const double most = engine.contacts.built() ? engine.largest_overlap() : 0;
  if (most > engine.overlap_warning)
    log::warning(
        "balls overlap by up to {:.3g} of the smaller radius at cycle {}: the contacts are too soft, or balls were "
        "placed into each other",
        most, engine.clock.cycle);
}

// Before a run that begins with more bonds than the last one.
void Session::report_slow_bonds() {
  Engine& engine = simulation_->engine;
  const uint64_t bonded = engine.contacts.bonded();
  if (bonded > bonds_) {
    const Watchdog::Section watched(*watchdog_, engine.clock.cycle);
    if (const std::string doubt = slow_bonds(engine); !doubt.empty()) log::warning("{}", doubt);
  }
  bonds_ = bonded;
}

void Session::read_quantities() {
  complete(final_needs_);
  for (const Quantity& quantity : simulation_->scene.quantities)
    values_.emplace_back(quantity.name, quantities_.value(quantity.name));
  Engine& engine = simulation_->engine;
  if (!engine.ledger.on) return;
  const StoredEnergy now = engine.stored_energy();
  energy_ = Summary::Energy{engine.ledger.residual_share(now), {}};
  for (const std::string& term : EnergyBalance::terms())
    energy_->terms.emplace_back(term, engine.ledger.value(term, now));
}

void Session::finish() {
  read_quantities();
  report_overlaps();
  expectations_ = measured_expectations(simulation_->scene, quantities_);
  for (const auto& recorder : recorders_) recorder->finish();
  if (options_.at_end) options_.at_end(*simulation_);
  for (const ExpectationResult& result : expectations_) {
    if (result.passed) continue;
    ended_ = Exit::expectation;
    message_ = "not as expected: " + result.text;
  }
}

bool Session::save_checkpoint() {
  saved_ = std::chrono::steady_clock::now();
  folder_.files().flush(true);
  if (const int code = checkpoints_.prepare(); code != 0) {
    log::warning("cannot make {}: {}; the run goes on without a checkpoint", checkpoints_.folder, errno_text(code));
    io_failed_ = true;
    return false;
  }
  ArchiveWriter archive(checkpoints_.latest);
  save_state(*simulation_, archive);
  quantities_.save(archive, "quantities");
  for (const auto& recorder : recorders_) recorder->save(archive, "record/" + recorder->name());
  std::vector<std::string> names;
  std::vector<uint64_t> sizes;
  std::vector<uint8_t> replaced;
  for (const FileRecord& file : folder_.files().table()) {
    names.push_back(file.name);
    sizes.push_back(file.size);
    replaced.push_back(file.replaced);
  }
  archive.put_texts("files/names", names);
  archive.put("files/sizes", sizes);
  archive.put("files/replaced", replaced);
  if (!archive.commit(checkpoints_.previous)) {
    log::warning("{}; the checkpoint before it stays, and the run goes on", archive.error());
    io_failed_ = true;
    return false;
  }
  set_last_checkpoint(checkpoints_.latest);
  log::info("saved {} at cycle {}", checkpoints_.latest, simulation_->engine.clock.cycle);
  return true;
}

void Session::save_named(const SaveAction& action) {
  const std::string path = folder_.file(action.name.text + ".scree");
  ArchiveWriter archive(path);
  save_state(*simulation_, archive);
  if (archive.commit()) {
    log::info("saved {}", path);
    return;
  }
  log::warning("{}", archive.error());
  io_failed_ = true;
}

void Session::end_stuck(const std::string& what, bool plugin) {
  const std::string checkpoint = last_checkpoint();
  log::error("{}; nothing was saved now, {}: {}; a longer wait is asked for with --patience", what,
             checkpoint.empty() ? "there is no checkpoint" : "the last good checkpoint is " + checkpoint,
             plugin ? "report it to the plug-in's author" : "please report it with the scene");
  folder_.files().flush();
  log::close_file();
  ::_exit(static_cast<int>(plugin ? Exit::plugin : Exit::internal));
}

RunResult Session::run() {
  watchdog_ = std::make_unique<Watchdog>(options_.patience,
                                         [this](const std::string& what, bool plugin) { end_stuck(what, plugin); });
  try {
    const Ending ending = stages();
    if (ending == Ending::done) {
      finish();
    } else {
      if (ending == Ending::cut_short) read_quantities();
      for (const auto& recorder : recorders_) recorder->close();
      const std::string how = "go on with: scree resume " + folder_.path();
      if (save_checkpoint() && ending == Ending::interrupted) message_ += "; " + how;
      if (ending == Ending::cut_short) log::info("cut short as asked; {}", how);
    }
  } catch (const NumericalStop& stop) {
    ended_ = stop.code();
    message_ = stop.what();
    events_.take(simulation_->engine);
    write_failure(stop);
    save_stopped(stop);
    for (const auto& recorder : recorders_) recorder->close();
  } catch (const Refusal& refusal) {
    ended_ = refusal.code();
    message_ = refusal.what();
  } catch (const std::bad_alloc&) {
    ended_ = Exit::memory;
    message_ = "out of memory: use fewer balls, or record less";
  }
  watchdog_.reset();
  progress_.finish();
  folder_.files().flush();
  io_failed_ = io_failed_ || folder_.files().failed();
  for (const auto& recorder : recorders_) io_failed_ = io_failed_ || !recorder->error().empty();
  if (io_failed_ && (ended_ == Exit::done || ended_ == Exit::expectation)) {
    ended_ = Exit::io;
    message_ = folder_.files().failed() ? folder_.files().error() : "some output could not be written, see log.txt";
  }
  const bool resumable = ended_ == Exit::time_limit || ended_ == Exit::interrupted || ended_ == Exit::terminated;
  if (!message_.empty()) log::write(resumable ? log::Level::info : log::Level::error, message_);
  RunResult result{ended_, summary(), folder_.path(), loop_seconds_};
  if (const int code = write_summary(folder_.file("summary.json"), result.summary); code != 0) {
    log::error("cannot write {}: {}", folder_.file("summary.json"), errno_text(code));
    result.code = result.summary.exit_code = Exit::io;
  }
  log::close_file();
  return result;
}

}  // namespace scree::core
