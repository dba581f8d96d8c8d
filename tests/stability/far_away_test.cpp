// Cases 26, 27, D13, D23 to D27: far from the origin, very small and very large, and what doubles can still hold there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/philox.hpp"
#include "core/run/sanity.hpp"
#include "stability/lab.hpp"
#include "support/measure.hpp"
#include "support/program.hpp"
#include "support/sanitizer.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;

namespace {

const double mass = 2500 * 4.0 / 3 * std::numbers::pi * 1e-9;  // of 1 mm

/// Two balls of 1 mm that close at 0.1 m/s, at a distance `at` from the origin.
std::string meeting(double at) {
  return "x,y,z,radius,vx,vy,vz\n" + digits(at) + ",0,0,1e-3,0.1,0,0\n" + digits(at + 2.001e-3) + ",0,0,1e-3,0,0,0\n";
}

std::string pair_scene(const std::string& head = "") {
  return "scree: 1\n" + head +
         "balls:\n  pair: {generator: file, path: balls.csv, density: 2500}\n"
         "contacts:\n  - {name: touch, between: [pair, pair], model: linear, kn: 1e5, ks: 0}\n";
}

/// 0.02 of the limit of the pair, in which it moves 2.9e-8 m a cycle.
const std::string step = "timestep: " + digits(0.02 * 2 * std::sqrt(mass / 2 / 1e5)) + "\n";

double restitution(double at) {
  SceneRun run(pair_scene(step + "unsafe: true\n"), meeting(at));
  run.step(300);
  const double* v = run.engine().balls[Column::vx];
  return (v[1] - v[0]) / 0.1;
}

bool free_flight(uint64_t cycles, double& error) {
  SceneRun run(pair_scene("timestep: 1e-6\n"), "x,y,z,radius,vx,vy,vz\n0,0,0,0.01," + digits(1.0 / 3) + ",0,0\n");
  run.engine().sums_wanted = run.engine().report_wanted = false;
  run.step(cycles);
  const double n = static_cast<double>(cycles);
  error = std::abs(run.engine().balls[Column::x][0] / (n * 1e-6 / 3) - 1);
  CHECK(run.time() == Approx(n * 1e-6).epsilon(4e-16));
  return run.engine().balls[Column::vx][0] == 1.0 / 3;
}

/// 27 balls in a block, each overlapping its neighbours by a fiftieth of a radius, with speeds of their own: lengths in
/// units of `unit`, moved by `shift` units, and by `drift` units per second; `pace` times half a unit per second is how
/// fast the balls go among themselves along each axis. The density stays, so stiffness goes with the cube of the unit
/// and times stay the same.
struct Block {
  double unit = 1, shift = 0, drift = 0, pace = 1;

  std::string balls() const {
    const scree::core::Random random(26, "block");
    std::string text = "x,y,z,radius,vx,vy,vz\n";
    for (uint64_t k = 0; k < 27; ++k) {
      const uint64_t at[3] = {k % 3, k / 3 % 3, k / 9};
      for (const uint64_t c : at) text += digits(unit * (1.98 * static_cast<double>(c) + shift)) + ",";
      text += digits(unit);
      for (uint64_t c = 0; c < 3; ++c)
        text += "," + digits(unit * (pace * (random.uniform(k, c) - 0.5) + (c == 0 ? drift : 0)));
      text += "\n";
    }
    return text;
  }
  std::string scene() const {
    const double k = 1e6 * unit * unit * unit;
    return "scree: 1\ntimestep: 1e-3\nballs:\n  block: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n"
           "  - {name: all, between: [block, block], model: linear, kn: " +
           digits(k) + ", ks: " + digits(k / 2) + ", fric: 0.3, dp_nratio: 0.1}\n";
  }
  /// Positions of the balls after 100 cycles in units, without shift and drift; and the forces on them, N.
  struct End {
    std::vector<double> place, force;
  };
  End end() const {
    SceneRun run(scene(), balls());
    run.step(100);
    CHECK(run.engine().contacts.active() > 20);
    End out;
    for (uint64_t id = 1; id <= 27; ++id) {
      const BallState ball = run.ball(id);
      for (std::size_t c = 0; c < 3; ++c) {
        out.place.push_back(ball.position[c] / unit - shift - (c == 0 ? drift * run.time() : 0));
        out.force.push_back(ball.force[c]);
      }
    }
    return out;
  }
  std::vector<double> after() const { return end().place; }
};

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

uint64_t resident() {
  uint64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * 4096;
}

}  // namespace

TEST_CASE("D13 30 OK: a ball in free flight keeps every bit of its velocity for 1e6 cycles") {
  double error = 0;
  CHECK(free_flight(1000000, error));
  CHECK(error < 1.2e-10);
  lab::measured("D13, 30", "1e6 cycles: velocity bitwise the same, position within " + lab::number(error));
}

TEST_CASE("D13 30 OK: the same for 1e8 cycles", "[.][verify]") {
  double error = 0;
  CHECK(free_flight(100000000, error));
  CHECK(error < 1.2e-8);
  lab::measured("D13, 30 verify", "1e8 cycles: velocity bitwise the same, position within " + lab::number(error));
}

