#include <algorithm>
#include <cmath>

#include "core/base/log.hpp"
#include "core/run/explain.hpp"
#include "core/run/session.hpp"

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
      step.governed_by = engine.step.automatic() ? bound.term + " of ball " + std::to_string(bound.ball) : "the scene";
    }
    s.timestep = step;
  }
  s.quantities = values_;
  s.expectations = expectations_;
  s.error = measured_error(expectations_);
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
  if (checkpoints_.any()) message_ += "; last good checkpoint: " + checkpoints_.latest;
}

}  // namespace scree::core
