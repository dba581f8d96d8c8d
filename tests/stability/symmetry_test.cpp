// Cases 58, 59 and 60: symmetries that the equations have, kept by the numbers.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/philox.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

std::string csv(const std::vector<std::array<double, 7>>& balls) {
  std::string text = "x,y,z,radius,vx,vy,vz\n";
  char line[240];
  for (const auto& b : balls) {
    std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", b[0], b[1], b[2], b[3], b[4], b[5],
                  b[6]);
    text += line;
  }
  return text;
}

std::string settling(double dashpot, double damping) {
  return R"(scree: 1
walls:
  left: {wall: plane, point: [-0.1, 0, 0], normal: [1, 0, 0]}
  right: {wall: plane, point: [0.1, 0, 0], normal: [-1, 0, 0]}
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 1, 0]}
balls:
  discs: {generator: file, path: balls.csv, density: 2500}
contacts:
  - {name: all, between: [balls, [balls, walls]], model: linear, kn: 1e5, ks: 5e4, fric: 0.5, dp_nratio: )" +
         lab::number(dashpot) + R"(}
processes:
  pull: {process: gravity, acceleration: [0, -9.81, 0]}
  damping: {process: local_damping, factor: )" +
         lab::number(damping) + R"(}
stages:
  - fall: [cycle: 10000]
)";
}

/// Rows of four jittered balls on one side of x = 0, and on the other side their mirror images, or nearly so.
std::vector<std::array<double, 7>> heap(uint64_t rows, double speed, bool mirrored) {
  std::vector<std::array<double, 7>> balls;
  const Random random(58, "heap");
  for (uint64_t row = 0; row < rows; ++row)
    for (uint64_t column = 0; column < 4; ++column) {
      const auto jitter = [&](uint64_t k) { return 2e-3 * (random.uniform(row * 4 + column, k) - 0.5); };
      const double x = 0.012 + 0.022 * static_cast<double>(column) + 0.011 * static_cast<double>(row % 2) + jitter(0);
      const double y = 0.012 + 0.022 * static_cast<double>(row) + jitter(1);
      const double radius = 0.009 + 0.5 * jitter(2), vx = speed * (jitter(3) / 1e-3 - 1), vy = speed * jitter(4) / 1e-3;
      balls.push_back({x, y, 0, radius, vx, vy, 0});
      balls.push_back({mirrored ? -x : -x + 2e-4, y, 0, radius, mirrored ? -vx : vx, vy, 0});
    }
  return balls;
}

}  // namespace

TEST_CASE("58 OK: a flat packing stays flat, bit for bit") {
  lab::Lab here;
  write_text(here.folder() / "balls.csv", csv(heap(8, 0.2, false)));
  const auto simulation = here.make(settling(0.1, 0));
  const Balls& balls = simulation->engine.balls;
  uint64_t touching = 0;
  double out = 0;
  for (int part = 0; part < 100; ++part) {
    lab::run(*simulation, 100);
    touching = std::max(touching, simulation->engine.contacts.active());
    // Everything that could leave the plane z = 0: z, vz, and spins about x and y.
    for (std::size_t row = 0; row < balls.size(); ++row)
      for (const Column c : {Column::z, Column::vz, Column::wx, Column::wy})
        out = std::max(out, std::fabs(balls[c][row]));
  }
  CHECK(touching > 40);
  CHECK(out == 0);
  double spin = 0;
  for (std::size_t row = 0; row < balls.size(); ++row) spin = std::max(spin, std::fabs(balls[Column::wz][row]));
  CHECK(spin > 1e-6);
  lab::measured("58", "64 balls, 10 000 cycles: largest |z|, |vz|, |wx|, |wy| = " + lab::number(out));
}

