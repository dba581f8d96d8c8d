#include "core/cycle/engine.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/crash_note.hpp"
#include "core/contact/network_bound.hpp"
#include "core/contact/possible_pairs.hpp"

namespace scree::core {

namespace {

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value + 0.0);  // no -0
  return text;
}

[[noreturn]] void refuse_without_step() {
  throw Refusal(Exit::scene, "nothing limits the step: no contact of the scene has a stiffness; give 'timestep'");
}

}  // namespace

Engine::Engine(unsigned threads, int isa, std::function<void(unsigned)> on_start)
    : team(threads, std::move(on_start)), host(balls, walls) {
  contacts.isa = isa;
  host.can_bond = [this](const std::string& name) {
    const auto& rules = contacts.book.rules;
    return std::any_of(rules.begin(), rules.end(),
                       [&](const BoundRule& rule) { return rule.name == name && rule.can_bond(); });
  };
  host.wall_stiffness = [this](std::size_t wall) { return contacts.wall_stiffness(wall, balls, walls); };
}

double Engine::local_damping() const {
  double most = 0;
  for (const Process& process : processes)
    if ((process.table->flags & SCREE_LOCAL_DAMPING) != 0 && process.table->damping != nullptr)
      most = std::max(most, process.table->damping(process.object.get()));
  return most;
}

void Engine::check_cell() const {
  for (int axis = 0; axis < 3; ++axis) {
    const double least = 2 * (2 * largest_radius_ + skin_.narrow() + contacts.book.reach());
    if (cell.periodic[axis] && cell.length(axis) < least)
      throw Refusal(Exit::scene,
                    std::string("the periodic cell is too small along ") + "xyz"[axis] + ": its edge is " +
                        number(cell.length(axis)) + " m, and " + number(least) +
                        " m (twice the largest diameter plus skin) are needed so that a pair meets through "
                        "one image only; enlarge the cell or use smaller balls");
  }
}

double Engine::room_for_skin() const {
  double room = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    if (cell.periodic[axis])
      room = std::min(room, 0.5 * cell.length(axis) - 2 * largest_radius_ - contacts.book.reach());
  return room;
}

void Engine::check_energies() const {
  for (const BoundRule& rule : contacts.book.rules)
    if (rule.model != nullptr && rule.energy_law == nullptr)
      throw Refusal(Exit::scene, "contact model '" + rule.model_name + "' of rule '" + rule.name +
                                     "' does not tell its energies, so an energy balance cannot close: leave the "
                                     "process that traces energy out, or use another model");
}

Engine::Census Engine::census() const {
  Census now{balls.size(), 0};
  for (std::size_t row = 0; row < balls.size(); ++row) now.ids += balls.id()[row];
  return now;
}

// Balls come and go by edits only, and prepare() follows each.
void Engine::check_count() const {
  const Census now = census();
  if (now == counted_) return;
  throw NumericalStop(
      "cycle " + std::to_string(clock.cycle) + ": " + std::to_string(now.balls) + " balls are there, " +
          std::to_string(counted_.balls) +
          " were placed, and their ids are not all those that were: memory was overwritten, by a plug-in "
          "most likely; check yours with scree vet",
      {});
}

