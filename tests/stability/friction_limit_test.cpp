// Cases 35, 36, D57, D61, D62: friction at its limit, spin without measure, weight without measure.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/run/sanity.hpp"
#include "stability/lab.hpp"
#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;
using scree::core::NumericalStop;

namespace {

constexpr double radius = 0.01, kn = 1e6, g = 9.81;
const double mass = 2500 * 4.0 / 3 * std::numbers::pi * 1e-6;

/// A ball that may not turn, on a slope, at rest in its springs; gravity is turned instead of the floor.
std::unique_ptr<SceneRun> block(double tilt, double friction) {
  const double down = mass * g * std::cos(tilt);
  auto run = std::make_unique<SceneRun>(
      "scree: 1\ntimestep: 1e-5\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nballs:\n  block: "
      "{generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: ground, between: [block, [floor, "
      "block]], "
      "model: linear, kn: 1e6, ks: 1e6, dp_sratio: 1, dp_mode: 2, fric: " +
          digits(friction) + "}\nprocesses:\n  pull: {process: gravity, acceleration: [" + digits(g * std::sin(tilt)) +
          ", 0, " + digits(-g * std::cos(tilt)) + "]}\nstages:\n  - hold: [fix: {balls: block, spin: [x, y, z]}]\n",
      "x,y,z,radius\n0,0," + digits(radius - down / kn) + ",0.01\n");
  run->simulation().edit(run->simulation().scene.stages[0].actions[0]);
  run->engine().forces();
  run->engine().sums_wanted = run->engine().report_wanted = false;
  return run;
}

/// How far it creeps in 1e5 cycles once it has come to rest, over its radius.
double creep(double tilt, double friction) {
  const auto run = block(tilt, friction);
  run->step(20000);
  const double begin = run->engine().balls[Column::x][0];
  run->step(100000);
  return (run->engine().balls[Column::x][0] - begin) / radius;
}

}  // namespace

TEST_CASE("35 36 D62 OK: a block at the friction angle stays, a hundredth of a per cent beyond it slides") {
  const double tilt = std::atan(0.5);
  const double below = creep(tilt, 0.5 * 1.0001), at = creep(tilt, 0.5 * (1 + 1e-9)), above = creep(tilt, 0.5 * 0.9999);
  CHECK(std::abs(below) < 1e-10);
  CHECK(std::abs(at) < 1e-6);
  // What friction does not hold: g (sin - mu cos), for 1.2 s less the 0.2 s of before.
  const double a = g * (std::sin(tilt) - 0.5 * 0.9999 * std::cos(tilt)), way = a / 2 * (1.2 * 1.2 - 0.2 * 0.2) / radius;
  CHECK(above == Approx(way).epsilon(0.02));
  lab::measured("35, 36, D62", "creep in 1e5 cycles: " + lab::number(below) + " R at 1.0001 of the friction needed, " +
                                   lab::number(at) + " R at it; at 0.9999 it slides " + lab::number(above) + " R (" +
                                   lab::number(way) + ")");
}

TEST_CASE("35 OK: friction of 0, 1e-6, 1 and 1e6 on a slope of 20 degrees") {
  const double tilt = 20 * std::numbers::pi / 180;
  std::string said;
  for (const double friction : {0.0, 1e-6, 1.0, 1e6}) {
    INFO("friction " << friction);
    const auto run = block(tilt, friction);
    run->step(20000);
    const double x = run->engine().balls[Column::x][0], time = run->time();
    if (friction < 0.1) {
      const double a = g * (std::sin(tilt) - friction * std::cos(tilt));
      CHECK(x == Approx(a * time * time / 2).epsilon(1e-4));
    } else {
      CHECK(x == Approx(mass * g * std::sin(tilt) / 1e6).epsilon(1e-6));
    }
    said += lab::number(friction) + ": " + lab::number(x) + " m; ";
  }
  lab::measured("35", said);
}

TEST_CASE("D61 OK: a ball whose rim runs at 1000 m/s is driven until it rolls, and never against its slip") {
  const double pull = 9810, speed = 1000, stiff = 1e9;
  SceneRun run(
      "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nballs:\n  ball: {generator: "
      "file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: ground, between: [ball, [floor, ball]], model: "
      "linear, kn: 1e9, ks: 1e9, fric: 0.5}\nprocesses:\n  pull: {process: gravity, acceleration: [0, 0, -9810]}\n  "
      "energy: {process: energy_ledger}\n",
      "x,y,z,radius,wx,wy,wz\n0,0," + digits(radius - mass * pull / stiff) + ",0.01,0," + digits(speed / radius) +
          ",0\n");
  run.engine().sums_wanted = run.engine().report_wanted = false;
  const auto& balls = run.engine().balls;
  // Slides for 2/7 w R/(mu g), to a speed of 2/7 w R; a seventh of m (w R)^2 is lost.
  const double duration = 2.0 / 7 * speed / (0.5 * pull), final = 2.0 / 7 * speed;
  double before = 0;
  bool backwards = false;
  while (run.time() < 1.1 * duration) {
    run.step(50);
    const double v = balls[Column::vx][0], slip = balls[Column::wy][0] * radius - v;
    if (run.time() < 0.99 * duration) backwards = backwards || v < before || slip < 0;
    before = v;
  }
  CHECK_FALSE(backwards);
  CHECK(balls[Column::vx][0] == Approx(final).epsilon(1e-3));
  const double slip = balls[Column::wy][0] * radius - balls[Column::vx][0];
  CHECK(std::abs(slip) < 1e-3 * speed);
  const double lost = run.value("energy.friction") / (mass * speed * speed);
  CHECK(lost == Approx(1.0 / 7).epsilon(1e-3));
  lab::measured("D61", "rolls at " + lab::number(balls[Column::vx][0]) + " m/s (2/7 w R = " + lab::number(final) +
                           "), residual slip " + lab::number(slip) + " m/s, friction took " + digits(lost) +
                           " m (w R)^2 (1/7)");
}

TEST_CASE("D57 WARN, STOP: a gravity of 1e6 m/s2 presses balls through each other, and is told before it does") {
  std::string balls = "x,y,z,radius\n";
  for (int k = 0; k < 20; ++k) balls += "0,0," + digits(0.01 + 0.02 * k) + ",0.01\n";
  SceneRun run(
      "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nballs:\n  deep: {generator: "
      "file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: all, between: [deep, [deep, floor]], model: "
      "linear, kn: 1e6, ks: 0}\nprocesses:\n  pull: {process: gravity, acceleration: [0, 0, -1e6]}\n",
      balls);
  const auto said = doubts(run.simulation());
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("overlap under own weight = 1.05 R"));
  double most = 0;
  CHECK_THROWS_AS(
      [&] {
        for (int k = 0; k < 20000; ++k) {
          run.step();
          for (std::size_t row = 0; row < 20; ++row)
            most = std::max(most, std::abs(run.engine().balls[Column::vz][row]) * run.engine().clock.dt / radius);
        }
      }(),
      NumericalStop);
  CHECK(most < 0.5);
  lab::measured("D57", "\"" + said[0].substr(0, 33) + "\", exit 5; no ball moves more than " + lab::number(most) +
                           " R in a cycle");
}
