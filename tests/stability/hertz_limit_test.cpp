// Cases 57, D20, D22, D39, D63: Hertz contacts whose stiffness grows a thousand times, and materials at their limits.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "laws/hertz_contact.hpp"
#include "stability/lab.hpp"
#include "support/measure.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;

namespace {

constexpr double shear = 30e9, nu = 0.25, radius = 0.01;
const double mass = 2500 * 4.0 / 3 * std::numbers::pi * 1e-6;

/// Force over d^1.5 of a ball on a plane of the same material: 4/3 G/(1 - nu) sqrt(R).
const double h = 4.0 / 3 * shear / (1 - nu) * std::sqrt(radius);

/// A ball between two plates that close until each overlaps it by `depth`.
std::string squeezed(double start, double speed) {
  const std::string v = digits(speed);
  return "scree: 1\nwalls:\n  low: {wall: plane, point: [0, 0, " + digits(-radius + start) +
         "], normal: [0, 0, 1], velocity: [0, 0, " + v + "]}\n  high: {wall: plane, point: [0, 0, " +
         digits(radius - start) + "], normal: [0, 0, -1], velocity: [0, 0, -" + v +
         "]}\nballs:\n  ball: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: all, between: "
         "[ball, "
         "[ball, walls]], model: hertz_mindlin, shear: 30e9, poiss: 0.25, fric: 0, dp_nratio: 0}\n";
}

std::string refusal(const std::string& values) {
  const TemporaryFolder folder;
  write_text(folder / "balls.csv", "x,y,z,radius\n0,0,0,0.01\n0.0199,0,0,0.01\n");
  write_text(folder / "hertz.yaml",
             "scree: 1\nballs:\n  pair: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: all, "
             "between: "
             "[pair, pair], model: hertz_mindlin, fric: 0, dp_nratio: 0, " +
                 values + "}\nstages:\n  - go: [cycle: 100]\n");
  const ProgramEnd end = support::scree({"run", "hertz.yaml"}, folder.path());
  CHECK((end.code == 0 || end.code == 3));
  if (end.code == 3) CHECK_THAT(end.err, Catch::Contains("hertz.yaml:5:"));
  return end.code == 0 ? "" : end.err;
}

}  // namespace

TEST_CASE("57 D20 OK: the step follows a contact that stiffens a thousand times, as pressure^(-1/6)") {
  const double start = 1e-9, end = 1e-3;
  std::string said;
  for (const double speed : {0.01, 10.0}) {
    INFO("plates at " << speed << " m/s");
    SceneRun run(squeezed(start, speed), "x,y,z,radius\n0,0,0,0.01\n");
    double depth = start, first = run.engine().clock.dt, worst = 0, low = 1e9, high = 0;
    uint64_t cycles = 0;
    while (depth < end) {
      run.step();
      ++cycles;
      run.engine().forces();
      depth = start + speed * run.time();
      // Two springs of 1.5 h sqrt(d) each side of the mass; the ball itself stays where it is.
      const double tangent = 1.5 * h * std::sqrt(depth), critical = 2 * std::sqrt(mass / (2 * tangent));
      worst = std::max(worst, run.engine().clock.dt / critical);
      if (depth > 2e-5 && speed < 1) {
        // With F = h d^1.5 the critical step goes with F^(-1/6).
        const double force = h * std::pow(depth, 1.5), scaled = run.engine().clock.dt * std::pow(force, 1.0 / 6);
        low = std::min(low, scaled);
        high = std::max(high, scaled);
      }
    }
    CHECK(worst <= 0.96);
    CHECK(first >= run.engine().clock.dt);
    CHECK(std::abs(run.ball(1).position[2]) < 1e-9);
    said += lab::number(speed) + " m/s: " + std::to_string(cycles) + " cycles, step at most " + lab::number(worst) +
            " of the critical one; ";
    if (speed < 1) {
      CHECK(high / low < 2);  // 1 if no depth were looked ahead; a safe step is below the critical one all along
      said += "step times F^(1/6) within " + lab::number(high / low) + " over a pressure ratio of 350; ";
    }
  }
  lab::measured("57, D20", said);
}

TEST_CASE("D22 OK: a shear force that shrinks with the overlap for ever ends at zero or stays a plain number") {
  using namespace scree::test;
  const Settings glass = {{"shear", 30e9}, {"poiss", 0.25}, {"fric", 1e3}, {"hz_mode", 1}};
  for (const double share : {0.25, 0.8}) {
    INFO("overlap shrinks to " << share);
    HertzContact c(glass, 0.01, 0.01);
    c.move(1e-6, {}, 0);
    c.move(1e-6, {1e-9, 0, 0}, 1e-3);
    const double first = c.shear_spring().norm();
    CHECK(first > 0);
    for (int k = 0; k < 20000; ++k) {
      c.move(1e-6 * share, {}, 1e-3);
      c.move(1e-6, {}, 1e-3);
      REQUIRE(std::isfinite(c.shear_spring().norm()));
    }
    CHECK(c.shear_spring().norm() < 1e-200 * first);
  }
  lab::measured("D22", "20 000 times: below 1e-200 of what it was, finite");
}

TEST_CASE("D39 OK, REJECT: Poisson's ratio of 0.5 runs, beyond 0.5 and at -1 it is refused") {
  CHECK(refusal("shear: 1e9, poiss: 0.5") == "");
  CHECK(refusal("shear: 1e9, poiss: -0.999") == "");
  for (const std::string wrong : {"0.5000001", "0.9", "-1", "-2", ".nan"})
    CHECK_THAT(refusal("shear: 1e9, poiss: " + wrong), Catch::Contains("poiss"));
  lab::measured("D39", "0.5 and -0.999 run; 0.5000001, -1 and NaN: exit 3");
}

TEST_CASE("D63 REJECT: a shear modulus without end on a rule is refused with its place") {
  for (const std::string wrong : {".inf", "0", "-1e9", ".nan"})
    CHECK_THAT(refusal("poiss: 0.2, shear: " + wrong), Catch::Contains("shear"));
  lab::measured("D63", ".inf on both sides, 0, negative, NaN: exit 3 with file:line:column");
}
