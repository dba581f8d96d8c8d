#include <algorithm>
#include <array>
#include <cmath>

#include "core/cycle/engine.hpp"
#include "core/cycle/impact_share.hpp"

// When the lists are made anew.

namespace scree::core {

namespace {
double norm(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
}  // namespace

void Engine::rebuild() {
  contacts.rebuild(balls, walls, cell, skin_.width(), team);
  check_count();
  const std::size_t n = balls.size();
  for (int axis = 0; axis < 3; ++axis) {
    const double* from = balls[static_cast<Column>(static_cast<int>(Column::x) + axis)];
    double* to = balls[static_cast<Column>(static_cast<int>(Column::reference_x) + axis)];
    if (n > 0) std::copy(from, from + n, to);
  }
  extent_ = 0;
  for (const Wall& wall : walls) {
    if (norm(wall.spin) == 0) continue;
    for (std::size_t row = 0; row < n; ++row)
      extent_ = std::max(extent_, norm({balls[Column::x][row] - wall.centre[0], balls[Column::y][row] - wall.centre[1],
                                        balls[Column::z][row] - wall.centre[2]}) +
                                      largest_radius_ + skin_.width());
  }
  ball_travel_ = wall_travel_ = 0;
  skin_.renewed(clock.cycle);
  ++rebuilds_;
  choose_step();
}

double Engine::exact_travel() {
  const std::size_t n = balls.size(), part = 8192, parts = (n + part - 1) / part;
  const double *x = balls[Column::x], *y = balls[Column::y], *z = balls[Column::z];
  const double *a = balls[Column::reference_x], *b = balls[Column::reference_y], *c = balls[Column::reference_z];
  std::vector<double> most(parts, 0);
  team.each_block(parts, [&](std::size_t p) {
    double square = 0;
    for (std::size_t row = p * part; row < std::min(n, (p + 1) * part); ++row) {
      const double dx = x[row] - a[row], dy = y[row] - b[row], dz = z[row] - c[row];
      const double now = dx * dx + dy * dy + dz * dz;
      square = now > square ? now : square;
    }
    most[p] = square;
  });
  double square = 0;
  for (double value : most) square = std::max(square, value);
  return std::sqrt(square);
}

void Engine::detect() {
  if (!contacts.built()) return rebuild();
  // Where pieces may come so far in the coming cycle that a contact would be born deep, they must be listed when its
  // step is chosen: lists are then rebuilt a cycle ahead.
  double balls_come = 0, walls_come = 0;
  // After an edit what the last motion saw is out of date.
  for (const MotionResult& result : motion_) balls_come = std::max(balls_come, result.fastest);
  if (motion_.empty() || clock.dt_back == 0) balls_come = fastest_ball();
  balls_come *= clock.dt;
  for (const Wall& wall : walls) walls_come = std::max(walls_come, wall.travel(clock.dt, extent_));
  const bool far = step.automatic() && balls_come + std::max(balls_come, walls_come) > birth_depth * least_radius_;
  if (!far) balls_come = walls_come = 0;
  const auto used_up = [&] {
    const double ball = ball_travel_ + balls_come, wall = wall_travel_ + walls_come;
    return ball + std::max(ball, wall) > skin_.width();
  };
  if (used_up()) {
    ball_travel_ = exact_travel();
    if (used_up()) {
      skin_.used_up(clock.cycle);
      return rebuild();
    }
  }
  if (step.automatic() && schedule_.due(clock.cycle)) choose_step();
}

}  // namespace scree::core
