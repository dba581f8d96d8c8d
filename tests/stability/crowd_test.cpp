// The step that holds for any arrangement of balls: against the critical step of arrangements, where it must not be
// used, and the flows that it is for.
#include <memory>

#include "core/contact/crowd.hpp"
#include "stability/networks.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

Crowd crowd_of(Simulation& simulation, double depth, double local_damping = 0) {
  Engine& engine = simulation.engine;
  Crowd crowd(engine.contacts.book, engine.balls, engine.cell, engine.team);
  crowd.take(engine.contacts.book, engine.balls, depth, local_damping);
  return crowd;
}

/// A ball and twelve round it, as in the densest lattice; they overlap by 1e-6 of the radius.
std::string cluster(double radius) {
  std::string text = "x,y,z,radius\n0,0,0," + std::to_string(radius) + "\n";
  const double way = 2 * radius * (1 - 0.5 * networks::overlap) / std::sqrt(2.0);
  for (int axis = 0; axis < 3; ++axis)
    for (const int a : {-1, 1})
      for (const int b : {-1, 1}) {
        double at[3] = {0, 0, 0};
        at[axis] = a * way;
        at[(axis + 1) % 3] = b * way;
        char row[160];
        std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g,%.17g\n", at[0], at[1], at[2], radius);
        text += row;
      }
  return text;
}

std::string scene_of(const std::string& law, const std::string& more = "") {
  return "scree: 1\nballs:\n  all: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: all, "
         "between: [all, all], " +
         law + "}\n" + more;
}

std::string flow_of(const std::string& law) {
  return R"(scree: 1
seed: 5
cell: {low: [0, 0, -0.01], high: [0.1, 0.1, 0.4], periodic: [x, y]}
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  sand: {generator: random, box: [[0, 0, 0], [0.1, 0.1, 0.12]], radius: [3 mm, 4.5 mm], count: 1200, density: 2600,
         velocity: [0.3, 0, -1]}
contacts:
  - {name: grains, between: [sand, sand], )" +
         law + R"(, fric: 0.4}
  - {name: ground, between: [sand, floor], model: linear, kn: 4e5, ks: 2e5, fric: 0.5, dp_nratio: 0.3}
processes:
  pull: {process: gravity, acceleration: [3.4, 0, -9.2]}
stages:
  - flow: [cycle: 1000]
)";
}

/// Chute in units of ball diameter, mass and gravity; all of it at the automatic step.
const std::string chute = R"(scree: 1
seed: 8
cell: {low: [0, 0, -2], high: [8, 6, 80], periodic: [x, y]}
balls:
  bed: {generator: lattice, kind: sc, radius: 0.5, box: [[0, 0, -1], [8, 6, 0]], density: 1.909859317102744}
  flow: {generator: random, box: [[0, 0, 0], [8, 6, 40]], radius: 0.5, count: 1100, density: 1.909859317102744,
         velocity: [6, 0, -2]}
contacts:
  - {name: bed, between: [bed, bed], model: none}
  - {name: grains, between: [[bed, flow], [flow, flow]], model: linear, kn: 2e4, ks: 5714, fric: 0.5, dp_nratio: 0.2}
processes:
  pull: {process: gravity, acceleration: [0.46, 0, -0.89]}
quantities:
  speed: {mean: vx, over: flow}
)";

}  // namespace

