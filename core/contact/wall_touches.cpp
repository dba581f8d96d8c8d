#include "core/contact/wall_touches.hpp"

#include <algorithm>

namespace scree::core {

void WallTouches::resize(std::size_t touches) {
  ball.resize(touches);
  patch.resize(touches);
  for (auto* column : {&nx, &ny, &nz, &distance}) column->resize(touches);
}

// Grows the columns until all touches fit.
void WallTouches::ask(const Wall& wall, const std::vector<double>& reach) {
  const std::size_t rows = reach.size();
  if (ball.size() < rows + 64) resize(rows + 64);
  for (int again = 0;; ++again) {
    const scree_touches touches{sizeof(scree_touches),
                                static_cast<uint32_t>(ball.size()),
                                ball.data(),
                                patch.data(),
                                nx.data(),
                                ny.data(),
                                nz.data(),
                                distance.data()};
    count = wall.touch(static_cast<uint32_t>(rows), x_.data(), y_.data(), z_.data(), reach.data(), touches);
    if (count <= ball.size()) return;
    if (again > 0) wall.refuse("gives more touches each time it is asked for the same balls");
    resize(count);
  }
}

void WallTouches::find(const Wall& wall, const BallView& balls, const std::vector<uint32_t>& rows, double radii,
                       double margin) {
  reach_.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) reach_[k] = radii * balls.radius[rows[k]] + margin;
  find(wall, balls, rows, reach_);
}

void WallTouches::find(const Wall& wall, const BallView& balls, const std::vector<uint32_t>& rows,
                       const std::vector<double>& reach) {
  const std::size_t n = rows.size();
  count = 0;
  order.clear();
  if (n == 0) return;
  for (auto* column : {&x_, &y_, &z_}) column->resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const uint32_t row = rows[k];
    const auto local = wall.to_frame({balls.x[row], balls.y[row], balls.z[row]});
    x_[k] = local[0];
    y_[k] = local[1];
    z_[k] = local[2];
  }
  ask(wall, reach);
  order.resize(count);
  for (uint32_t k = 0; k < count; ++k) order[k] = k;
  const auto before = [&](uint32_t a, uint32_t b) {
    return ball[a] != ball[b] ? ball[a] < ball[b] : patch[a] < patch[b];
  };
  if (!std::is_sorted(order.begin(), order.end(), before)) std::sort(order.begin(), order.end(), before);
  if (!wall.turned()) return;
  for (uint32_t k = 0; k < count; ++k) {
    const auto turned = wall.from_frame({nx[k], ny[k], nz[k]});
    nx[k] = turned[0];
    ny[k] = turned[1];
    nz[k] = turned[2];
  }
}

uint32_t WallTouches::add(const std::array<double, 3>& normal, double away) {
  if (nx.size() <= count) resize(2 * count + 8);
  nx[count] = normal[0];
  ny[count] = normal[1];
  nz[count] = normal[2];
  distance[count] = away;
  return count++;
}

}  // namespace scree::core