void Engine::prepare() {
  crowd_.reset();
  frequency_.forget();
  counted_ = census();
  const bool spins = contacts.book.spins() || std::any_of(processes.begin(), processes.end(), [](const Process& p) {
                       return p.needs(SCREE_SPIN) || p.needs(SCREE_MOMENT);
                     });
  const std::string reason = contacts.book.spins() ? "a rule has a tangential part" : "a process asked for it";
  if (spins)
    for (Column c : {Column::wx, Column::wy, Column::wz}) balls.require(c, reason);
  for (Column c : {Column::reference_x, Column::reference_y, Column::reference_z})
    balls.require(c, "skin of the lists");
  for (BoundRule& rule : contacts.book.rules) rule.refresh(contacts.isa);
  balls.trim();
  balls.update_inverse_mass();
  adders_ = row_order(processes, true);
  scalers_ = row_order(processes, false);
  ledger.on = std::any_of(processes.begin(), processes.end(),
                          [](const Process& process) { return (process.table->flags & SCREE_TRACES_ENERGY) != 0; });
  if (ledger.on) check_energies();
  double sum = 0;
  least_radius_ = largest_radius_ = 0;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    const double radius = balls[Column::radius][row];
    least_radius_ = row == 0 ? radius : std::min(least_radius_, radius);
    largest_radius_ = std::max(largest_radius_, radius);
    sum += radius;
  }
  if (!contacts.built()) {
    const double mean = balls.size() > 0 ? sum / static_cast<double>(balls.size()) : 0;
    skin_.begin(wanted_skin, {mean, least_radius_, room_for_skin()});
    check_cell();
  }
  possible_ = possible_pairs(contacts.book, balls, walls, local_damping());
  host.fill_views();
  if (contacts.built()) choose_step();
}

void Engine::choose_step() {
  if (step.automatic() || clock.dt == 0) {
    step.take(estimate(), clock.cycle);
    const StepBound& bound = step.bound();
    if (!step.automatic() && !unsafe && bound.step > 0 && *step.fixed > bound.step)
      throw Refusal(Exit::scene, (step_place.empty() ? "" : step_place + ": error: ") + "the step of " +
                                     number(*step.fixed) + " s is above the stable limit of " + number(bound.step) +
                                     " s (" + bound.text() + "): lower 'timestep' to at most " +
                                     number(step.allowed()) +
                                     " s, leave it out for the automatic step, or say 'unsafe: true'");
    // A bond that is yet to be made may bring the stiffness; what is still without one then cannot advance.
    const auto& rules = contacts.book.rules;
    const bool may_bond =
        std::any_of(rules.begin(), rules.end(), [](const BoundRule& rule) { return rule.can_bond(); });
    if (step.step() == 0 && balls.size() > 0 && !may_bond) refuse_without_step();
  }
  if (balls.size() > 0 || !step.automatic()) return clock.change_step(step.step());
  follow_idle_step();
}

void Engine::follow_idle_step() {
  if (balls.size() == 0 && step.automatic() && idle_step > 0) clock.change_step(idle_step);
}

void Engine::forces() {
  if (forces_current()) return;
  evaluate_forces();
  // A bond begins without force, at the positions of now; what it adds to the laws is evaluated over no time.
  bool bonds = false;
  for (const BondRequest& request : host.take_bonds()) {
    BondOrder order{0, request.gap, request.again, {}};
    for (std::size_t k = 0; k < contacts.book.rules.size(); ++k)
      if (contacts.book.rules[k].name == request.rule) order.rule = static_cast<uint16_t>(k);
    bond(order, false);
    bonds = true;
  }
  if (bonds) evaluate_forces();
  if (!ledger.on) return;
  if (!ledger.begun()) ledger.begin(stored_energy());
  if (ledger.edited()) ledger.after_edit(stored_energy());
}

void Engine::before_edit() {
  if (ledger.on && ledger.begun() && forces_current()) ledger.before_edit(stored_energy());
}

StoredEnergy Engine::stored_energy() {
  const Observation& now = observe();
  StoredEnergy stored;
  stored.kinetic = now.kinetic;
  stored.kinetic_shadow = now.kinetic_shadow;
  stored.strain = contacts.energy().strain;
  stored.bond = contacts.energy().bond;
  stored.before = now.work_before;
  stored.wall_before = wall_work(true);
  return stored;
}