TEST_CASE("59 OK: a mirror-symmetric scene stays symmetric") {
  lab::Lab here;
  write_text(here.folder() / "balls.csv", csv(heap(1, 0.8, true)));
  // Every collision multiplies rounding about fivefold, and every pile that may buckle does so for ever: one row,
  // thrown against its mirror image on the floor, is a scene that is stable itself.
  const auto simulation = here.make(settling(0.7, 0));
  double worst = 0, meeting = 0;
  for (int part = 0; part < 1000; ++part) {
    lab::run(*simulation, 10);
    for (uint64_t id = 1; id < 8; id += 2) {
      const double radius = lab::at(*simulation, Column::radius, id);
      const double across = lab::at(*simulation, Column::x, id) + lab::at(*simulation, Column::x, id + 1);
      const double along = lab::at(*simulation, Column::y, id) - lab::at(*simulation, Column::y, id + 1);
      worst = std::max({worst, std::fabs(across) / radius, std::fabs(along) / radius});
      if (lab::at(*simulation, Column::x, id) < radius) ++meeting;
    }
  }
  // Mirrored balls do push each other across the plane.
  CHECK(meeting > 2);
  CHECK(worst <= 1e-12);
  lab::measured("59", "8 balls, 10 000 cycles: largest asymmetry " + lab::number(worst) + " R");
}

TEST_CASE("60 OK: an elastic motion run backwards returns to where it came from") {
  lab::Lab here;
  const auto simulation = here.make(R"(scree: 1
seed: 60
timestep: 1e-6
walls:
  room: {wall: box, low: [0, 0, 0], high: [0.05, 0.05, 0.05]}
balls:
  gas: {generator: random, box: [[0, 0, 0], [0.05, 0.05, 0.05]], radius: [3 mm, 4 mm], count: 100, density: 2500}
contacts:
  - {name: all, between: [balls, [balls, walls]], model: linear, kn: 1e5, ks: 0}
stages:
  - fly: [cycle: 1000]
)");
  Engine& engine = simulation->engine;
  Balls& balls = engine.balls;
  const Random random(60, "speeds");
  for (std::size_t row = 0; row < balls.size(); ++row)
    for (std::size_t c = 0; c < 3; ++c)
      balls[static_cast<Column>(static_cast<std::size_t>(Column::vx) + c)][row] =
          4 * (random.uniform(balls.id()[row], c) - 0.5);
  std::map<uint64_t, std::array<double, 6>> first;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    auto& now = first[balls.id()[row]];
    for (std::size_t c = 0; c < 3; ++c) {
      now[c] = balls[static_cast<Column>(static_cast<std::size_t>(Column::x) + c)][row];
      now[3 + c] = balls[static_cast<Column>(static_cast<std::size_t>(Column::vx) + c)][row];
    }
  }
  const auto turn_back = [&] {
    engine.synchronize();
    for (std::size_t row = 0; row < balls.size(); ++row)
      for (const Column c : {Column::vx, Column::vy, Column::vz}) balls[c][row] = -balls[c][row];
  };
  uint64_t touching = 0;
  for (int part = 0; part < 100; ++part) {
    lab::run(*simulation, 10);
    touching += engine.contacts.active();
  }
  CHECK(touching > 200);
  double moved = 0;
  for (std::size_t row = 0; row < balls.size(); ++row)
    moved = std::max(moved, std::fabs(balls[Column::x][row] - first[balls.id()[row]][0]));
  CHECK(moved > 1e-3);
  turn_back();
  lab::run(*simulation, 1000);
  turn_back();
  double place = 0, speed = 0;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    const auto& was = first[balls.id()[row]];
    for (std::size_t c = 0; c < 3; ++c) {
      place =
          std::max(place, std::fabs(balls[static_cast<Column>(static_cast<std::size_t>(Column::x) + c)][row] - was[c]) /
                              balls[Column::radius][row]);
      speed = std::max(
          speed, std::fabs(balls[static_cast<Column>(static_cast<std::size_t>(Column::vx) + c)][row] - was[3 + c]) / 2);
    }
  }
  CHECK(place <= 1e-9);
  CHECK(speed <= 1e-9);
  lab::measured("60", "1000 cycles there and back: position " + lab::number(place) + " R, velocity " +
                          lab::number(speed) + " of the largest");
}