TEST_CASE("step OK: the room round a ball allows no step that twelve neighbours do not") {
  // Critical step by finite differences of forces, see networks.hpp.
  std::string said;
  for (const std::string law :
       {"model: linear, kn: 1e6, ks: 0, fric: 0", "model: linear, kn: 1e6, ks: 5e5, fric: 1e9",
        "model: linear, kn: 1e6, ks: 1e6, fric: 1e9", "model: linear, emod: 1e8, kratio: 2, fric: 1e9",
        "model: hertz_mindlin, shear: 1e9, poiss: 0.2, fric: 1e9, dp_nratio: 0"}) {
    lab::Lab here;
    const auto simulation = here.make(scene_of(law), cluster(0.01));
    const Crowd crowd = crowd_of(*simulation, 1.5 * networks::overlap);
    REQUIRE(crowd.unknown().empty());
    const double allowed = crowd.bound().step, limit = networks::true_limit(*simulation, 1e-3 * allowed);
    INFO(law << ": allowed " << allowed << " s, critical " << limit << " s");
    CHECK(allowed < limit);
    CHECK(allowed > 0.6 * limit);
    said += lab::number(allowed / limit) + " ";
  }
  lab::measured("step, crowd", "room round a ball over the critical step of one among twelve: " + said);
}

TEST_CASE("step OK: the room round balls that touch a wall allows no step that wall and neighbours do not") {
  lab::Lab here;
  const double r = 0.01, low = 2 * r * (1 - 0.5 * networks::overlap) / std::sqrt(2.0) + r * (1 - networks::overlap);
  std::string floor(60, ' ');
  floor.resize(static_cast<std::size_t>(std::snprintf(floor.data(), floor.size(), "%.17g", -low)));
  const auto simulation = here.make(
      scene_of(
          "model: linear, kn: 1e6, ks: 5e5, fric: 1e9",
          "  - {name: ground, between: [all, floor], model: linear, kn: 2e7, ks: 2e7, fric: 1e9}\nwalls:\n  floor: "
          "{wall: plane, point: [0, 0, " +
              floor + "], normal: [0, 0, 1]}\n"),
      cluster(r));
  Engine& engine = simulation->engine;
  const Crowd crowd = crowd_of(*simulation, 1.5 * networks::overlap);
  engine.forces();
  const Links touching = wall_links(engine.contacts, engine.balls, engine.walls, engine.cell, {}, engine.team);
  REQUIRE(touching.links.size() == 4);
  const StepBound bound = crowd_at_walls(crowd, touching.links, engine.balls, engine.walls);
  CHECK(bound.wall == "floor");
  CHECK(bound.step < crowd.bound().step);
  const Crowd damped = crowd_of(*simulation, 1.5 * networks::overlap, 0.7);
  CHECK(crowd_at_walls(damped, touching.links, engine.balls, engine.walls).step ==
        Approx(bound.step / std::sqrt(1.7)).epsilon(1e-9));
  const double limit = networks::true_limit(*simulation, 1e-3 * bound.step);
  CHECK(bound.step < limit);
  CHECK(bound.step > 0.6 * limit);
}

TEST_CASE("step OK: the room round each ball bounds the step at every moment of a flow") {
  std::string said;
  for (const std::string law :
       {"model: linear, kn: 2e5, ks: 1e5, dp_nratio: 0.2", "model: linear, emod: 4e7, kratio: 2, dp_nratio: 0.2",
        "model: hertz_mindlin, shear: 1e8, poiss: 0.2, dp_nratio: 0.2"}) {
    lab::Lab here;
    const auto simulation = here.make(flow_of(law));
    Engine& engine = simulation->engine;
    double low = 1, high = 0;
    for (int again = 0; again < 8; ++again) {
      lab::run(*simulation, 1500);
      Links all = gather_links(engine.contacts, engine.balls, engine.walls, engine.cell, {}, 0, engine.balls.size(),
                               engine.team);
      std::erase_if(all.links, [](const Link& link) { return link.row[1] == no_row; });
      if (all.links.size() < 600) continue;
      const Crowd crowd = crowd_of(*simulation, engine.largest_overlap());
      REQUIRE(crowd.unknown().empty());
      const double share = crowd.bound().step / networks::limit_by_powers(engine.balls, all);
      low = std::min(low, share);
      high = std::max(high, share);
    }
    INFO(law);
    CHECK(high < 1);
    CHECK(high > 0.25);
    said += lab::number(low) + " to " + lab::number(high) + "; ";
  }
  lab::measured("step, crowd in a flow", "over the critical step of 1200 balls at eight moments: " + said);
}

