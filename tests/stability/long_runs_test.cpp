// Cases 29, 30, 32 to 34: spin, energy and momentum over many cycles, impacts and turns.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/lab.hpp"
#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;

namespace {

const double mass = 2500 * 4.0 / 3 * std::numbers::pi * 1e-6;  // of 10 mm

/// Energy of a Hertz ball that bounces on a floor `bounces` times, over that of the start: at the tops of its flight.
struct Bounced {
  double last = 0, worst = 0;  ///< relative change
  uint64_t cycles = 0;
  double least = 0, most = 0;  ///< steps in contact, s
};

/// A ball of 10 mm that falls onto a floor.
struct Fall {
  double g, height, shear;
  /// 2/w at the deepest point of the first impact: m v^2/2 = 2/5 h d^2.5 with h = 4/3 G/(1 - nu) sqrt(R).
  double limit() const {
    const double v = std::sqrt(2 * g * height), h = 4.0 / 3 * shear / (1 - 0.25) * 0.1,
                 deepest = std::pow(1.25 * mass * v * v / h, 0.4);
    return 2 * std::sqrt(mass / (1.5 * h * std::sqrt(deepest)));
  }
  std::string scene(const std::string& timestep) const {
    return "scree: 1\n" + timestep +
           "walls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nballs:\n  ball: {generator: file, "
           "path: balls.csv, density: 2500}\ncontacts:\n  - {name: ground, between: [ball, [floor, ball]], model: "
           "hertz_mindlin, shear: " +
           digits(shear) +
           ", poiss: 0.25, fric: 0, dp_nratio: 0}\nprocesses:\n  pull: {process: gravity, "
           "acceleration: [0, 0, " +
           digits(-g) + "]}\n";
  }
  std::string ball() const { return "x,y,z,radius\n0,0," + digits(0.01 + height) + ",0.01\n"; }
};

Bounced bounce(const Fall& fall, int bounces, const std::string& timestep) {
  SceneRun run(fall.scene(timestep), fall.ball());
  run.engine().sums_wanted = run.engine().report_wanted = false;
  const auto& balls = run.engine().balls;
  Bounced out;
  double before = 0, start = 0;
  for (int done = -1; done < bounces;) {
    run.step();
    ++out.cycles;
    const double now = balls[Column::vz][0], z = balls[Column::z][0], dt = run.engine().clock.dt_back;
    if (z < 0.01) {
      out.most = std::max(out.most, dt);
      out.least = out.least == 0 ? dt : std::min(out.least, dt);
    }
    if (before > 0 && now <= 0 && z > 0.01) {
      // v(n) lies half a kick after v(n-1/2); in free flight g z(n) + v(n)^2/2 is kept exactly.
      const double v_top = now - 0.5 * fall.g * dt;
      const double energy = fall.g * (z - 0.01) + v_top * v_top / 2;
      if (done < 0) start = energy;
      out.last = energy / start - 1;
      out.worst = std::max(out.worst, std::abs(out.last));
      ++done;
    }
    before = now;
  }
  return out;
}

std::string given(double step) { return "timestep: " + digits(step) + "\n"; }

std::string text(const Bounced& b) {
  return "energy within " + lab::number(b.worst) + ", at the end " + lab::number(b.last) + ", in " +
         std::to_string(b.cycles) + " cycles";
}

/// From a tenth of its radius under 10 000 g, at a fiftieth of 2/w at the deepest point.
void bounces(int count, const std::string& name) {
  const Fall fall{98100, 0.001, 1e9};
  const Bounced fixed = bounce(fall, count, given(0.02 * fall.limit()));
  CHECK(fixed.worst < 2e-3);
  lab::measured(name, std::to_string(count) + " bounces: " + text(fixed));
}

/// From four radii under 10 g: a flight is long enough for the automatic step to rise, and each impact lowers it again.
/// How far one run strays is chance, as every impact meets another phase of the step; so several starts are compared,
/// by the root of the mean square of the largest change of energy.
void controlled(int starts, int count, const std::string& name) {
  for (const std::string head : {"", "timestep: accurate\n"}) {
    double automatic = 0, fixed = 0, least = 1, most = 0;
    for (int k = 0; k < starts; ++k) {
      const Fall fall{98.1, 0.04 * (1 + 0.01 * k), 1e8};
      const Bounced free = bounce(fall, count, head);
      automatic += free.worst * free.worst / starts;
      fixed += std::pow(bounce(fall, count, given(free.most)).worst, 2) / starts;
      least = std::min(least, free.least / fall.limit());
      most = std::max(most, free.most / fall.limit());
    }
    automatic = std::sqrt(automatic);
    fixed = std::sqrt(fixed);
    const std::string said = std::to_string(starts) + " starts, " + std::to_string(count) + " bounces at " +
                             lab::number(least) + " to " + lab::number(most) + " of the limit: energy within " +
                             lab::number(automatic) + ", fixed " + lab::number(fixed);
    INFO(said);
    CHECK(automatic < 2 * fixed);
    lab::measured(name + (head.empty() ? "" : " accurate"), said);
  }
}

/// A ball that spins at 1e6 rad/s beside two that collide with friction, under gravity and local damping.
void spin(uint64_t cycles, const std::string& name) {
  SceneRun run(
      "scree: 1\ntimestep: 1e-6\nballs:\n  all: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - "
      "{name: all, between: [all, all], model: linear, kn: 1e5, ks: 5e4, fric: 0.5}\nprocesses:\n  pull: {process: "
      "gravity, acceleration: [0, 0, -1e-3]}\n  damping: {process: local_damping, factor: 0.1}\n",
      "id,x,y,z,radius,vx,vy,vz,wx,wy,wz\n1,0,0,0,0.01,0,0,0,6e5,-8e5,1e-3\n2,1,0,0,0.01,0.1,0,0,0,0,5\n"
      "3,1.021,0.001,0,0.01,0,0,0,0,0,0\n");
  run.engine().sums_wanted = run.engine().report_wanted = false;
  run.step(cycles);
  const BallState fast = run.ball(1), met = run.ball(3);
  CHECK(fast.spin[0] == 6e5);
  CHECK(fast.spin[1] == -8e5);
  CHECK(fast.spin[2] == 1e-3);
  CHECK(fast.position[2] < 0);
  CHECK(met.spin[2] != 0);
  lab::measured(name, lab::number(static_cast<double>(cycles)) + " cycles: every bit of the spin is kept");
}

/// Five balls in a row between two walls, the first one moving: elastic, at 0.02 of the limit of a pair.
void cradle(int impacts, const std::string& name) {
  const double k = 1e6, dt = 0.02 * 2 * std::sqrt(mass / 2 / k);
  std::string balls = "x,y,z,radius,vx,vy,vz\n";
  for (int n = 0; n < 5; ++n) balls += digits(0.02 + 0.0205 * n) + ",0,0,0.01," + (n == 0 ? "1" : "0") + ",0,0\n";
  SceneRun run(
      "scree: 1\ntimestep: " + digits(dt) +
          "\nwalls:\n  low: {wall: plane, point: [0.0095, 0, 0], normal: [1, 0, 0]}\n  high: {wall: plane, point: "
          "[0.1125, 0, 0], normal: "
          "[-1, 0, 0]}\nballs:\n  row: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: "
          "all, between: [row, [row, walls]], model: linear, kn: 1e6, ks: 0}\n",
      balls);
  run.engine().sums_wanted = run.engine().report_wanted = false;
  const auto& all = run.engine().balls;
  int seen = 0;
  double worst = 0, last = 0;
  uint64_t active = 0;
  while (seen < impacts) {
    run.step();
    run.engine().forces();
    const uint64_t now = run.engine().contacts.active();
    if (now < active && now == 0) {
      double energy = 0;
      bool free = true;
      for (std::size_t row = 0; row < 5; ++row) {
        energy += all[Column::vx][row] * all[Column::vx][row];
        free = free && all[Column::x][row] > 0.0195 && all[Column::x][row] < 0.1025;
      }
      ++seen;
      active = now;
      if (!free) continue;  // a wall holds some of the energy
      last = energy - 1;
      worst = std::max(worst, std::abs(last));
    }
    active = now;
  }
  // The scatter of one impact at this step is 2e-4 of the speed; it adds up as a random walk at worst.
  CHECK(worst < 3 * 4e-4 * std::sqrt(impacts));
  lab::measured(name, std::to_string(impacts) + " impacts: energy within " + lab::number(worst) + ", at the end " +
                          lab::number(last));
}

/// Two bonded balls that turn about each other with a stretched bond, and drift.
void orbit(uint64_t cycles, const std::string& name) {
  const double speed = 1, k = 1e6, apart = 0.02 + 2 * mass * speed * speed / (k * 0.02);
  SceneRun run(
      "scree: 1\ntimestep: " + digits(0.05 * 2 * std::sqrt(mass / 2 / k)) +
          "\nballs:\n  pair: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: glue, between: "
          "[pair, pair], model: contact_bond, kn: 1e6, ks: 0, cb_tenf: .inf, cb_shearf: .inf}\nstages:\n  - glue: "
          "[bond: {rule: glue, gap: 1 mm}]\n",
      "x,y,z,radius,vx,vy,vz\n" + digits(-apart / 2) + ",0,0,0.01,0.3," + digits(-speed) + ",0\n" + digits(apart / 2) +
          ",0,0,0.01,0.3," + digits(speed) + ",0\n");
  run.simulation().edit(run.simulation().scene.stages[0].actions[0]);
  run.engine().sums_wanted = run.engine().report_wanted = false;
  const auto& balls = run.engine().balls;
  double low = 1, high = 0, momentum = 0, turn = 0, first = 0, stray = 0;
  for (uint64_t part = 0; part < 1000; ++part) {
    run.step(cycles / 1000);
    const double x = balls[Column::x][1] - balls[Column::x][0], y = balls[Column::y][1] - balls[Column::y][0],
                 vx = balls[Column::vx][1] - balls[Column::vx][0], vy = balls[Column::vy][1] - balls[Column::vy][0];
    const double length = std::hypot(x, y);
    low = std::min(low, length);
    high = std::max(high, length);
    momentum = std::max(momentum, std::abs(balls[Column::vy][0] + balls[Column::vy][1]) / 2 +
                                      std::abs((balls[Column::vx][0] + balls[Column::vx][1]) / 2 - 0.3));
    // x(n) and v(n - 1/2): their moment is kept exactly by a central force.
    turn = x * vy - y * vx;
    if (part == 0) first = turn;
    stray = std::max(stray, std::abs(turn / first - 1));
  }
  CHECK(momentum < 1e-12 * std::sqrt(static_cast<double>(cycles) / 1e5));
  // The pair drifts: the farther it has come, the coarser are its positions beside its size.
  CHECK(stray < 1e-11 * std::max(1.0, static_cast<double>(cycles) / 1e5));
  CHECK(high - low < 0.02 * low);
  lab::measured(name, lab::number(static_cast<double>(cycles)) + " cycles: momentum within " +
                          lab::number(momentum / speed) + ", moment of momentum within " + lab::number(stray) +
                          ", distance within " + lab::number((high - low) / low));
}

}  // namespace

