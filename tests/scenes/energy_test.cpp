// The energy balance: every joule that a scene is given is stored, or lost in a place that has a name.
#include <cmath>
#include <numbers>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;

namespace {

constexpr double ball_mass = 4.0 / 3.0 * std::numbers::pi * 1e-6 * 2500;  // of radius 10 mm at 2500 kg/m3

std::string box_of_30(const std::string& law, double step) {
  return "scree: 1\nseed: 5\ntimestep: " + digits(step) + R"(
walls:
  box: {wall: box, low: [0, 0, 0], high: [0.12, 0.12, 0.12]}
balls:
  sand: {generator: random, box: [[0, 0, 0], [0.12, 0.12, 0.12]], radius: 10 mm, count: 30, density: 2500}
contacts:
  - {between: [sand, [sand, box]], model: linear, kn: 1e5, ks: 4e4, )" +
         law + R"(}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
  energy: {process: energy_ledger}
)";
}

}  // namespace

TEST_CASE("F4: a ball that slides until it rolls loses two sevenths of its energy to friction") {
  SceneRun run(
      R"(scree: 1
timestep: 2e-5
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  ball: {generator: file, path: balls.csv, density: 2500, velocity: [1, 0, 0]}
contacts:
  - {between: [ball, floor], model: linear, kn: 1e6, ks: 1e6, fric: 0.3}
  - {between: [ball, ball], model: none}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
  energy: {process: energy_ledger}
)",
      // Resting in the floor by its weight, so that it does not bounce.
      "x,y,z,radius\n0,0," + digits(0.05 - 4.0 / 3.0 * std::numbers::pi * 1.25e-4 * 2500 * 9.81 / 1e6) + ",0.05\n");
  run.step(10000);
  const double mass = 4.0 / 3.0 * std::numbers::pi * 1.25e-4 * 2500;
  Measure measure("F4",
                  "work of friction m v0^2/7 while a sphere slides until it rolls (Coulomb friction, I = 2/5 m R^2)");
  measure.check("energy lost to friction", run.value("energy.friction"), mass / 7, 1e-3 * mass / 7);
  measure.check("share of the energy that is not accounted for", run.value("energy.residual_share"), 0, 1e-3);
}

TEST_CASE("P-02 b: thirty balls that bounce in a box without loss keep their energy over 1e5 cycles") {
  // 0.02 of the pair limit 2 sqrt(m/(2 kn)).
  SceneRun run(box_of_30("fric: 0", 0.02 * 2 * std::sqrt(ball_mass / 2e5)));
  run.engine().sums_wanted = run.engine().report_wanted = false;
  double most = 0;
  for (int part = 0; part < 100; ++part) {
    run.step(1000);
    most = std::max(most, run.value("energy.residual_share"));
  }
  Measure measure("P-02 b", "energy conservation; 0.02 of the critical step");
  measure.check("largest share that is not accounted for", most, 0, 1e-3);
  CHECK(run.value("energy.friction") == 0);
  CHECK(run.value("energy.dashpot") == 0);
}

TEST_CASE("P-02 b: with friction and dashpots the box comes to rest and the account closes") {
  SceneRun run(box_of_30("fric: 0.4, dp_nratio: 0.2, dp_sratio: 0.1", 0.05 * 2 * std::sqrt(ball_mass / 2e5)));
  run.engine().sums_wanted = run.engine().report_wanted = false;
  run.step(60000);
  const double in = run.value("energy.body"), lost = run.value("energy.friction") + run.value("energy.dashpot");
  Measure measure("P-02 b, damped",
                  "energy conservation: what gravity gave is lost to friction and dashpots, or stored");
  measure.check("kinetic energy over work of gravity", run.value("energy.kinetic") / in, 0, 1e-3);
  measure.check("lost and stored over work of gravity", (lost + run.value("energy.strain")) / in, 1, 1e-3);
  measure.check("share that is not accounted for", run.value("energy.residual_share"), 0, 1e-3);
}

