// Case 28: a whole scene in a turned frame. 60 balls in a box of planes with friction, dashpots, gravity and parallel
// bonds, of which some break: the 24 turns of the cube, and turns about axes and by angles drawn at random.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/philox.hpp"
#include "scenes/cloud.hpp"
#include "stability/lab.hpp"

using namespace support;

namespace {

constexpr double box = 0.1;       // m
constexpr uint64_t cycles = 300;  // 6 ms, in which a ball flies half its radius
constexpr double strength = 1e5;  // Pa: a hit of 1 m/s makes some 30 N on 3e-4 m2

struct End {
  std::vector<BallState> balls;
  double bonded = 0, broken = 0, sliding = 0, walls = 0;
};

End after(const Cloud& cloud) {
  SceneRun run(scene_of(cloud), balls_of(cloud));
  for (const auto& action : run.simulation().scene.stages.at(0).actions) run.simulation().edit(action);
  End end;
  for (uint64_t k = 0; k < cycles; k += 10) {
    run.step(10);
    end.sliding = std::max(end.sliding, run.value("contacts.sliding"));
    end.walls = std::max(end.walls, run.value("contacts.walls"));
  }
  end.bonded = run.value("bonds.count");
  end.broken = run.value("bonds.broken");
  end.balls = states(run);
  return end;
}

Cloud bonded_cloud() {
  Cloud cloud = random_cloud(28);
  cloud.bonds = strength;
  return cloud;
}

/// Largest distance of a ball from its place in the scene that was not turned, over the box; no bond may end otherwise.
double astray(const End& plain, const Matrix& turn) {
  const End other = after(turned(turn, 1, bonded_cloud()));
  CHECK(other.broken == plain.broken);
  double worst = 0;
  for (std::size_t k = 0; k < plain.balls.size(); ++k)
    worst = std::max(worst, distance(turned(turn, plain.balls[k].position), other.balls[k].position));
  return worst / box;
}

/// Of a unit quaternion with four normal components: every turn is as likely as any other (Marsaglia, 1972).
Matrix random_turn(uint64_t index) {
  const scree::core::Random random(28, "turns");
  double q[4], size = 0;
  for (uint64_t c = 0; c < 4; ++c) size += std::pow(q[c] = random.normal(index, c), 2);
  for (double& c : q) c /= std::sqrt(size);
  const auto [w, x, y, z] = q;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

}  // namespace

TEST_CASE("28 OK: a scene with friction, walls and bonds moves alike in 24 turned frames, and in 8 at random") {
  const End plain = after(bonded_cloud());
  CHECK(plain.bonded > 10);
  CHECK(plain.broken > 5);
  CHECK(plain.sliding > 3);
  CHECK(plain.walls > 10);
  double cube = 0, random = 0;
  for (const Matrix& turn : cube_symmetries(1)) cube = std::max(cube, astray(plain, turn));
  for (uint64_t k = 0; k < 8; ++k) random = std::max(random, astray(plain, random_turn(k)));
  CHECK(cube <= 1e-13);
  CHECK(random <= 1e-10);
  CHECK(random > 0);
  lab::measured("28", std::to_string(cycles) + " cycles, " + digits(plain.bonded) + " bonds held and " +
                          digits(plain.broken) + " broken: " + lab::number(cube) + " and " + lab::number(random) +
                          " of the box");
}