TEST_CASE("D23 D24 OK, WARN: a collision 1e3 and 1e6 m from the origin") {
  const double here = restitution(0), near = restitution(1e3), far = restitution(1e6);
  CHECK(here == Approx(1).margin(2.0e-4));
  CHECK(std::abs(near - here) < 1e-6);
  CHECK(std::abs(far - here) < 2e-3);
  CHECK(std::abs(far - here) > 1e-7);  // what the warning is for
  const auto said = [](double at) {
    SceneRun run(pair_scene(step), meeting(at));
    return doubts(run.simulation());
  };
  CHECK(said(1e3).empty());
  const auto warned = said(1e6);
  REQUIRE(warned.size() == 1);
  CHECK_THAT(warned[0], Catch::Contains("lies 1e+06 m from the origin") && Catch::Contains("1.16e-10 m"));
  lab::measured("D23", "speed after over before: " + digits(here) + " at the origin, " + digits(near) + " at 1e3 m");
  lab::measured("D24", digits(far) + " at 1e6 m");
}

TEST_CASE("D25 REJECT: 1e9 m from the origin balls of 1 mm have no overlaps to speak of") {
  const TemporaryFolder folder;
  write_text(folder / "balls.csv", meeting(1e9));
  write_text(folder / "far.yaml", pair_scene(step) + "stages:\n  - go: [cycle: 10]\n");
  const ProgramEnd end = support::scree({"run", "far.yaml"}, folder.path());
  CHECK(end.code == 3);
  CHECK_THAT(end.err, Catch::Contains("1e+09 m from the origin") && Catch::Contains("unsafe: true"));
  const double wrong = std::abs(restitution(1e9) - 1);
  CHECK(wrong > 0.01);
  lab::measured("D25", "exit 3; with unsafe the speed after the collision is off by " + lab::number(wrong));
}

TEST_CASE("D26 WARN: a ball too slow for its distance does not move, and the log says so") {
  const std::string ball = "x,y,z,radius,vx,vy,vz\n1e6,0,0,1,1e-5,0,0\n";
  SceneRun run(pair_scene("timestep: 1e-6\n"), ball + "2e6,0,0,1,0,0,0\n");
  const auto said = doubts(run.simulation());
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("ball 1 does not move although a velocity is given"));
  run.step(1000);
  CHECK(run.ball(1).position[0] == 1e6);
  SceneRun fine(pair_scene("timestep: 1e-6\n"), "x,y,z,radius,vx,vy,vz\n1,0,0,1,1e-5,0,0\n");
  CHECK(doubts(fine.simulation()).empty());
  lab::measured("D26", "v dt = 1e-11 m at 1e6 m: 0 m after 1000 cycles, and a warning");
}

TEST_CASE("D27 OK: a ball that escapes costs no memory, is still counted, and no pair is lost") {
  std::string balls = "x,y,z,radius,vx,vy,vz\n5,5,5,0.01,4000,0,0\n";
  for (int k = 0; k < 1000; ++k)
    balls +=
        digits(0.02 * (k % 10)) + "," + digits(0.02 * (k / 10 % 10)) + "," + digits(0.02 * (k / 100)) + ",0.01,0,0,0\n";
  SceneRun run(pair_scene("timestep: 1e-6\n"), balls);
  run.engine().sums_wanted = run.engine().report_wanted = false;
  run.step(300);
  const uint64_t listed = run.engine().contacts.listed(), before = resident();
  run.step(3000);
  const uint64_t after = resident(), grown = after > before ? after - before : 0;
  CHECK(run.engine().balls.size() == 1001);
  CHECK(run.engine().contacts.listed() == listed);
  CHECK(run.ball(1).position[0] == Approx(5 + 3300 * 4e-3).epsilon(1e-9));
  if (!address_sanitizer) CHECK(grown < (1u << 20));  // it keeps what was freed
  lab::measured("D27", "1300 radii away after " + std::to_string(run.engine().rebuilds()) + " rebuilds: " +
                           lab::number(static_cast<double>(grown) / 1024) + " KiB more, contacts as before");
}

TEST_CASE("26 OK: radii of 1e-9 m and 1e3 m, and 1e6 radii from the origin, move as radii of 1 m do") {
  const std::vector<double> one = Block{}.after();
  const double small = difference(one, Block{1e-9}.after()), large = difference(one, Block{1e3}.after()),
               away = difference(one, Block{1, 1e6}.after());
  CHECK(small < 1e-9);
  CHECK(large < 1e-9);
  CHECK(away < 1e-6);
  lab::measured("26", "1e-9 m: " + lab::number(small) + " R, 1e3 m: " + lab::number(large) +
                          " R, 1e6 R away: " + lab::number(away) + " R after 100 cycles");
}

TEST_CASE("27 OK: the same block moving 200 and 1e4 times as fast as its balls move among themselves") {
  // Uniform between -1/2 and 1/2 along three axes: the mean square of the speed is pace^2/4. A ball may not fly half
  // its radius in a cycle, so that 1e4 times needs slower balls.
  std::string said;
  for (const auto& [pace, times] : {std::pair{1.0, 200.0}, {0.01, 1e4}}) {
    const double drift = times * 0.5 * pace;
    INFO("observer at " << drift << " R/s");
    const Block::End still = Block{1, 0, 0, pace}.end(), moved = Block{1, 0, drift, pace}.end();
    double most = 0;
    for (const double force : still.force) most = std::max(most, std::abs(force));
    const double place = difference(still.place, moved.place), force = difference(still.force, moved.force) / most;
    CHECK(place < 1e-9);
    CHECK(force < 1e-9);
    CHECK(force > 0);
    said += lab::number(times) + " times the thermal speed: forces within " + lab::number(force) +
            " of the largest, positions within " + lab::number(place) + " R; ";
  }
  lab::measured("27", said + "after 100 cycles");
}