// Of the forces of now, over half of the drift that led here or of the coming one.
double Engine::wall_work(bool before) const {
  const double half = 0.5 * (before ? clock.dt_back : clock.dt);
  double work = 0;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Wall& wall = walls[k];
    const bool known = before && k < wall_motion_.size();
    for (std::size_t c = 0; c < 3; ++c)
      work -= half * (wall.force[c] * (known ? wall_motion_[k][c] : wall.velocity[c]) +
                      wall.moment[c] * (known ? wall_motion_[k][3 + c] : wall.spin[c]));
  }
  return work;
}

void Engine::evaluate_forces() {
  detect();
  PassOptions options;
  options.dt = clock.dt_law;
  options.overlap_limit = overlap_limit;
  if (crowd_use_.rests != 0) options.depth = crowd_use_.depth;
  options.sums = sums_wanted;
  options.cycle = clock.cycle;
  options.report = report_wanted;
  options.energy = ledger.on;
  const Excess excess = contacts.evaluate(balls, walls, cell, options, team);
  contact_updates_ += contacts.listed();
  for (const WallList& list : contacts.wall_lists()) contact_updates_ += list.slots.size();
  forces_current_ = true;
  if (ledger.on) ledger.add_contacts(contacts.energy());
  for (const Break& one : contacts.take_breaks()) broken.push_back({clock.cycle, clock.time(), one});
  if (excess.found) stop_excess(excess);
  watch_depth();
}

void Engine::stop_excess(const Excess& excess) const {
  const std::string pair = excess.id2 != 0
                               ? "balls " + std::to_string(excess.id1) + " and " + std::to_string(excess.id2)
                               : "ball " + std::to_string(excess.id1) + " and wall '" + excess.wall + "'";
  const std::string when = "cycle " + std::to_string(clock.cycle) + ": ",
                    rule = "under rule '" + excess.rule + "' (contact model '" + excess.plugin + "')",
                    steps = "; the step is " + number(clock.dt) + " s, the stable limit " + number(step.bound().step) +
                            " s: ";
  const std::vector<uint64_t> balls_to_see =
      excess.id2 != 0 ? std::vector<uint64_t>{excess.id1, excess.id2} : std::vector<uint64_t>{excess.id1};
  if (excess.useless != nullptr) {
    const auto& v = excess.value;
    const bool finite = std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    const std::string unit = std::string(excess.useless) == "force" ? " N" : " N m";
    throw NumericalStop(when + "the " + excess.useless + " between " + pair + " " + rule +
                            (finite ? " is too large to compute with" : " is not a finite number") + ", (" +
                            number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + ")" + unit + steps +
                            "check the properties of this rule and look at the balls in failure.csv; if both are "
                            "sound, report it to the plug-in's author",
                        balls_to_see);
  }
  throw NumericalStop(when + pair + " overlap by " + number(excess.overlap) + " m, " +
                          number(excess.overlap / excess.radius) + " of the smaller radius (limit " +
                          number(overlap_limit) + "), " + rule + steps +
                          "use stiffer contacts, slower motion or a smaller 'timestep', or raise 'overlap_limit'",
                      balls_to_see, NumericalStop::State::whole);
}

MotionInput Engine::motion_input() {
  return {&balls,      &contacts.slices(), &adders_,      &scalers_, contacts.isa,
          clock.cycle, clock.time(),       clock.dt_back, clock.dt,  sum_words(adders_) + sum_words(scalers_),
          ledger.on};
}

void Engine::stop_not_finite() {
  std::size_t worst = balls.size();
  for (std::size_t row = 0; row < balls.size() && worst == balls.size(); ++row) {
    double sum = 0;
    for (Column c :
         {Column::x, Column::y, Column::z, Column::vx, Column::vy, Column::vz, Column::wx, Column::wy, Column::wz})
      if (balls.has(c)) sum += balls[c][row];
    if (!std::isfinite(sum)) worst = row;
  }
  const uint64_t id = worst < balls.size() ? balls.id()[worst] : 0;
  // What laws give has been checked contact by contact.
  std::string who = "an applied force, too large a force for the mass";
  for (const auto* order : {&adders_, &scalers_})
    for (const Process* process : *order) who += ", process '" + process->name + "'";
  throw NumericalStop(
      "cycle " + std::to_string(clock.cycle) + ": the force, position or velocity of ball " + std::to_string(id) +
          " is not a finite number; it came from " + who + "; the step is " + number(clock.dt) +
          " s, the stable limit " + number(step.bound().step) +
          " s: look at this ball in failure.csv, check the properties of its contacts, or lower 'timestep'",
      {id});
}

