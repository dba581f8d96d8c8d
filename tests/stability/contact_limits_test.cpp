// Cases D9, D10, D21, D31 to D34: contacts at the edge of what numbers can say. Everywhere the point is that the result
// is the one of the equations, finite, and the same on every run.
#include <algorithm>
#include <cmath>

#include "core/run/sanity.hpp"
#include "laws/columns.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

/// Two balls of 10 mm; the second one's centre lies `apart` (m) from the first one's, which is at the origin.
std::string two_balls(const std::string& apart, const std::string& law, const std::string& more = "") {
  return "scree: 1\n" + more +
         "balls:\n  pair: {generator: file, path: balls.csv, density: 2500}\n"
         "contacts:\n  - {name: touch, between: [pair, pair], model: linear, " +
         law + "}\nstages:\n  - go: [cycle: 100]\n#" + apart + "\n";
}

void write_pair(const lab::Lab& here, const std::string& apart) {
  write_text(here.folder() / "balls.csv", "x,y,z,radius\n0,0,0,0.01\n" + apart + ",0.01\n");
}

double force(const Simulation& simulation, std::size_t row, std::size_t c) {
  return simulation.engine.contacts.slices().record(row)[c];
}

/// On a slope of 20 degrees, at rest at its equilibrium overlap; gravity is turned instead of the floor.
std::string slope(const std::string& fric) {
  return R"yaml(scree: 1
vars: {g: 9.81, tilt: 0.3490658503988659}
timestep: 1e-5
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  ball: {generator: file, path: balls.csv, density: 2500}
contacts:
  - {name: ground, between: [balls, [balls, walls]], model: linear, kn: 1e6, ks: 5e5, fric: )yaml" +
         fric + R"yaml(}
processes:
  pull: {process: gravity, acceleration: ["g*sin(tilt)", 0, "-g*cos(tilt)"]}
stages:
  - roll: [cycle: 20000]
)yaml";
}

std::unique_ptr<Simulation> rolled(lab::Lab& here, const std::string& fric) {
  const double radius = 0.05, mass = 2500 * 4.0 / 3 * 3.14159265358979323846 * radius * radius * radius;
  char line[120];
  std::snprintf(line, sizeof line, "x,y,z,radius\n0,0,%.17g,0.05\n",
                radius - mass * 9.81 * std::cos(0.3490658503988659) / 1e6);
  write_text(here.folder() / "balls.csv", line);
  auto simulation = here.make(slope(fric));
  lab::run(*simulation, 20000);
  return simulation;
}

}  // namespace

TEST_CASE("D9 STOP: coincident centres stop a run, or part along a fixed direction when the limit is lifted") {
  lab::Lab here;
  write_pair(here, "0,0,0");
  const auto stopped = here.make(two_balls("", "kn: 1e5, ks: 0"));
  CHECK_THROWS_AS(stopped->engine.forces(), NumericalStop);

  uint64_t hash = 0;
  for (int again = 0; again < 2; ++again) {
    const auto simulation =
        here.make(two_balls("", "kn: 1e5, ks: 5e4, fric: 0.3", "overlap_limit: 300 %\ntimestep: 1e-5\n"));
    simulation->engine.forces();
    // The direction is that from the lower to the higher id along x; the overlap is the whole diameter.
    CHECK(force(*simulation, lab::row_of(*simulation, 2), 0) == Approx(1e5 * 0.02).epsilon(1e-12));
    CHECK(force(*simulation, lab::row_of(*simulation, 2), 1) == 0);
    lab::run(*simulation, 100);
    for (std::size_t row = 0; row < 2; ++row)
      for (const Column c : {Column::x, Column::y, Column::z, Column::vx})
        CHECK(std::isfinite(simulation->engine.balls[c][row]));
    CHECK(lab::at(*simulation, Column::vx, 2) > 0);
    CHECK(lab::at(*simulation, Column::vx, 1) == -lab::at(*simulation, Column::vx, 2));
    if (again == 1) CHECK(simulation->engine.state_hash() == hash);
    hash = simulation->engine.state_hash();
  }
  lab::measured("D9", "exit 5 at the default limit; with it lifted the balls part along x, momentum 0, equal bits");
}

