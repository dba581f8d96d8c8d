// Impacts of single balls and pairs, against closed forms of the linear spring and dashpot.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;
using std::numbers::pi;

namespace {

constexpr double radius = 0.01, density = 2500, stiffness = 1e5;
const double mass = 4.0 / 3.0 * pi * radius * radius * radius * density;
const double frequency = std::sqrt(stiffness / mass);  ///< of a ball on a wall, rad/s
constexpr int phases = 400;

/// A floor and balls on it.
std::string floor_scene(double dt, double beta, int mode, const std::string& more = "") {
  return "scree: 1\ntimestep: " + digits(dt) +
         "\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n"
         "balls:\n  drops: {generator: file, path: balls.csv, density: " +
         digits(density) + "}\ncontacts:\n  - {between: [drops, floor], model: linear, kn: " + digits(stiffness) +
         ", ks: 0, dp_nratio: " + digits(beta) + ", dp_mode: " + std::to_string(mode) +
         "}\n  - {between: [drops, drops], model: none}\n" + more;
}

/// Speeds after the impact at 1 m/s of balls that enter the contact at evenly spread phases of a step of `f` times the
/// undamped limit 2/w.
std::vector<double> restitutions(double beta, int mode, double f) {
  const double dt = 2 * f / frequency;
  std::string balls = "x,y,z,radius,vx,vy,vz\n";
  for (int k = 0; k < phases; ++k)
    balls += digits(0.05 * k) + ",0," + digits(radius + dt * (2 + (k + 0.5) / phases)) + ",0.01,0,0,-1\n";
  SceneRun run(floor_scene(dt, beta, mode), balls);
  const double longest = beta < 1 ? pi / (frequency * std::sqrt(1 - beta * beta)) : pi / frequency;
  run.step(static_cast<uint64_t>(1.2 * longest / dt) + 10);
  REQUIRE(run.value("walls.floor.force.z") == 0);
  const double* vz = run.engine().balls[Column::vz];
  return {vz, vz + phases};
}

/// Dashpot that may pull: half a period of the damped oscillator.
double full(double beta) { return std::exp(-pi * beta / std::sqrt(1 - beta * beta)); }

/// Dashpot that never pulls: the contact ends when the force falls to zero (Schwager & Pöschel 2007).
double no_tension(double beta) {
  if (beta == 1) return std::exp(-2.0);
  if (beta > 1) {
    const double s = std::sqrt(beta * beta - 1);
    return std::exp(-beta / s * std::log((beta + s) / (beta - s)));
  }
  const double s = std::sqrt(1 - beta * beta);
  return std::exp(-beta / s * (pi - std::atan2(2 * beta * s, 1 - 2 * beta * beta)));
}

}  // namespace

TEST_CASE("C1: an undamped impact keeps its speed as well as leapfrog can") {
  // Largest |e - 1| over all phases, from a separate leapfrog program; 5 % more for the phases that this one takes.
  constexpr double table[][2] = {{0.01, 1.4e-5}, {0.02, 2.0e-4}, {0.05, 1.2e-3}, {0.1, 4.4e-3}, {0.2, 1.3e-2},
                                 {0.3, 2.5e-2},  {0.4, 5.4e-2},  {0.6, 2.5e-1},  {0.8, 5.6e-1}};
  Measure measure("C1",
                  "e = 1: energy of a linear spring is conserved; tolerance: entry error of leapfrog at this step");
  for (const auto& [f, worst] : table) {
    double error = 0;
    for (const double e : restitutions(0, 0, f)) error = std::max(error, std::abs(e - 1));
    measure.check("worst e - 1 of 400 phases, dt = " + digits(f) + " of the limit", error, 0, 1.05 * worst);
  }
}

