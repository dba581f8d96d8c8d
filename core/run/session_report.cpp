#include <algorithm>
#include <cmath>

#include "core/base/log.hpp"
#include "core/run/error_estimate.hpp"
#include "core/run/explain.hpp"
#include "core/run/session.hpp"
#include "core/run/state.hpp"

// What a session leaves behind beside its records: the summary, and the worst balls of a run that went wrong.

namespace scree::core {

namespace {

// The error a run can state by itself: how far its own expectations are from their references.
std::optional<Summary::Error> measured_error(const std::vector<ExpectationResult>& results) {
  std::optional<Summary::Error> error;
  for (const ExpectationResult& result : results) {
    if (!result.equals || !result.difference) continue;
    const double scale = *result.equals != 0 ? std::fabs(*result.equals) : 1.0;
    const double relative = std::fabs(*result.difference) / scale;
    if (error && !(relative > *error->estimate)) continue;
    error = Summary::Error{relative, *result.equals,
                           "largest difference among expectations, relative to the reference: " + result.text};
  }
  return error;
}

bool finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

// Everything that a saved state holds of the motion. Forces may be there although another ball's are not numbers.
bool all_finite(const Engine& engine) {
  const Balls& balls = engine.balls;
  for (std::size_t c = 0; c < static_cast<std::size_t>(Column::count); ++c)
    if (balls.has(static_cast<Column>(c)) && !finite(balls[static_cast<Column>(c)], balls.size())) return false;
  for (const Wall& wall : engine.walls)
    if (!finite(wall.centre.data(), 3) || !finite(wall.force.data(), 3)) return false;
  for (const TouchList& list : engine.contacts.lists())
    for (const Array<double>& word : list.state)
      if (!finite(word.data(), word.size())) return false;
  for (const WallList& list : engine.contacts.wall_lists())
    if (!finite(list.state.data(), list.state.size())) return false;
  if (!engine.forces_current()) return true;
  const std::vector<double> forces = engine.contacts.slices().save();
  return finite(forces.data(), forces.size());
}

}  // namespace

Summary Session::summary() const {
  const Engine& engine = simulation_->engine;
  const Scene& scene = simulation_->scene;
  Summary s;
  s.exit_code = ended_;
  s.message = message_;
  s.program_version = SCREE_VERSION;
  s.title = scene.title;
  s.scene = scene.file;
  s.seed = scene.seed;
  s.threads = engine.team.size();
  s.isa = isa_name(options_.isa);
  s.cycles = engine.clock.cycle;
  s.model_time = engine.clock.time();
  s.wall_time = seconds();
  if (loop_seconds_ > 0 && ball_steps_ > 0) s.ball_steps_per_second = static_cast<double>(ball_steps_) / loop_seconds_;
  s.peak_memory_bytes = peak_memory_bytes();
  s.balls = engine.balls.size();
  uint64_t contacts = engine.contacts.active();
  for (const WallList& list : engine.contacts.wall_lists()) contacts += list.slots.size();
  s.contacts = contacts;
  if (engine.clock.dt > 0) {
    Summary::Timestep step;
    step.used = engine.clock.dt;
    const StepBound& bound = engine.step.bound();
    if (bound.step > 0) {
      step.certified = bound.step;
      step.governed_by = engine.step.automatic() ? bound.text() : "the scene";
    }
    s.timestep = step;
  }
  s.energy = energy_;
  s.quantities = values_;
  s.expectations = expectations_;
  s.error = measured_error(expectations_);
  if (!s.error) s.error = error_before_any_reference(engine);
  s.state_hash = engine.state_hash();
  s.left_out = left_out(*simulation_);
  for (const Component* component : simulation_->catalogue.opened())
    s.plugins.push_back({kind_name(component->kind), component->name, component->version, component->sha256, ""});
  return s;
}

void Session::write_failure(const NumericalStop& stop) {
  const Balls& balls = simulation_->engine.balls;
  const Slices& slices = simulation_->engine.contacts.slices();
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < balls.size(); ++row) rows.push_back(row);
  const auto badness = [&](std::size_t row) {
    if (std::find(stop.balls.begin(), stop.balls.end(), balls.id()[row]) != stop.balls.end())
      return std::numeric_limits<double>::infinity();
    double speed = 0;
    for (Column c : {Column::vx, Column::vy, Column::vz}) speed += balls[c][row] * balls[c][row];
    return std::isnan(speed) ? std::numeric_limits<double>::max() : speed;
  };
  const std::size_t shown = std::min<std::size_t>(100, rows.size());
  std::partial_sort(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(shown), rows.end(),
                    [&](std::size_t a, std::size_t b) {
                      const double x = badness(a), y = badness(b);
                      return x != y ? x > y : balls.id()[a] < balls.id()[b];
                    });
  std::string text = "id,group,x,y,z,radius,vx,vy,vz,fx,fy,fz\n";
  for (std::size_t k = 0; k < shown; ++k) {
    const std::size_t row = rows[k];
    text += std::to_string(balls.id()[row]) + "," + simulation_->groups.leaves()[balls.group()[row]];
    for (Column c : {Column::x, Column::y, Column::z, Column::radius, Column::vx, Column::vy, Column::vz})
      text += fmt::format(",{}", balls[c][row]);
    for (std::size_t c = 0; c < 3; ++c) text += fmt::format(",{}", row < slices.rows() ? slices.record(row)[c] : 0.0);
    text += "\n";
  }
  if (!folder_.files().append("failure.csv", text.data(), text.size())) io_failed_ = true;
  message_ += "; see " + folder_.file("failure.csv");
}

// A state to look at and to branch from; `resume` goes on from the last good checkpoint, which is left as it is.
void Session::save_stopped(const NumericalStop& stop) {
  if (stop.state == NumericalStop::State::whole && all_finite(simulation_->engine)) {
    const std::string name = folder_.file(stopped_state), path = name + ".scree";
    ArchiveWriter archive(path);
    save_state(*simulation_, archive);
    if (archive.commit()) {
      message_ += "; the state is in " + path + " (another scene begins from it with 'start: {state: " + name + "}')";
    } else {
      log::warning("{}", archive.error());
      io_failed_ = true;
    }
  } else {
    message_ += "; the broken state is not saved";
  }
  message_ +=
      checkpoints_.any() ? "; last good checkpoint: " + checkpoints_.latest : "; no checkpoint was saved before";
}

}  // namespace scree::core
