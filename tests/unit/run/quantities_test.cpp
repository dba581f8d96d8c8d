#include "core/run/quantities.hpp"

#include <cmath>
#include <numbers>

#include "core/run/archive.hpp"
#include "core/run/expectation.hpp"
#include "core/run/fields.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/simulated.hpp"

using namespace scree::core;
using support::Simulated;

namespace {

// Ball 7 lies 5 mm deep in the floor and meets ball 3, which is off the floor, with an overlap of 10 mm; ball 9 flies.
const char* const three_balls =
    "id,x,y,z,radius,vx,vy,vz,wx,wy,wz,type\n"
    "7,0,0,0.095,0.1,0,0,0,0,0,0,low\n"
    "3,0.17,0,0.095,0.08,0,0,0,0,0,0,low\n"
    "9,2,0,1,0.1,1,2,3,0,0,5,high\n";

std::string scene_with(const std::string& more) {
  return "scree: 1\n"
         "walls: {floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}}\n"
         "balls: {grains: {generator: file, path: balls.csv, density: 1000}}\n"
         "contacts: [{name: all, between: [balls, [balls, walls]], model: linear, kn: 1e4, ks: 1e4, fric: 0.5}]\n" +
         more;
}

double mass_of(double radius) { return 1000 * 4 * std::numbers::pi / 3 * radius * radius * radius; }

void complete(Simulation& simulation) {
  simulation.engine.sums_wanted = simulation.engine.report_wanted = true;
  simulation.engine.forces();
}

std::string refusal(Quantities& quantities, const std::string& text) {
  try {
    quantities.check(Formula(text, {}, {"scene.yaml", 4, 2}));
  } catch (const SceneErrors& errors) {
    return errors.what();
  }
  return "";
}

// Thrown up at 1 m/s in a field of 10 m/s2: leapfrog with a half kick at the start lies on the parabola t - 5 t^2.
const char* const thrown =
    "scree: 1\n"
    "timestep: 1 ms\n"
    "balls: {one: {generator: file, path: balls.csv, density: 1000}}\n"
    "contacts: [{name: none, between: [one, one], model: none}]\n"
    "processes: {gravity: {process: gravity, acceleration: [0, 0, -10]}}\n"
    "quantities: {height: balls.1.position.z}\n";
const char* const thrown_ball = "x,y,z,r,vx,vy,vz\n0,0,0,0.01,0,0,1\n";

}  // namespace

TEST_CASE("quantities: totals and contacts of three balls are those computed by hand", "[run]") {
  Simulated scene(scene_with(""), three_balls);
  Quantities q(*scene);
  complete(*scene);
  const double m7 = mass_of(0.1), m3 = mass_of(0.08), m9 = m7;
  const auto near = [](double value) { return Approx(value).epsilon(1e-9).margin(1e-9); };
  CHECK(q.value("mass") == near(m7 + m3 + m9));
  CHECK(q.value("volume.balls") == near((m7 + m3 + m9) / 1000));
  CHECK(q.value("momentum.y") == near(2 * m9));
  // x cross v of ball 9 is (-2, -5, 4); a solid sphere adds 2/5 m r^2 w.
  CHECK(q.value("angular_momentum.x") == near(-2 * m9));
  CHECK(q.value("angular_momentum.z") == near(m9 * (4 + 0.4 * 0.01 * 5)));
  CHECK(q.value("kinetic_energy") == near(0.5 * m9 * (14 + 0.4 * 0.01 * 25)));
  CHECK(q.value("balls.count") == 3);
  CHECK(q.value("contacts.balls") == 1);
  CHECK(q.value("contacts.walls") == 1);
  CHECK(q.value("contacts.count") == 2);
  CHECK(q.value("contacts.sliding") == 0);
  CHECK(q.value("coordination") == near((2 * 1 + 1) / 3.0));
  CHECK(q.value("overlap.max") == near(0.01 / 0.08));
  // Net forces: 7 has (-100, 0, 50), 3 has 100, 9 has none; contact forces add up to 150, 100 and 0.
  CHECK(q.value("unbalanced") == near((std::sqrt(12500.0) + 100) / 250));
  CHECK(q.value("unbalanced.max") == near(std::sqrt(12500.0) / (250 / 3.0)));
  CHECK(q.value("time") == 0);
  CHECK(q.value("timestep") == scene->engine.clock.dt);
  CHECK(q.unit("angular_momentum.x") == "kg m2/s");
}