TEST_CASE("33 OK: a Hertz ball keeps its energy over 300 bounces") { bounces(300, "33"); }
TEST_CASE("33 OK: the same over 1e4 bounces", "[.][verify]") { bounces(10000, "33 verify"); }
TEST_CASE("34 OK: under the automatic step it drifts no more than twice as far as at a fixed one") {
  controlled(12, 100, "34");
}
TEST_CASE("34 OK: the same over 2000 bounces", "[.][verify]") { controlled(12, 2000, "34 verify"); }
TEST_CASE("29 OK: a ball that spins at 1e6 rad/s keeps every bit of its spin for 1e6 cycles") { spin(1000000, "29"); }
TEST_CASE("29 OK: the same for 1e8 cycles", "[.][verify]") { spin(100000000, "29 verify"); }
TEST_CASE("32 OK: a cradle of five keeps its energy over 1000 impacts") { cradle(1000, "32"); }
TEST_CASE("32 OK: the same over 1e4 impacts", "[.][verify]") { cradle(10000, "32 verify"); }
TEST_CASE("30 OK: a bonded pair turns for 1e5 cycles without drift") { orbit(100000, "30, pair"); }
TEST_CASE("30 OK: the same for 1e7 cycles", "[.][verify]") { orbit(10000000, "30, pair verify"); }