TEST_CASE("P-02 c: a bond that breaks gives up what it stored") {
  // One ball is held, the other pulled away slowly: the bond stores F^2/(2 kn) up to F = cb_tenf.
  SceneRun run(R"(scree: 1
timestep: 1e-5
balls:
  held: {generator: file, path: balls.csv, density: 2500, fixed: true}
  pulled: {generator: lattice, kind: sc, radius: 10 mm, spacing: 20 mm, box: [[0.01, -0.01, -0.01], [0.03, 0.01, 0.01]],
           density: 2500, fixed: true, velocity: [1e-3, 0, 0]}
contacts:
  - {name: glue, between: [balls, balls], model: contact_bond, kn: 1e6, ks: 1e6, cb_tenf: 100, cb_shearf: 1e6}
processes:
  energy: {process: energy_ledger}
stages:
  - bond: [bond: {rule: glue, gap: 1e-9}]
)",
               "x,y,z,radius\n0,0,0,0.01\n");
  run.simulation().edit(run.simulation().scene.stages[0].actions[0]);
  REQUIRE(run.value("bonds.count") == 1);
  double stored = 0;
  while (run.value("bonds.broken") == 0 && run.time() < 1) {
    stored = run.value("energy.bond");
    run.step(10);
  }
  CHECK(run.engine().broken.size() == 1);
  Measure measure("P-02 c", "elastic energy F^2/(2 k) of the bond at its strength F = 100 N, k = 1e6 N/m");
  measure.check("energy of the break", run.value("energy.bond_break"), 5e-3, 1e-3 * 5e-3);
  measure.check("the same in the log of breaks", run.engine().broken.at(0).what.energy, run.value("energy.bond_break"),
                0);
  measure.check("work of the motion that was prescribed", run.value("energy.boundary"), 5e-3, 1e-3 * 5e-3);
  measure.check("energy of the break against what was stored ten cycles before", run.value("energy.bond_break"), stored,
                3e-3 * 5e-3);
  measure.check("share that is not accounted for", run.value("energy.residual_share"), 0, 1e-3);
  CHECK(run.value("bonds.count") == 0);
}

TEST_CASE("P-02 d: a wall that is pushed into a ball works against its spring") {
  SceneRun run(R"(scree: 1
timestep: 1e-5
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
  lid: {wall: plane, point: [0, 0, 0.02], normal: [0, 0, -1], velocity: [0, 0, -1e-2]}
balls:
  ball: {generator: file, path: balls.csv, density: 2500, fixed: true}
contacts:
  - {between: [ball, walls], model: linear, kn: 1e6, ks: 0}
  - {between: [ball, ball], model: none}
processes:
  energy: {process: energy_ledger}
)",
               "x,y,z,radius\n0,0,0.01,0.01\n");
  run.step(1000);  // 0.1 mm
  Measure measure("P-02 d", "work of a wall on a spring, k u^2/2 at u = 0.1 mm, k = 1e6 N/m");
  measure.check("work of the wall", run.value("energy.boundary"), 5e-3, 1e-9);
  measure.check("strain energy", run.value("energy.strain"), 5e-3, 1e-9);
  measure.check("share that is not accounted for", run.value("energy.residual_share"), 0, 1e-9);
}

TEST_CASE("a closed conservative contact keeps its shadow energy over 1e6 cycles") {
  // Case 15 of the extreme cases too: a bonded oscillator at 0.2 of its critical step.
  const double step = 0.2 * 2 * std::sqrt(ball_mass / 2e6);
  SceneRun run("scree: 1\ntimestep: " + digits(step) + R"(
balls:
  pair: {generator: file, path: balls.csv, density: 2500}
contacts:
  - {name: glue, between: [pair, pair], model: contact_bond, kn: 1e6, ks: 1e6, cb_tenf: .inf, cb_shearf: .inf}
processes:
  energy: {process: energy_ledger}
stages:
  - bond: [bond: {rule: glue}]
)",
               "x,y,z,radius,vx,vy,vz\n0,0,0,0.01,0.1,0,0\n0.02,0,0,0.01,-0.1,0,0\n");
  run.engine().sums_wanted = run.engine().report_wanted = false;
  run.simulation().edit(run.simulation().scene.stages[0].actions[0]);
  run.step(10);
  const double start = run.value("energy.kinetic_shadow") + run.value("energy.bond");
  run.step(1000000);
  const double end = run.value("energy.kinetic_shadow") + run.value("energy.bond");
  Measure measure("ledger",
                  "1/2 m v(n-1/2) v(n+1/2) + 1/2 k x(n)^2 is constant under leapfrog for a linear oscillator");
  measure.check("drift of the shadow energy over 1e6 cycles, relative", end / start - 1, 0, 1e-9);
  measure.check("residual over energy", run.value("energy.residual") / start, 0, 1e-9);
}

TEST_CASE("what an edit does to the stored energy is work of the user") {
  // A resting overlap of 0.1 mm at 1e6 N/m holds 5 mJ; twice the stiffness holds twice that.
  SceneRun run(R"(scree: 1
timestep: 1e-6
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  ball: {generator: file, path: balls.csv, density: 2500, fixed: true}
contacts:
  - {name: soil, between: [ball, floor], model: linear, kn: 1e6, ks: 0}
  - {between: [ball, ball], model: none}
processes:
  energy: {process: energy_ledger}
stages:
  - harder: [set: {contacts.soil.kn: 2e6}]
)",
               "x,y,z,radius\n0,0,0.0099,0.01\n");
  run.step(3);
  run.engine().forces();
  run.simulation().edit(run.simulation().scene.stages[0].actions[0]);
  Measure measure("A13 edits", "strain energy k u^2/2 before and after");
  measure.check("work of the edit", run.value("energy.edits"), 5e-3, 1e-12);
  measure.check("share that is not accounted for", run.value("energy.residual_share"), 0, 1e-12);
}