TEST_CASE("quantities: walls, balls and single contacts, whichever way they are named", "[run]") {
  Simulated scene(scene_with(""), three_balls);
  Quantities q(*scene);
  complete(*scene);
  const auto near = [](double value) { return Approx(value).epsilon(1e-9).margin(1e-9); };
  CHECK(q.value("walls.floor.force.z") == near(-50));
  CHECK(q.value("walls.floor.contacts") == 1);
  CHECK(q.value("balls.7.force.x") == near(-100));
  CHECK(q.value("balls.7.force.z") == near(50));
  CHECK(q.value("balls.9.velocity.z") == 3);
  CHECK(q.value("balls.9.spin.z") == 5);
  CHECK(q.value("balls.3.radius") == 0.08);
  CHECK(std::isnan(q.value("balls.4.mass")));
  CHECK(std::isnan(q.value("walls.lid.force.x")));
  // The force is that on the piece named second: ball 7 is pushed towards -x, ball 3 towards +x.
  CHECK(q.value("contacts.3.7.force.x") == near(-100));
  CHECK(q.value("contacts.7.3.force.x") == near(100));
  CHECK(q.value("contacts.7.3.normal_force") == near(100));
  CHECK(q.value("contacts.7.3.shear_force") == near(0));
  CHECK(q.value("contacts.7.3.overlap") == near(0.01));
  CHECK(q.value("contacts.7.floor.force.z") == near(-50));
  CHECK(q.value("contacts.7.floor.normal_force") == near(50));
  CHECK(q.value("contacts.7.floor.overlap") == near(0.005));
  CHECK(q.value("contacts.3.floor.normal_force") == 0);
  scene->engine.walls[0].centre[2] = 0.25;
  CHECK(q.value("walls.floor.displacement.z") == 0.25);
}

TEST_CASE("quantities: the deepest contact may be one with a wall", "[run]") {
  Simulated scene(scene_with(""), "x,y,z,r\n0,0,0.07,0.1\n");
  Quantities q(*scene);
  complete(*scene);
  CHECK(q.value("overlap.max") == Approx(0.3).epsilon(1e-12));
}

TEST_CASE("quantities: reductions over groups and conditions", "[run]") {
  Simulated scene(scene_with("quantities:\n"
                             "  all: {count: grains}\n"
                             "  touching: {count: balls, where: contacts > 0}\n"
                             "  low: {sum: x, over: grains.low}\n"
                             "  mean: {mean: 2*radius, over: grains.low}\n"
                             "  fastest: {max: speed}\n"
                             "  least: {min: id, where: z < 0.5}\n"
                             "  none: {mean: x, where: z > 100}\n"
                             "  nobody: {sum: x, where: z > 100}\n"
                             "  both: all + touching\n"),
                  three_balls);
  Quantities q(*scene);
  q.check_scene();
  complete(*scene);
  CHECK(q.value("all") == 3);
  CHECK(q.value("touching") == 2);
  CHECK(q.value("low") == Approx(0.17));
  CHECK(q.value("mean") == Approx(0.18));
  CHECK(q.value("fastest") == Approx(std::sqrt(14.0)));
  CHECK(q.value("least") == 3);
  CHECK(std::isnan(q.value("none")));
  CHECK(q.value("nobody") == 0);
  CHECK(q.value("both") == 5);
}

TEST_CASE("quantities: a wrong name is told with its place and the nearest one", "[run]") {
  Simulated scene(scene_with("quantities: {stress: 2*walls.floor.force.z}\n"), three_balls);
  Quantities q(*scene);
  CHECK(refusal(q, "stress.peak + walls.floor.force.x + balls.7.mass + contacts.7.floor.overlap") == "");
  CHECK(refusal(q, "unbalancd") == "scene.yaml:4:2: error: unknown quantity 'unbalancd'; did you mean 'unbalanced'?");
  CHECK(refusal(q, "stres.peak").find("'stres'; did you mean 'stress'?") != std::string::npos);
  CHECK(refusal(q, "walls.flor.force.z").find("no wall 'flor'; did you mean 'floor'?") != std::string::npos);
  CHECK(refusal(q, "walls.floor.forse.z").find("did you mean 'walls.floor.force.z'?") != std::string::npos);
  CHECK(refusal(q, "balls.7.positon.x").find("did you mean 'balls.7.position.x'?") != std::string::npos);
  CHECK(refusal(q, "balls.12.mass").find("no ball has the id 12") != std::string::npos);
  CHECK(refusal(q, "contacts.7.3.force").find("did you mean 'contacts.7.3.force.x'?") != std::string::npos);
  CHECK(refusal(q, "walls.floor.force + zzz").find('\n') != std::string::npos);
}