void Engine::check_speed(double fastest) {
  if (!(fastest * clock.dt > 0.5 * least_radius_)) return;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    const double x = balls[Column::vx][row], y = balls[Column::vy][row], z = balls[Column::vz][row];
    const double speed = std::sqrt(x * x + y * y + z * z);
    if (speed * clock.dt <= 0.5 * balls[Column::radius][row]) continue;
    const uint64_t id = balls.id()[row];
    throw NumericalStop("cycle " + std::to_string(clock.cycle) + ": ball " + std::to_string(id) + " moves " +
                            number(speed * clock.dt / balls[Column::radius][row]) + " of its radius in one cycle (" +
                            number(speed) + " m/s with a step of " + number(clock.dt) +
                            " s), so it could pass through others unseen: lower 'timestep', or slow it down",
                        {id}, NumericalStop::State::whole);
  }
}

void Engine::drift_walls() {
  double most = 0;
  for (Wall& wall : walls) {
    most = std::max(most, wall.travel(clock.dt, extent_));
    wall.drift(clock.dt);
  }
  wall_travel_ += most;
  schedule_.moved(0, most);
}

void Engine::run_model_processes() {
  bool any = false;
  for (Process& process : processes) {
    if (process.table->step == nullptr) continue;
    if (process.table->every > 1 && clock.cycle % process.table->every != 0) continue;
    if (!any) host.fill_views();
    any = true;
    host.listen_to(process.name, false);
    const scree_step now{sizeof(scree_step),   0,          clock.cycle, clock.time(), clock.dt, process.sums.data(),
                         process.state.data(), host.host()};
    char why[512] = "";
    const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
    crash_note = {process.plugin.c_str(), process.name.c_str(), clock.cycle};
    const int failed = process.table->step(process.object.get(), &now, &refusal);
    crash_note = CrashNote{};
    if (failed != 0)
      throw Refusal(Exit::plugin, "process '" + process.name + "' stopped the run at cycle " +
                                      std::to_string(clock.cycle) + ": " + why);
    if (const Wall* wall = host.spoilt_wall(); wall != nullptr)
      throw NumericalStop("cycle " + std::to_string(clock.cycle) + ": process '" + process.name + "' gave wall '" +
                              wall->name +
                              "' a velocity or spin that is not a finite number: check its settings, or report it to "
                              "the author of plug-in '" +
                              process.plugin + "'",
                          {});
  }
  if (!any) return;
  host.take_views();
}

