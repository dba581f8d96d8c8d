// Cases 11, 31, 37, D40, D43: long chains, and bonds of no width or too much of it.
#include <algorithm>
#include <cmath>

#include "core/base/philox.hpp"
#include "core/run/sanity.hpp"
#include "stability/bonded_scene.hpp"
#include "stability/lab.hpp"
#include "support/program.hpp"

using namespace bonded;
using namespace support;
using scree::core::Column;

namespace {

const std::string endless_spring = "model: contact_bond, kn: 1e6, ks: 0, " + bonded::endless;

}  // namespace

TEST_CASE("31 OK: a column of 1000 balls carries its weight, level by level") {
  // Each contact is pressed by what lies above it from the start; any error would set the column moving.
  const int n = 1000;
  const double weight = mass * 9.81, k = 1e8;
  std::string balls = "x,y,z,radius\n";
  double z = 0.01 - n * weight / k;
  for (int level = 0; level < n; ++level) {
    balls += "0,0," + digits(z) + ",0.01\n";
    z += 0.02 - (n - 1 - level) * weight / k;
  }
  SceneRun run(
      "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nballs:\n  column: {generator: "
      "file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: all, between: [column, [column, floor]], model: "
      "linear, kn: 1e8, ks: 0}\nprocesses:\n  pull: {process: gravity, acceleration: [0, 0, -9.81]}\n  slow: "
      "{process: local_damping, factor: 0.5}\n",
      balls);
  run.step(3000);
  double worst = 0;
  for (int level = 1; level < n; level += 37) {
    const double force =
        run.value("contacts." + std::to_string(level) + "." + std::to_string(level + 1) + ".normal_force");
    worst = std::max(worst, std::abs(force / ((n - level) * weight) - 1));
  }
  CHECK(worst < 1e-3);
  CHECK(-run.value("walls.floor.force.z") == Approx(n * weight).epsilon(1e-3));
  lab::measured("31, rest", "forces of 28 levels within " + lab::number(worst) + " of the weight above");
}

TEST_CASE("31 OK: a wave runs along a row with d sqrt(k/m)") {
  // A smooth hump of speed, 25 balls wide, splits in two; when do balls 350 and 850 meet the one that goes right?
  std::string balls = "x,y,z,radius,vx,vy,vz\n";
  for (int k = 0; k < 1000; ++k)
    balls += digits(0.02 * k) + ",0,0,0.01," + digits(1e-3 * std::exp(-0.5 * std::pow((k - 200) / 25.0, 2))) + ",0,0\n";
  SceneRun run(chain(endless_spring), balls);
  edit(run);
  const auto& all = run.engine().balls;
  std::size_t row[2] = {lab::row_of(run.simulation(), 351), lab::row_of(run.simulation(), 851)};
  double peak[2] = {0, 0}, when[2] = {0, 0}, last[2] = {0, 0}, older[2] = {0, 0};
  const double pace = std::sqrt(kn / mass);
  while (run.time() < 800 / pace) {
    run.step();
    for (int s = 0; s < 2; ++s) {
      const double v = all[Column::vx][row[s]], dt = run.engine().clock.dt;
      if (last[s] > peak[s] && last[s] >= v) {
        peak[s] = last[s];
        // Parabola through three values.
        when[s] = run.time() - dt - dt * 0.5 * (v - older[s]) / (v - 2 * last[s] + older[s]);
      }
      older[s] = last[s];
      last[s] = v;
    }
  }
  const double speed = 500 / (when[1] - when[0]) / pace;
  CHECK(speed == Approx(1).margin(0.005));
  CHECK(peak[0] == Approx(0.5e-3).epsilon(0.02));
  lab::measured("31, wave", "speed over d sqrt(k/m): " + digits(std::round(speed * 1e5) / 1e5));
}