TEST_CASE("D10 OK: centres 1e-160 m apart keep their direction although its square is 0") {
  lab::Lab here;
  write_pair(here, "0,0,1e-160");
  const auto stopped = here.make(two_balls("", "kn: 1e5, ks: 0"));
  CHECK_THROWS_AS(stopped->engine.forces(), NumericalStop);
  const auto simulation =
      here.make(two_balls("", "kn: 1e5, ks: 5e4, fric: 0.3", "overlap_limit: 300 %\ntimestep: 1e-5\n"));
  simulation->engine.forces();
  const double f = force(*simulation, lab::row_of(*simulation, 2), 2);
  CHECK(f == Approx(1e5 * 0.02).epsilon(1e-12));
  CHECK(force(*simulation, lab::row_of(*simulation, 2), 0) == 0);
  lab::run(*simulation, 100);
  CHECK(lab::at(*simulation, Column::vz, 2) > 0);
  CHECK(lab::at(*simulation, Column::vz, 1) == -lab::at(*simulation, Column::vz, 2));
  lab::measured("D10", "force " + lab::number(f) + " N along z, momentum 0");
}

TEST_CASE("D21 OK: an overlap of 1e-300 m gives its tiny force and no NaN") {
  lab::Lab here;
  // The law itself, at overlaps that no position of this size can have.
  const scree_contact_model& linear = here.catalogue().open(Kind::contact_model, "linear").contact_model();
  for (const double overlap : {1e-300, 1e-310, 4.9e-324, 0.0})
    for (const double mode : {0.0, 1.0}) {
      scree::test::Columns one(
          linear, scree::test::rule_of(linear, {{"kn", 1e5}, {"ks", 5e4}, {"fric", 0.3}, {"lin_mode", mode}}), 1);
      one.put(0, {{0, 0, 1}, {1e-3, 0, mode != 0 ? -overlap / one.dt : 0.0}, {}, {}, -overlap});
      one.run();
      const scree::Vec3 f = one.force(0);
      INFO("overlap " << overlap << ", lin_mode " << mode);
      CHECK(std::fabs(f.z - 1e5 * overlap) <= 1e-12 * 1e5 * overlap + 1e-318);
      // Friction follows the normal force down to nothing.
      CHECK(std::fabs(f.x) <= 0.3 * f.z * (1 + 1e-12) + 1e-318);
      CHECK((std::isfinite(f.x) && f.y == 0));
      for (std::size_t word = 0; word < 3; ++word) CHECK(std::isfinite(one.state(word)[0]));
    }
  // Surfaces that touch exactly (0.02 is twice 0.01 in doubles too); the reference gap makes the overlap.
  write_pair(here, "0.02,0,0");
  for (const double overlap : {1e-300, 4.9e-324, 0.0}) {
    char law[120];
    std::snprintf(law, sizeof law, "kn: 1e5, ks: 5e4, fric: 0.3, rgap: %.17g", overlap);
    const auto simulation = here.make(two_balls("", law, "timestep: 1e-6\n"));
    simulation->engine.forces();
    INFO("overlap " << overlap);
    // At exactly touching surfaces the pair may or may not be looked at; if it is, the force is kn times the overlap.
    const double f = force(*simulation, lab::row_of(*simulation, 2), 0);
    CHECK((f == 0 || f == Approx(1e5 * overlap).epsilon(1e-12)));
    lab::run(*simulation, 100);
    CHECK(std::isfinite(lab::at(*simulation, Column::x, 2)));
    CHECK(lab::at(*simulation, Column::x, 2) == 0.02);
  }
  // The smallest overlap that positions of this size can have is far larger, and is exact as well.
  write_pair(here, "0.019999999999999997,0,0");
  const auto simulation = here.make(two_balls("", "kn: 1e5, ks: 5e4, fric: 0.3"));
  simulation->engine.forces();
  const double f = force(*simulation, lab::row_of(*simulation, 2), 0), depth = 0.02 - 0.019999999999999997;
  CHECK(f == Approx(1e5 * depth).epsilon(1e-9));
  lab::measured("D21", "one unit in the last place of the distance: " + lab::number(f) + " N = kn times " +
                           lab::number(depth) + " m; 1e-300 m and 5e-324 m: finite");
}

TEST_CASE("D31 OK: huge friction means no slip and no overflow") {
  // Rolling without slip: a = 5/7 g sin(tilt), for any friction above 2/7 tan(tilt).
  const double expected = 5.0 / 7 * 9.81 * std::sin(0.3490658503988659), time = 20000 * 1e-5;
  lab::Lab here;
  const auto one = rolled(here, "1");
  const uint64_t hash = one->engine.state_hash();
  for (const std::string fric : {"1e10", "1e308"}) {
    const auto huge = rolled(here, fric);
    INFO(fric);
    CHECK(huge->engine.state_hash() == hash);
    const double x = lab::at(*huge, Column::x, 1);
    CHECK(x == Approx(0.5 * expected * time * time).epsilon(1e-3));
    lab::measured("D31", "fric " + fric + ": same bits as fric 1; x against rolling without slip " +
                             lab::number(x / (0.5 * expected * time * time) - 1));
  }
}