TEST_CASE("step OK: what balls could do in a crowd is not said where it is not known") {
  const auto why = [](const std::string& scene, double depth = 0.01) {
    lab::Lab here;
    const auto simulation = here.make(scene, cluster(0.01));
    return crowd_of(*simulation, depth).unknown();
  };
  const std::string springs = "model: linear, kn: 1e6, ks: 5e5, fric: 1";
  CHECK(why(scene_of(springs)).empty());
  CHECK_THAT(why(scene_of("model: linear, kn: {weibull: {scale: 1e6, shape: 3}}, ks: 5e5, fric: 1")),
             Catch::Contains("differ from contact to contact"));
  CHECK_THAT(why(scene_of("model: none")), Catch::Contains("no ball that moves can touch another"));
  CHECK_THAT(why("scree: 1\nballs:\n  all: {generator: file, path: balls.csv, density: 2500}\n  one: {generator: "
                 "lattice, kind: sc, radius: 10 mm, box: [[-10 mm, -10 mm, 40 mm], [10 mm, 10 mm, 60 mm]], density: "
                 "2500}\ncontacts:\n  - {name: in, between: [all, all], model: none}\n  - {name: out, between: [all, "
                 "one], " +
                 springs + "}\n  - {name: own, between: [one, one], model: none}\n"),
             Catch::Contains("may overlap others without a force"));
  CHECK_THAT(why(scene_of(springs), 3), Catch::Contains("so deep an overlap"));
  std::string many = "scree: 1\nballs:\n";
  for (int k = 0; k < 65; ++k)
    many += "  g" + std::to_string(k) + ": {generator: lattice, kind: sc, radius: 10 mm, box: [[0, 0, " +
            std::to_string(20 * k) + " mm], [20 mm, 20 mm, " + std::to_string(20 * k + 20) + " mm]], density: 2500}\n";
  CHECK_THAT(why(many + "contacts:\n  - {name: all, between: [balls, balls], " + springs + "}\n"),
             Catch::Contains("too many groups"));
}

TEST_CASE("step OK: a fast flow takes the step that the room round each ball allows, and flows as with a fine one") {
  lab::Lab here;
  double speed[2], kinetic[2];
  uint64_t cycles[2], crowded = 0;
  for (const bool fine : {false, true}) {
    const auto simulation =
        here.make(chute + (fine ? "timestep: 2e-4\n" : "") + "stages:\n  - go: [fix: {balls: bed}]\n");
    Engine& engine = simulation->engine;
    simulation->edit(simulation->scene.stages[0].actions[0]);
    simulation->prepare();
    while (engine.clock.time() < 4) {
      engine.advance();
      if (!fine && engine.step.bound().term == "crowd") ++crowded;
    }
    engine.forces();
    kinetic[fine] = engine.observe().kinetic;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t row = 0; row < engine.balls.size(); ++row)
      if (engine.balls[Column::inverse_mass][row] > 0) {
        sum += engine.balls[Column::vx][row];
        ++count;
      }
    speed[fine] = sum / static_cast<double>(count);
    cycles[fine] = engine.clock.cycle;
  }
  INFO(crowded << " of " << cycles[0] << " cycles");
  CHECK(crowded > cycles[0] / 4);
  CHECK(speed[0] == Approx(speed[1]).epsilon(0.03));
  CHECK(kinetic[0] == Approx(kinetic[1]).epsilon(0.05));
  lab::measured("step, crowd of a chute", std::to_string(crowded) + " of " + std::to_string(cycles[0]) +
                                              " cycles; speed " + lab::number(speed[0] / speed[1]) + ", energy " +
                                              lab::number(kinetic[0] / kinetic[1]) + " of those of " +
                                              std::to_string(cycles[1]) + " cycles");
}
