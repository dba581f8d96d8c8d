// A small ball between two large ones: tangential increments pair the positions of one time with the velocity of half a
// step before, which for large size ratios could slide wrongly and trap the grain (Vyas et al., Comput. Phys. Commun.
// 310 (2025) 109524).
#include <cmath>
#include <numbers>
#include <vector>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;

namespace {

constexpr double small = 1e-3, closing = 0.02, duration = 0.02;

/// The small ball lies 40 degrees above the line of the large ones, which come together at 2 * closing; the large ones
/// do not feel each other. 40 degrees is more than the friction angle, so it must come out.
std::string balls(double ratio) {
  const double large = ratio * small, angle = 40 * std::numbers::pi / 180, reach = large + small;
  const double half = reach * std::cos(angle), height = reach * std::sin(angle);
  return "x,y,z,radius,vx,vy,vz,group\n0,0," + digits(height) + "," + digits(small) + ",0,0,0,small\n" + digits(-half) +
         ",0,0," + digits(large) + "," + digits(closing) + ",0,0,large\n" + digits(half) + ",0,0," + digits(large) +
         "," + digits(-closing) + ",0,0,large\n";
}

std::string scene(const std::string& step) {
  return "scree: 1\n" + step + R"(
balls:
  b: {generator: file, path: balls.csv, density: 2500}
contacts:
  - {between: [b.large, b.large], model: none}
  - {between: [balls, balls], model: linear, kn: 1e5, ks: 5e4, fric: 0.5, dp_nratio: 0.2}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
stages:
  - hold: [fix: {balls: b.large}]
)";
}

struct Path {
  std::vector<double> x, z;
  double step = 0, overlap = 0;
};

/// Where the small ball is, twenty times along the way.
Path path(double ratio, double step) {
  SceneRun run(scene(step > 0 ? "timestep: " + digits(step) : ""), balls(ratio));
  run.engine().sums_wanted = run.engine().report_wanted = false;
  run.simulation().edit(run.simulation().scene.stages[0].actions[0]);
  run.engine().forces();
  Path out;
  out.step = run.engine().clock.dt;
  for (int part = 1; part <= 20; ++part) {
    while (run.time() < duration * part / 20 - 0.5 * run.engine().clock.dt) run.step();
    const BallState ball = run.ball(1);
    // To the same time: between two cycles the ball moves evenly.
    const double late = duration * part / 20 - run.time();
    out.x.push_back(ball.position[0] + late * ball.velocity[0]);
    out.z.push_back(ball.position[2] + late * ball.velocity[2]);
    out.overlap = std::max(out.overlap, run.value("overlap.max"));
  }
  return out;
}

}  // namespace

TEST_CASE("A4: a small ball squeezed out between two large ones takes the same path at any step") {
  Measure measure("A4", "the same scene at a hundredth of the step (Vyas et al. 2025 ask for it)");
  for (const double ratio : {1.0, 10.0, 100.0}) {
    const Path coarse = path(ratio, 0), fine = path(ratio, coarse.step / 100), half = path(ratio, coarse.step / 2);
    const double way = fine.z.back() - (ratio * small + small) * std::sin(40 * std::numbers::pi / 180);
    CHECK(way > 0.5 * closing * duration);  // it comes out, and is not trapped
    const auto apart = [&](const Path& one) {
      double most = 0;
      for (std::size_t k = 0; k < fine.z.size(); ++k)
        most = std::max(most, std::hypot(one.x[k] - fine.x[k], one.z[k] - fine.z[k]));
      return most / way;
    };
    const std::string name = " at size ratio " + digits(ratio);
    measure.check("distance from the fine path over its length, automatic step" + name, apart(coarse), 0, 0.01);
    measure.check("the same at half the automatic step" + name, apart(half), 0, 0.01);
    CHECK(coarse.overlap < 0.05);
  }
}