TEST_CASE("D32 OK: without friction spins never change a bit") {
  lab::Lab here;
  // Another rule has friction, so spins exist.
  const auto simulation = here.make(R"(scree: 1
seed: 3
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  smooth: {generator: random, box: [[0, 0, 0], [0.1, 0.1, 0.1]], radius: [4 mm, 5 mm], count: 400, density: 2600,
           velocity: [0.3, 0, -2], spin: [1.1, -2.3, 0.7]}
  rough: {generator: lattice, kind: sc, radius: 5 mm, box: [[3, 0, 0], [3.02, 0.02, 0.02]], density: 2600}
contacts:
  - {name: slick, between: [smooth, [smooth, floor]], model: linear, kn: 1e5, ks: 5e4, fric: 0}
  - {name: grip, between: [rough, [rough, smooth, floor]], model: linear, kn: 1e5, ks: 5e4, fric: 0.5}
stages:
  - fall: [cycle: 3000]
)");
  uint64_t touching = 0;
  for (int part = 0; part < 100; ++part) {
    lab::run(*simulation, 30);
    touching = std::max(touching, simulation->engine.contacts.active());
  }
  const Balls& balls = simulation->engine.balls;
  REQUIRE(balls.has(Column::wx));
  CHECK(simulation->engine.contacts.lists().at(0).state.empty());
  CHECK_FALSE(simulation->engine.contacts.lists().at(1).state.empty());
  CHECK(touching > 20);
  uint64_t changed = 0;
  for (std::size_t row = 0; row < balls.size(); ++row)
    if (balls.id()[row] <= 400)
      changed += !(balls[Column::wx][row] == 1.1 && balls[Column::wy][row] == -2.3 && balls[Column::wz][row] == 0.7);
  CHECK(changed == 0);
  lab::measured("D32", "400 spinning balls, 3000 cycles: spins that changed " + std::to_string(changed) +
                           "; no state stored for their rule");
}

TEST_CASE("D33 REJECT, OK: a contact without stiffness needs a step and then does nothing") {
  lab::Lab here;
  write_pair(here, "0.0195,0,0");
  const auto refused = here.make(two_balls("", "kn: 0, ks: 0"));
  try {
    refused->engine.forces();
    FAIL("nothing limits the step, and the run began");
  } catch (const Refusal& refusal) {
    CHECK(refusal.code() == Exit::scene);
    CHECK(std::string(refusal.what()).find("timestep") != std::string::npos);
  }
  const auto simulation = here.make(two_balls("", "kn: 0, ks: 1e5, fric: 0.5, dp_nratio: 0.3", "timestep: 1e-5\n"));
  lab::run(*simulation, 100);
  CHECK(simulation->engine.contacts.active() == 1);
  CHECK(force(*simulation, 0, 0) == 0);
  CHECK(lab::at(*simulation, Column::x, 2) == 0.0195);
  // Another pair limits the step: then the soft one is just left alone.
  write_text(here.folder() / "more.csv", "x,y,z,radius\n1,0,0,0.01\n1.0195,0,0,0.01\n");
  const auto mixed = here.make(R"(scree: 1
balls:
  soft: {generator: file, path: balls.csv, density: 2500}
  stiff: {generator: file, path: more.csv, density: 2500}
contacts:
  - {name: nothing, between: [soft, balls], model: linear, kn: 0, ks: 0}
  - {name: springs, between: [stiff, stiff], model: linear, kn: 1e5, ks: 0}
stages:
  - go: [cycle: 100]
)");
  lab::run(*mixed, 100);
  CHECK(lab::at(*mixed, Column::x, 2) == 0.0195);
  CHECK(lab::at(*mixed, Column::vx, 4) > 0);
  lab::measured("D33", "exit 3 asking for 'timestep'; with one: force 0, balls unmoved");
}

TEST_CASE("D34 WARN: friction without a shear spring has no effect, and the log says so") {
  lab::Lab here;
  write_pair(here, "0.0195,0,0");
  const auto simulation = here.make(two_balls("", "kn: 1e5, ks: 0, fric: 0.5"));
  simulation->engine.forces();
  const auto said = doubts(*simulation);
  REQUIRE(said.size() == 1);
  CHECK(said[0].find("scene.yaml:") != std::string::npos);
  CHECK(said[0].find("rule 'touch' gives friction but no shear stiffness") != std::string::npos);
  CHECK(simulation->engine.contacts.lists().at(0).state.empty());
  CHECK_FALSE(simulation->engine.balls.has(Column::wx));
  const auto fine = here.make(two_balls("", "kn: 1e5, ks: 1e5, fric: 0.5"));
  fine->engine.forces();
  CHECK(doubts(*fine).empty());
  lab::measured("D34", "warning with the place of the rule; no spin, no state");
}
