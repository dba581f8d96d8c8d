// Viscous boundaries: one ball that is braked, and a row of balls that a pulse runs through.
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;

namespace {

/// 50 balls of R = 0.5 m, 1000 kg/m3, pressed together by 100 N so that no contact opens; k = 0.5 MN/m between them.
constexpr double mass = 523.598775598298873, stiffness = 5e5, overlap = 2e-4, length = 1 - overlap;
constexpr std::size_t count = 50;
constexpr double amplitude = 1e-3;

std::string row_of_balls() {
  std::string text = "x,y,z,radius\n";
  for (std::size_t k = 0; k < count; ++k) text += digits(static_cast<double>(k) * length) + ",0,0,0.5\n";
  return text;
}

std::string row_scene(double wave_speed, bool quiet_end) {
  const std::string own = "wave_speed: " + digits(wave_speed);
  return "scree: 1\ntimestep: 2e-3\nballs:\n  row: {generator: file, path: balls.csv, density: 1000}\ncontacts:\n"
         "  - {between: [row, row], model: linear, kn: " +
         digits(stiffness) +
         ", ks: 0}\nprocesses:\n  left: {process: quiet_boundary, box: [[-0.4, -1, -1], [0.4, 1, 1]], " + own +
         ", pulse: [" + digits(amplitude) + ", 0, 0], period: 1, start: 0.1}\n" +
         (quiet_end ? "  right: {process: quiet_boundary, box: [[48.5, -1, -1], [49.5, 1, 1]], " + own + "}\n" : "") +
         "stages:\n  - press:\n    - apply: {balls: row, force: [100, 0, 0], where: \"id == 1\"}\n"
         "    - apply: {balls: row, force: [-100, 0, 0], where: \"id == 50\"}\n";
}

/// What came of the pulse: the largest velocity in the middle and at the end, and the share of its kinetic energy that
/// is left when it should have gone.
struct Outcome {
  double middle = 0, end = 0, left = 0;
};

double kinetic(SceneRun& run) {
  double sum = 0;
  const auto& balls = run.engine().balls;
  for (std::size_t row = 0; row < balls.size(); ++row) sum += 0.5 * mass * std::pow(balls[Column::vx][row], 2);
  return sum;
}

Outcome send_pulse(double wave_speed, bool quiet_end) {
  SceneRun run(row_scene(wave_speed, quiet_end), row_of_balls());
  for (const auto& action : run.simulation().scene.stages.at(0).actions) run.simulation().edit(action);
  Outcome out;
  double inside = 0;
  // The pulse is wholly inside from 1.1 s to 1.69 s and wholly gone after 2.69 s; its echo would be there until 4.2 s.
  while (run.time() < 2.85) {
    run.step();
    out.middle = std::max(out.middle, run.time() < 1.7 ? run.ball(25).velocity[0] : 0.0);
    out.end = std::max(out.end, run.ball(50).velocity[0]);
    if (run.time() < 1.4) inside = kinetic(run);
  }
  out.left = kinetic(run) / inside;
  return out;
}

}  // namespace

TEST_CASE("a quiet boundary brakes a single ball exponentially") {
  // m dv/dt = -Z v: v = v0 exp(-Z t/m). With the velocity of half a step before, each cycle takes Z dt/m of it.
  constexpr double dt = 1e-3, speed = 20, rate = speed / 1.0;
  SceneRun run("scree: 1\ntimestep: " + digits(dt) +
                   "\nballs:\n  ball: {generator: file, path: balls.csv, density: 1000, velocity: [3, -2, 1]}\n"
                   "contacts: [{between: [ball, ball], model: none}]\nprocesses:\n  quiet: {process: quiet_boundary, "
                   "box: [[-9, -9, -9], [9, 9, 9]], wave_speed: " +
                   digits(speed) + "}\n",
               "x,y,z,radius\n0,0,0,0.5\n20,0,0,0.5\n");
  run.step();
  const auto& balls = run.engine().balls;
  const std::size_t braked = balls.id()[0] == 1 ? 0 : 1, free = 1 - braked;
  const double first = balls[Column::vx][braked], side = balls[Column::vy][braked];
  run.step(100);
  Measure measure("Q1", "m dv/dt = -Z v with Z = m C/(2 R): v = v0 exp(-C t/(2 R)) (Lysmer & Kuhlemeyer 1969)");
  measure.check("v after 100 cycles", balls[Column::vx][braked] / first, std::pow(1 - rate * dt, 100), 1e-12);
  measure.check("the same along y", balls[Column::vy][braked] / side, std::pow(1 - rate * dt, 100), 1e-12);
  measure.check("exponential", balls[Column::vx][braked] / first, std::exp(-rate * 100 * dt), rate * dt * 2);
  measure.check("a ball outside the box", balls[Column::vx][free], 3, 0);
}

TEST_CASE("a quiet boundary takes in a pulse and sends one of the amplitude that was asked for") {
  const double wave_speed = std::sqrt(stiffness / mass);  // C = d sqrt(k/m) with d = 1 m
  const Outcome quiet = send_pulse(wave_speed, true), open = send_pulse(wave_speed, false);
  Measure measure("Q2", "a boundary of impedance m C/d reflects nothing; a free end doubles the velocity");
  measure.check("velocity in the middle over that asked for", quiet.middle / amplitude, 1, 0.02);
  measure.check("energy that a quiet end leaves", quiet.left, 0, 0.01);
  measure.check("velocity at a free end over that asked for", open.end / amplitude, 2, 0.04);
  measure.check("energy that a free end leaves", open.left, 1, 0.05);
}