TEST_CASE("D40 OK: a chain of 1000 bonded balls is stable, and stretches as it should") {
  // Pulled at its free end by 1 N: n/k more length; the moduli of its bonds are in series.
  std::string balls = "x,y,z,radius,group\n";
  for (int k = 0; k < 1000; ++k)
    balls += digits(0.02 * k) + ",0,0,0.01," + (k == 0 ? "root" : k == 999 ? "tip" : "mid") + "\n";
  const double stretch = 999.0 / kn;
  SceneRun run(
      chain("model: parallel_bond, kn: 0, ks: 0, fric: 0, pb_ten: .inf, pb_coh: .inf, pb_kn: " + digits(kn / area) +
                ", pb_ks: " + digits(kn / area / 2.5),
            "    - fix: {balls: chain.root, velocity: [x, y, z], spin: [x, y, z]}\n    - apply: {balls: chain.tip, "
            "force: [1, 0, 0]}\n"),
      balls);
  edit(run);
  CHECK(run.engine().contacts.bonded() == 999);
  const double straight = 0.02 * 999;
  // Undamped, the tip of a rod under a sudden load swings between nothing and twice its rest, with period 4 n/w0.
  const double quarter = 1000 / std::sqrt(kn / mass);
  double most = 0;
  while (run.time() < 4.2 * quarter) {
    run.step(20);
    most = std::max(most, run.engine().balls[Column::x][lab::row_of(run.simulation(), 1000)] - straight);
  }
  CHECK(most == Approx(2 * stretch).epsilon(0.03));
  double aside = 0;
  for (std::size_t r = 0; r < 1000; ++r) aside = std::max(aside, std::abs(run.engine().balls[Column::y][r]));
  CHECK(aside == 0);
  lab::measured("D40", "largest stretch under a sudden load " + lab::number(most / stretch) +
                           " times that at rest (2 by theory), exactly straight");
}

TEST_CASE("11 OK: slender and stout bonds alone, a hundredth to ten times as wide as long, stay bounded") {
  // Ten balls that move and spin at random; nothing but bonds holds them. A bond is 2 R long.
  std::string balls = "x,y,z,radius,vx,vy,vz,wx,wy,wz\n";
  const scree::core::Random random(11, "chain");
  for (uint64_t k = 0; k < 10; ++k) {
    balls += digits(0.02 * static_cast<double>(k)) + ",0,0,0.01";
    for (uint64_t c = 0; c < 6; ++c) balls += "," + digits((c < 3 ? 1e-3 : 0.1) * (random.uniform(k, c) - 0.5));
    balls += "\n";
  }
  double worst = 0;
  for (const double width : {0.02, 0.2, 1.0, 5.0, 20.0}) {
    INFO("pb_rmul " << width);
    SceneRun run(
        chain("model: parallel_bond, kn: 0, ks: 0, fric: 0, pb_emod: 1e8, pb_kratio: 2.5, pb_ten: .inf, pb_coh: .inf, "
              "pb_rmul: " +
              digits(width)) +
            "processes:\n  energy: {process: energy_ledger}\n",
        balls);
    edit(run);
    const double start = run.value("energy.kinetic");
    run.step(10000);
    const double now = run.value("energy.kinetic") + run.value("energy.bond"),
                 residual = run.value("energy.residual_share");
    CHECK(now < 6 * start);  // at 0.9 of the limit the sum at one time swings by a factor of five
    CHECK(residual < 1e-2);
    worst = std::max(worst, residual);
  }
  lab::measured("11", "residual of the energy at most " + lab::number(worst) + " after 1e4 cycles");
}

TEST_CASE("37 D43 OK, WARN, REJECT: bonds a millionth and ten times as wide as the balls, and of no width") {
  const std::string balls = "x,y,z,radius,group\n0,0,0,0.01,a\n0.02,0,0,0.01,b\n";
  const auto scene = [](const std::string& width) {
    return chain(
        "model: parallel_bond, kn: 1e5, ks: 1e5, fric: 0.5, pb_emod: 1e9, pb_kratio: 2.5, pb_ten: .inf, pb_coh: "
        ".inf, pb_rmul: " +
            width,
        "    - apply: {balls: chain.b, force: [1e-6, 1e-6, 0]}\n");
  };
  for (const std::string width : {"1e-6", "1", "10"}) {
    INFO("pb_rmul " << width);
    SceneRun run(scene(width), balls);
    const auto said = doubts(run.simulation());
    CHECK(said.size() == (width == "10" ? 1 : 0));
    if (!said.empty()) CHECK_THAT(said[0], Catch::Contains("10 times as wide as the smaller ball"));
    edit(run);
    const double step = run.engine().clock.dt;
    run.step(2000);
    CHECK(run.engine().contacts.bonded() == 1);
    for (std::size_t row = 0; row < 2; ++row)
      for (const Column c : {Column::x, Column::y, Column::wz}) CHECK(std::isfinite(run.engine().balls[c][row]));
    const BallState b = run.ball(2);
    CHECK(std::abs(b.velocity[0]) < 1e-3);
    CHECK(step > 0);
  }
  const TemporaryFolder folder;
  write_text(folder / "balls.csv", balls);
  for (const std::string width : {"0", "-1", ".nan"}) {
    write_text(folder / "thin.yaml", scene(width));
    const ProgramEnd end = support::scree({"check", "thin.yaml"}, folder.path());
    CHECK(end.code == 3);
    CHECK_THAT(end.out + end.err, Catch::Contains("pb_rmul"));
  }
  lab::measured("37, D43", "1e-6 and 1: bounded; 10: bounded, with a warning; 0: exit 3");
}