TEST_CASE("quantities: a circle through an extreme is refused", "[run]") {
  Simulated scene(scene_with("quantities: {a: b.peak + 1, b: 2*a}\n"), three_balls);
  Quantities q(*scene);
  CHECK_THROWS_WITH(q.check_scene(), Catch::Matchers::Contains("depends on itself"));
}

TEST_CASE("quantities: extremes are those of the cycles looked at and of now, and survive a checkpoint", "[run]") {
  Simulated scene(std::string(thrown) + "expect: [{quantity: height.peak + height.least + cycle.peak, at_least: 0}]\n",
                  thrown_ball);
  Quantities q(*scene);
  q.check_scene();
  for (int k = 0; k < 145; ++k) {
    scene->engine.forces();
    q.follow();
    scene->engine.advance();
  }
  scene->engine.forces();
  const double top = 0.1 - 5 * 0.01;  // at 0.1 s
  CHECK(q.value("height") == Approx(0.145 - 5 * 0.145 * 0.145).epsilon(1e-10));
  CHECK(q.value("height.peak") == Approx(top).epsilon(1e-10));
  CHECK(q.value("height.least") == 0);
  CHECK(q.value("cycle.peak") == 145);
  ArchiveWriter archive(scene.folder() / "state");
  q.save(archive, "quantities");
  REQUIRE(archive.commit());
  Quantities again(*scene);
  again.check_scene();
  CHECK(again.value("height.peak") == again.value("height"));
  again.load(ArchiveReader(scene.folder() / "state"), "quantities");
  CHECK(again.value("height.peak") == q.value("height.peak"));
}

TEST_CASE("quantities: what a name needs of the cycle follows through the scene's own", "[run]") {
  Simulated scene(
      scene_with("quantities: {ratio: 2*unbalanced, slip: contacts.sliding + time, load: walls.floor.force.z}\n"),
      three_balls);
  Quantities q(*scene);
  CHECK(q.needs("ratio").sums);
  CHECK_FALSE(q.needs("ratio").report);
  CHECK(q.needs("slip").report);
  CHECK_FALSE(q.needs("load").pass);
  CHECK_FALSE(q.needs("balls.1.position.z").pass);
  CHECK(q.needs("balls.1.velocity.z").pass);
  scene->engine.forces();  // without the report
  CHECK_THROWS_AS(q.value("slip"), Refusal);
}

TEST_CASE("expectations: bounds, tolerance, distance, and NaN fails", "[run]") {
  Simulated scene(scene_with("quantities: {none: {mean: x, where: z > 100}}\n"
                             "expect:\n"
                             "  - {quantity: balls.count, between: [2, 10]}\n"
                             "  - {quantity: balls.count, at_most: 2}\n"
                             "  - {quantity: walls.floor.force.z, equals: -50.02, within: 0.1 %, source: by hand}\n"
                             "  - {quantity: walls.floor.force.z, equals: -51, within: 0.5}\n"
                             "  - {quantity: none, at_least: 0}\n"),
                  three_balls);
  Quantities q(*scene);
  q.check_scene();
  complete(*scene);
  const auto results = measured_expectations(scene->scene, q);
  REQUIRE(results.size() == 5);
  CHECK(results[0].passed);
  CHECK(results[0].difference == 1);
  CHECK_FALSE(results[1].passed);
  CHECK(results[1].difference == 1);
  CHECK(results[2].passed);
  CHECK(*results[2].difference == Approx(0.02).epsilon(1e-6));
  CHECK(results[2].source == "by hand");
  CHECK_FALSE(results[3].passed);
  CHECK_FALSE(results[4].passed);
}

TEST_CASE("quantities: the page of quantities names each of them", "[run]") {
  Simulated scene(scene_with(""), three_balls);
  const std::string page = read_text(support::source_dir() + "/docs/quantities.md");
  for (const std::string& name : published_names(*scene)) {
    if (name.starts_with("walls.")) continue;
    const std::string shown =
        name.ends_with(".y") || name.ends_with(".z") ? name.substr(0, name.size() - 1) + "x" : name;
    INFO(name);
    CHECK(page.find("`" + shown + "`") != std::string::npos);
  }
  for (const std::string& name : field_names()) {
    INFO(name);
    CHECK(page.find("`" + name + "`") != std::string::npos);
  }
}
