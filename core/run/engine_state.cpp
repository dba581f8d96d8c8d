#include "core/run/engine_state.hpp"

#include <algorithm>
#include <cmath>

#include "core/run/ball_state.hpp"
#include "core/run/contact_state.hpp"
#include "core/run/packing.hpp"
#include "core/run/section_check.hpp"
#include "core/run/wall_state.hpp"

namespace scree::core {

namespace {

void save_clock(const Clock& clock, ArchiveWriter& out) {
  Packer packer;
  packer.u64(clock.cycle);
  packer.u64(clock.base_cycle);
  for (double value : {clock.base_time, clock.dt, clock.dt_back, clock.dt_law}) packer.f64(value);
  out.put("clock", packer.bytes());
}

void save_step(const StepControl& step, ArchiveWriter& out) {
  const StepBound& bound = step.bound();
  Packer packer;
  packer.flag(step.fixed.has_value());
  packer.flag(step.accurate);
  for (double value : {step.fixed.value_or(0), step.saved_step(), bound.step}) packer.f64(value);
  packer.u64(step.saved_since());
  packer.u64(bound.ball);
  packer.u64(bound.other);
  packer.text(bound.wall);
  packer.text(bound.term);
  out.put("step", packer.bytes());
}

void load_step(StepControl& step, const ArchiveReader& archive) {
  Unpacker in(archive, "step");
  const bool fixed = in.flag(), accurate = in.flag();
  const double value = in.f64(), saved = in.f64();
  StepBound bound;
  bound.step = in.f64();
  const uint64_t since = in.u64();
  bound.ball = in.u64();
  bound.other = in.u64();
  bound.wall = in.text();
  bound.term = in.text();
  in.finish();
  if (!(value >= 0 && saved >= 0 && std::isfinite(value) && std::isfinite(saved))) in.refuse("the step makes no sense");
  step.fixed.reset();
  if (fixed) step.fixed = value;
  step.accurate = accurate;
  step.restore(bound, saved, since);
}

void save_loop(const Engine::Loop& loop, ArchiveWriter& out) {
  Packer packer;
  for (double value : {loop.ball_travel, loop.wall_travel, loop.extent, loop.skin.width, loop.skin.narrow,
                       loop.skin.wide, loop.skin.far})
    packer.f64(value);
  packer.u64(loop.skin.since);
  packer.flag(loop.forces_current != 0);
  packer.u64(loop.rebuilds);
  packer.u64(loop.contact_updates);
  for (double value : {loop.schedule.margin, loop.schedule.balls, loop.schedule.walls}) packer.f64(value);
  packer.u64(loop.schedule.last);
  packer.u64(loop.schedule.made);
  packer.f64(loop.crowd.depth);
  packer.u64(loop.crowd.since);
  packer.u64(loop.crowd.asked);
  packer.flag(loop.crowd.refused != 0);
  packer.flag(loop.crowd.rests != 0);
  out.put("loop", packer.bytes());
}

void save_ledger(const Engine& engine, ArchiveWriter& out) {
  const auto words = engine.ledger.save();
  const Engine::Loop loop = engine.loop();
  Packer packer;
  packer.f64s(words.data(), words.size());
  packer.f64s(&loop.energy.strain, 1);
  packer.f64s(&loop.energy.bond, 1);
  packer.u64(loop.wall_motion.size());
  for (const auto& motion : loop.wall_motion) packer.f64s(motion.data(), motion.size());
  out.put("ledger", packer.bytes());
}

void load_ledger(Engine& engine, Engine::Loop& loop, const ArchiveReader& archive) {
  Unpacker in(archive, "ledger");
  std::array<double, EnergyBalance::saved_words> words{};
  in.f64s(words.data(), words.size());
  engine.ledger.load(words);
  loop.energy.strain = in.f64();
  loop.energy.bond = in.f64();
  loop.wall_motion.resize(static_cast<std::size_t>(in.count()));
  for (auto& motion : loop.wall_motion) in.f64s(motion.data(), motion.size());
  in.finish();
}

Engine::Loop read_loop(const ArchiveReader& archive, bool built) {
  Unpacker in(archive, "loop");
  Engine::Loop loop{};
  for (double* value : {&loop.ball_travel, &loop.wall_travel, &loop.extent, &loop.skin.width, &loop.skin.narrow,
                        &loop.skin.wide, &loop.skin.far}) {
    *value = in.f64();
    if (!(*value >= 0 && std::isfinite(*value))) in.refuse("a length is not a finite number of at least 0");
  }
  loop.skin.since = in.u64();
  loop.forces_current = in.flag();
  loop.rebuilds = in.u64();
  loop.contact_updates = in.u64();
  for (double* value : {&loop.schedule.margin, &loop.schedule.balls, &loop.schedule.walls}) {
    *value = in.f64();
    if (!(*value >= 0 && std::isfinite(*value))) in.refuse("a length is not a finite number of at least 0");
  }
  loop.schedule.last = in.u64();
  loop.schedule.made = in.u64();
  loop.crowd.depth = in.f64();
  loop.crowd.since = in.u64();
  loop.crowd.asked = in.u64();
  loop.crowd.refused = in.flag();
  loop.crowd.rests = in.flag();
  if (!(loop.crowd.depth >= 0 && loop.crowd.depth < 1e6)) in.refuse("overlaps of the step's limit make no sense");
  if (loop.schedule.made > 1000) in.refuse("an estimate of the step makes no sense");
  in.finish();
  if (loop.forces_current != 0 && !built) in.refuse("forces without lists");
  return loop;
}

void save_processes(const std::vector<Process>& processes, ArchiveWriter& out) {
  Packer packer;
  packer.u64(processes.size());
  for (const Process& process : processes) {
    packer.text(process.name);
    for (const auto* words : {&process.state, &process.sums}) {
      packer.u64(words->size());
      packer.f64s(words->data(), words->size());
    }
  }
  out.put("processes", packer.bytes());
}

void save_published(const std::map<std::string, double>& published, ArchiveWriter& out) {
  Packer packer;
  packer.u64(published.size());
  for (const auto& [name, value] : published) {
    packer.text(name);
    packer.f64(value);
  }
  out.put("published", packer.bytes());
}

void load_published(std::map<std::string, double>& published, const ArchiveReader& archive) {
  Unpacker in(archive, "published");
  published.clear();
  for (uint64_t left = in.count(16); left > 0; --left) {
    const std::string name = in.text();
    published[name] = in.f64();
  }
  in.finish();
}

}  // namespace

void load_clock(Clock& clock, const ArchiveReader& archive) {
  Unpacker in(archive, "clock");
  clock.cycle = in.u64();
  clock.base_cycle = in.u64();
  for (double* value : {&clock.base_time, &clock.dt, &clock.dt_back, &clock.dt_law}) {
    *value = in.f64();
    if (!std::isfinite(*value)) in.refuse("a time is not a finite number");
  }
  in.finish();
  if (clock.base_cycle > clock.cycle || clock.dt < 0 || clock.dt_back < 0 || clock.dt_law < 0)
    in.refuse("the clock makes no sense");
}

void load_processes(std::vector<Process>& processes, const ArchiveReader& archive) {
  Unpacker in(archive, "processes");
  if (in.count() != processes.size()) in.refuse("it holds another number of processes than were set up");
  for (Process& process : processes) {
    if (in.text() != process.name) in.refuse("process '" + process.name + "' is not where it should be");
    std::vector<double> state(static_cast<std::size_t>(in.count()));
    in.f64s(state.data(), state.size());
    std::vector<double> sums(static_cast<std::size_t>(in.count()));
    in.f64s(sums.data(), sums.size());
    if (state.size() != process.table->state_words || (!sums.empty() && sums.size() != process.table->sums))
      in.refuse("the words of process '" + process.name + "' are not those of its plug-in");
    process.state = std::move(state);
    process.sums = std::move(sums);
  }
  in.finish();
}

void save_engine(const Engine& engine, ArchiveWriter& out) {
  save_balls(engine.balls, out);
  save_walls(engine.walls, out);
  save_processes(engine.processes, out);
  save_published(engine.host.published, out);
  save_contacts(engine.contacts, engine.balls.size(), out);
  save_clock(engine.clock, out);
  save_step(engine.step, out);
  save_loop(engine.loop(), out);
  if (engine.ledger.on) save_ledger(engine, out);
  if (engine.forces_current()) out.put("forces", engine.contacts.slices().save());
}

void load_engine(Engine& engine, const ArchiveReader& in, std::size_t groups) {
  load_balls(engine.balls, in, groups);
  load_walls(engine.walls, in);
  load_processes(engine.processes, in);
  engine.contacts.drop_lists();
  const double* inverse = engine.balls[Column::inverse_mass];
  const std::vector<double> saved_inverse(inverse, inverse + engine.balls.size());
  engine.prepare();
  // What prepare() makes of this moment gives way to what the run had.
  std::copy(saved_inverse.begin(), saved_inverse.end(), engine.balls[Column::inverse_mass]);
  load_contacts(engine.contacts, in, engine.balls, engine.cell, engine.walls.size(), engine.team);
  load_published(engine.host.published, in);
  load_clock(engine.clock, in);
  load_step(engine.step, in);
  Engine::Loop loop = read_loop(in, engine.contacts.built());
  if (engine.ledger.on) load_ledger(engine, loop, in);
  engine.restore(loop);
  if (loop.forces_current == 0) return;
  Slices& slices = engine.contacts.slices();
  slices.load(in.get<double>("forces", slices.rows() * slices.stride()));
}

}  // namespace scree::core