void Engine::advance() {
  forces();
  if (clock.dt == 0) refuse_without_step();
  if (frequency_.noted()) watch_frequency();
  if (clock.cycle % monitor_every == 0) watch_honesty();
  if (ledger.on && clock.dt_back > 0 && clock.dt_back != clock.dt) {
    const Observation& now = observe();
    ledger.step_changed(now.kinetic_shadow - now.kinetic_shadow_back);
  }
  const MotionInput input = motion_input();
  Slices& slices = contacts.slices();
  const std::size_t words = input.sum_words;
  motion_.resize(slices.blocks());
  block_sums_.assign(slices.blocks() * words, 0.0);
  team.each_block(slices.blocks(), [&](std::size_t block) {
    motion_[block] = move_block(input, block, block_sums_.data() + block * words);
  });
  double fastest = 0;
  bool finite = true;
  for (Process& process : processes) process.sums.assign(process.table->sums, 0.0);
  const double* sums = block_sums_.data();
  for (const MotionResult& result : motion_) {
    fastest = std::max(fastest, result.fastest);
    finite = finite && result.finite;
    for (const auto* order : {&adders_, &scalers_})
      for (const Process* process : *order)
        for (uint32_t k = 0; k < process->table->sums; ++k) const_cast<Process*>(process)->sums[k] += *sums++;
  }
  if (!finite) stop_not_finite();
  if (ledger.on) {
    RowWork work;
    for (const MotionResult& result : motion_) work += result.work;
    ledger.add_rows(work, contacts.energy().strain + contacts.energy().bond);
    ledger.add_walls(wall_work(true) + wall_work(false));
    wall_motion_.clear();
    for (const Wall& wall : walls)
      wall_motion_.push_back(
          {wall.velocity[0], wall.velocity[1], wall.velocity[2], wall.spin[0], wall.spin[1], wall.spin[2]});
  }
  if (clock.cycle % monitor_every == 0 || frequency_.streak() > 0) frequency_.note(balls, contacts.slices(), team);
  drift_walls();
  ball_travel_ += fastest * clock.dt;
  schedule_.moved(fastest * clock.dt, 0);
  clock.dt_back = clock.dt_law = clock.dt;
  ++clock.cycle;
  forces_current_ = false;
  check_speed(fastest);  // after the drift of all, so that a stop leaves one time behind
  run_model_processes();
}

uint64_t Engine::bond(const BondOrder& order, bool lasting) {
  const double least = 2 * (2 * largest_radius_ + order.gap);
  for (int axis = 0; axis < 3; ++axis)
    if (cell.periodic[axis] && cell.length(axis) < least)
      throw Refusal(Exit::scene, "a bond over a gap of " + number(order.gap) +
                                     " m could pass through two images of the "
                                     "periodic cell, whose edge along " +
                                     std::string(1, "xyz"[axis]) + " is " + number(cell.length(axis)) +
                                     " m: use a smaller gap");
  forces_outdated();
  contacts.drop_lists();
  detect();
  const uint64_t made = contacts.bond(order, balls, walls, cell, team);
  if (lasting && made > 0) schedule_.begin_anew();
  detect();
  return made;
}

void Engine::synchronize() {
  if (clock.dt_back > 0) {
    const Observation& now = observe();
    for (std::size_t c = 0; c < 3; ++c) {
      std::copy(now.velocity[c].begin(), now.velocity[c].end(),
                balls[static_cast<Column>(static_cast<std::size_t>(Column::vx) + c)]);
      if (balls.has(Column::wx))
        std::copy(now.spin[c].begin(), now.spin[c].end(),
                  balls[static_cast<Column>(static_cast<std::size_t>(Column::wx) + c)]);
    }
    clock.dt_back = 0;
  }
  forces_outdated();
}

void Engine::forces_outdated() {
  if (forces_current_) clock.dt_law = 0;
  forces_current_ = false;
}

Engine::Loop Engine::loop() const {
  return {ball_travel_,
          wall_travel_,
          extent_,
          skin_.state(),
          contacts.energy(),
          wall_motion_,
          static_cast<uint8_t>(forces_current()),
          rebuilds_,
          contact_updates_,
          schedule_.state(),
          crowd_use_};
}

void Engine::restore(const Loop& loop) {
  ball_travel_ = loop.ball_travel;
  wall_travel_ = loop.wall_travel;
  skin_.restore(loop.skin);
  contacts.set_energy(loop.energy);
  wall_motion_ = loop.wall_motion;
  extent_ = loop.extent;
  forces_current_ = loop.forces_current != 0;
  rebuilds_ = loop.rebuilds;
  contact_updates_ = loop.contact_updates;
  schedule_.restore(loop.schedule);
  crowd_use_ = loop.crowd;
}

}  // namespace scree::core
