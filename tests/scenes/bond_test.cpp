// Bonds: which pairs get one, how long they live, and what is left of one that broke.
#include <cmath>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Action;
using scree::core::Column;

namespace {

const char* const glue =
    "model: contact_bond, kn: 1e6, ks: 1e6, fric: 0.5, lin_mode: 1, cb_tenf: 100, cb_shearf: 100}\n";

/// Four balls in a row along x, the gaps between them 0, 1 um and 10 um.
const char* const row = "x,y,z,radius,group\n0,0,0,0.01,a\n0.02,0,0,0.01,a\n0.040001,0,0,0.01,b\n0.060011,0,0,0.01,b\n";

std::string scene(const std::string& stages, const std::string& processes = "") {
  return std::string(
             "scree: 1\ntimestep: 1e-6\nballs:\n  row: {generator: file, path: balls.csv, density: 2500}\n"
             "contacts:\n  - {name: glue, between: [balls, balls], ") +
         glue + processes + "stages:\n" + stages;
}

void act(SceneRun& run, std::size_t stage) {
  for (const Action& action : run.simulation().scene.stages.at(stage).actions) run.simulation().edit(action);
}

}  // namespace

TEST_CASE("a bond action bonds the pairs of its rule within its gap, between its groups") {
  const auto bonded = [](const std::string& action) {
    SceneRun run(scene("  - one: [bond: {" + action + "}]\n"), row);
    act(run, 0);
    return run.value("bonds.count");
  };
  CHECK(bonded("rule: glue") == 1);
  CHECK(bonded("rule: glue, gap: 2 um") == 2);
  CHECK(bonded("rule: glue, gap: 1 mm") == 3);
  CHECK(bonded("rule: glue, gap: 30 mm") == 5);  // farther than the lists reach
  CHECK(bonded("rule: glue, gap: 1 mm, between: [row.a, row.b]") == 1);
  CHECK(bonded("rule: glue, gap: 1 mm, between: [row.b, [row.b]]") == 1);
}

TEST_CASE("a bond begins without force and is counted once") {
  SceneRun run(scene("  - one: [bond: {rule: glue, gap: 1 mm}]\n  - again: [bond: {rule: glue, gap: 1 mm}]\n"), row);
  act(run, 0);
  act(run, 1);
  CHECK(run.value("bonds.count") == 3);
  run.step(1000);
  // D14: nothing pulls, so nothing may move, to the last bit.
  for (uint64_t id = 1; id <= 4; ++id)
    for (double v : run.ball(id).velocity) CHECK(v == 0);
}

TEST_CASE("D44 OK: a bonded pair holds over a gap of five radii") {
  SceneRun run(
      std::string(
          "scree: 1\ntimestep: 1e-5\nballs:\n  row: {generator: file, path: balls.csv, density: 2500}\n"
          "contacts:\n  - {name: glue, between: [balls, balls], model: contact_bond, kn: 1e3, ks: 1e3, lin_mode: 1, "
          "cb_tenf: .inf, cb_shearf: .inf}\nstages:\n  - one: [bond: {rule: glue, gap: 60 mm}]\n"),
      "x,y,z,radius,vx,vy,vz\n0,0,0,0.01,-1,0,0\n0.07,0,0,0.01,1,0,0\n");
  act(run, 0);
  REQUIRE(run.value("bonds.count") == 1);
  const uint64_t before = run.engine().rebuilds();
  double farthest = 0;
  for (int k = 0; k < 500; ++k) {
    run.step(10);
    farthest = std::max(farthest, run.ball(2).position[0] - run.ball(1).position[0]);
  }
  CHECK(run.engine().rebuilds() > before);
  CHECK(run.value("bonds.count") == 1);
  // The pair swings about 0.07 m with amplitude v sqrt(m/(2 k)) each.
  const double mass = run.engine().balls[Column::mass][0];
  Measure measure("D44", "amplitude v sqrt(m/(2k)) of each of two equal balls on a spring (energy conservation)");
  measure.check("largest distance", farthest, 0.07 + 2 * std::sqrt(mass / 2e3), 1e-4);
}

TEST_CASE("a bond that broke leaves a contact, and is bonded again only where that is asked for") {
  const std::string pull =
      "apply: {balls: row, force: [300, 0, 0], where: \"id == 2\"}, "
      "fix: {balls: row, where: \"id != 2\"}";
  SceneRun run(scene("  - one: [bond: {rule: glue}, " + pull +
                     "]\n  - first_only: [bond: {rule: glue, gap: 5 mm, again: false, "
                     "between: [row.a, row.a]}]\n  - anew: [bond: {rule: glue, gap: 5 mm, between: [row.a, row.a]}]\n"),
               row);
  act(run, 0);
  while (run.value("bonds.broken") == 0 && run.time() < 1) run.step();
  REQUIRE(run.engine().broken.size() == 1);
  const auto& broke = run.engine().broken[0];
  CHECK(broke.what.ids == scree::core::IdPair{1, 2});
  CHECK(broke.what.mode == 1);
  CHECK(broke.cycle == run.engine().clock.cycle);
  CHECK(std::abs(broke.what.point[0] - 0.01) < 1e-3);
  CHECK(run.value("bonds.broken.tension") == 1);
  CHECK(run.value("bonds.count") == 0);
  act(run, 1);
  CHECK(run.value("bonds.count") == 0);
  act(run, 2);
  CHECK(run.value("bonds.count") == 1);
}

TEST_CASE("the process bond glues what comes near, at most once unless it is told so") {
  SceneRun run(
      scene("  - go: [cycle: 1]\n", "processes:\n  cement: {process: bonding, rule: glue, gap: 5 um, every: 10}\n"),
      row);
  CHECK(run.value("bonds.count") == 0);
  run.step(10);
  CHECK(run.value("bonds.count") == 2);
  for (uint64_t id = 1; id <= 4; ++id)
    for (double v : run.ball(id).velocity) CHECK(v == 0);
}

TEST_CASE("bonds reach through the periodic cell") {
  SceneRun run(
      std::string("scree: 1\ntimestep: 1e-6\ncell: {low: [0, -0.1, -0.1], high: [0.2, 0.1, 0.1], periodic: [x]}\n"
                  "balls:\n  row: {generator: file, path: balls.csv, density: 2500, velocity: [3, 0, 0]}\n"
                  "contacts:\n  - {name: glue, between: [balls, balls], ") +
          glue + "stages:\n  - one: [bond: {rule: glue, gap: 1 um}]\n",
      "x,y,z,radius\n0.005,0,0,0.01\n0.185,0,0,0.01\n");
  act(run, 0);
  REQUIRE(run.value("bonds.count") == 1);
  run.step(20000);  // 60 mm: both balls go round
  CHECK(run.value("bonds.count") == 1);
  CHECK(run.engine().rebuilds() > 5);
  CHECK(std::abs(run.ball(1).force[0]) < 1e-6);
}

TEST_CASE("a deleted rule takes its bonds with it, and deleted balls theirs") {
  SceneRun run(scene("  - one: [bond: {rule: glue, gap: 1 mm}, delete: {balls: row, where: \"id == 2\"}]\n"), row);
  act(run, 0);
  CHECK(run.value("bonds.count") == 1);
  CHECK(run.value("bonds.broken") == 0);
}
