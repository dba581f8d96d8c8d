// A rule in moduli whose stiffness is the same for all contacts, until an edit brings a ball of another size.
#include "support/catch.hpp"
#include "support/scene_run.hpp"

using namespace support;

namespace {

// Two balls that overlap by 0.1 mm, the first in the floor by as much. They stand still for a cycle of no length worth
// mentioning, so that their forces follow from the stiffness alone.
struct Pair : SceneRun {
  explicit Pair(const std::string& edit)
      : SceneRun(
            "scree: 1\ntimestep: 1e-9\n"
            "walls: {floor: {wall: plane, point: [-0.0099, 0, 0], normal: [1, 0, 0]}}\n"
            "balls: {sand: {generator: file, path: balls.csv, density: 2500}}\n"
            "contacts:\n"
            "  - {name: grains, between: [balls, [balls, floor]], model: linear, emod: 1e8, kratio: 2, fric: 0.5}\n"
            "stages:\n  - edit: [" +
                edit + "]\n",
            "id,x,y,z,radius\n1,0,0,0,0.01\n2,0.0199,0,0,0.01\n") {}
};

const char* const larger =
    "add: {balls: {far: {generator: lattice, kind: sc, radius: 20 mm, spacing: 40 mm, density: 2500, "
    "box: [[1, 1, 1], [1.08, 1.08, 1.08]]}}}";

}  // namespace

TEST_CASE("contacts keep their stiffness when balls of another size make it vary, and when those go") {
  Pair run(std::string(larger) + ", delete: {balls: far}");
  // linear.md: kn = pi r^2 emod / L with the smaller radius and the distance of the centres, the radius at a wall.
  const double pair = 3.14159265358979 * 1e-4 * 1e8 / 0.02 * 1e-4, wall = 2 * pair;
  const auto check = [&] {
    CHECK(run.ball(2).force[0] == Approx(pair).epsilon(1e-4));
    CHECK(run.value("walls.floor.force.x") == Approx(-wall).epsilon(1e-4));
  };
  check();
  const auto& actions = run.simulation().scene.stages[0].actions;
  REQUIRE(actions.size() == 2);
  run.simulation().edit(actions[0]);
  run.step();
  REQUIRE(run.engine().balls.size() > 2);
  check();
  run.simulation().edit(actions[1]);
  run.step();
  REQUIRE(run.engine().balls.size() == 2);
  check();
}