TEST_CASE("C2: restitution of a damped impact, over 400 entry phases and both dashpot modes") {
  Measure pulls("C2", "e = exp(-pi b/sqrt(1 - b^2)), damped oscillator over half a period");
  Measure pushes("C2", "e of a dashpot that never pulls (Schwager & Pöschel 2007, Granular Matter 9, 465)");
  constexpr double f = 0.002;
  for (const double beta : {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5})
    for (const int mode : {0, 1}) {
      if (mode == 0 && beta >= 1) continue;  // it creeps back and never parts
      const double expected = mode == 0 ? full(beta) : no_tension(beta);
      double sum = 0, worst = 0;
      for (const double e : restitutions(beta, mode, f)) {
        sum += e;
        worst = std::max(worst, std::abs(e - expected));
      }
      Measure& measure = mode == 0 ? pulls : pushes;
      const std::string name = ", dp_nratio " + digits(beta) + ", dp_mode " + std::to_string(mode);
      measure.check("mean e" + name, sum / phases, expected, 4e-4);
      measure.check("worst error of e" + name, worst, 0, 1e-3);
    }
}

TEST_CASE("C3: a ball dropped from half a metre bounces to e^2 of its height") {
  constexpr double height = 0.5, e = 0.8, g = 9.81;
  const double beta = -std::log(e) / std::sqrt(pi * pi + std::log(e) * std::log(e)), dt = 0.005 * 2 / frequency;
  Measure measure("C3", "v = sqrt(2 g h), h' = e^2 h (Newton's restitution), 1 % at 0.005 of the limit");
  SceneRun run(floor_scene(dt, beta, 0, "processes:\n  gravity: {process: gravity, acceleration: [0, 0, -9.81]}\n"),
               "x,y,z,radius\n0,0," + digits(radius + height) + ",0.01\n");
  run.engine().report_wanted = run.engine().sums_wanted = false;
  const auto z = [&] { return run.engine().balls[Column::z][0]; };
  const auto vz = [&] { return run.engine().balls[Column::vz][0]; };
  while (z() > radius) run.step();
  measure.check("speed at the first impact", -vz(), std::sqrt(2 * g * height), 0.01 * std::sqrt(2 * g * height));
  double expected = height;
  for (int bounce = 1; bounce <= 4; ++bounce) {
    expected *= e * e;
    while (vz() <= 0) run.step();
    while (vz() > 0) run.step();
    measure.check("height of bounce " + std::to_string(bounce), z() - radius, expected, 0.01 * expected);
    REQUIRE(run.time() < 3);
  }
}

TEST_CASE("C6: an oblique impact with friction keeps the angular momentum") {
  Measure measure(
      "C6", "force and moment act at one common point: the sum over both balls of x times m v plus I w is constant");
  SceneRun run("scree: 1\ntimestep: " + digits(0.02 / frequency) +
                   "\nballs:\n  pair: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n"
                   "  - {between: [pair, pair], model: linear, kn: 1e5, ks: 5e4, fric: 0.1, dp_nratio: 0.1, "
                   "dp_sratio: 0.1}\n",
               "x,y,z,radius,vx,vy,vz,wx,wy,wz\n"
               "0.1,0.2,-0.3,0.01,1,0.2,0.1,10,-30,20\n"
               "0.121,0.208,-0.297,0.014,-0.5,-0.3,0.2,-15,5,40\n");
  const auto momentum = [&](char axis) { return run.value(std::string("angular_momentum.") + axis); };
  const Triple first{momentum('x'), momentum('y'), momentum('z')};
  double scale = 0;
  for (const uint64_t id : {1u, 2u}) {
    const BallState ball = run.ball(id);
    scale += ball.mass * std::hypot(ball.position[0], ball.position[1], ball.position[2]) *
             std::hypot(ball.velocity[0], ball.velocity[1], ball.velocity[2]);
  }
  double most = 0, strongest = 0, sliding = 0;
  for (int cycle = 0; cycle < 2000; ++cycle) {
    run.step();
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(momentum("xyz"[c]) - first[c]));
    strongest = std::max(strongest, run.value("contacts.1.2.normal_force"));
    sliding += run.value("contacts.sliding");
  }
  REQUIRE(strongest > 10);  // they met
  REQUIRE(sliding > 10);
  REQUIRE(run.value("contacts.count") == 0);
  measure.check("largest change of the angular momentum, relative", most / scale, 0, 1e-12);
}
