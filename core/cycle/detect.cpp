#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

// How far balls and walls may come in the coming cycle, m, where that is so far that a contact could be born deep: what
// they meet must then be listed when the step is chosen, so lists are made a cycle ahead. A user's step is not chosen.
std::pair<double, double> Engine::coming() const {
  if (!step.automatic()) return {0, 0};
  double balls_come = 0, walls_come = 0;
  for (const MotionResult& result : motion_) balls_come = std::max(balls_come, result.fastest);
  // After an edit what the last motion saw is out of date.
  if (motion_.empty() || clock.dt_back == 0) balls_come = fastest_ball();
  balls_come *= clock.dt;
  for (const Wall& wall : walls) walls_come = std::max(walls_come, wall.travel(clock.dt, extent_));
  if (balls_come + std::max(balls_come, walls_come) <= birth_depth * least_radius_) return {0, 0};
  return {balls_come, walls_come};
}

void Engine::detect() {
  if (!contacts.built()) return rebuild();
  const auto [balls_come, walls_come] = coming();
  const auto used_up = [&, ball = balls_come, wall = walls_come] {
    return ball_travel_ + ball + std::max(ball_travel_ + ball, wall_travel_ + wall) > skin_.width();
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
