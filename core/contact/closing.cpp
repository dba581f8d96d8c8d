#include "core/contact/closing.hpp"

#include <algorithm>
#include <cmath>

namespace scree::core {

namespace {

/// How much a ball moves beside a velocity common to all.
enum : uint8_t { cool = 0, warm = 1, hot = 2 };

/// Of a pair that closes fast one is hot, and the other is warm or hot: together they are as fast as that, and none is
/// faster than the fastest. Empty when there is no such pair.
std::vector<uint8_t> heat(const BallView& b, std::size_t n, double closing) {
  double middle[3];
  const double* speed[3] = {b.vx, b.vy, b.vz};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(speed[axis], speed[axis] + n);
    middle[axis] = 0.5 * (*low + *high);
  }
  const auto square = [&](std::size_t row) {
    const double x = b.vx[row] - middle[0], y = b.vy[row] - middle[1], z = b.vz[row] - middle[2];
    return x * x + y * y + z * z;
  };
  double most = 0;
  for (std::size_t row = 0; row < n; ++row) most = std::max(most, square(row));
  if (most < 0.25 * closing * closing) return {};
  const double hot_from = 0.25 * closing * closing, gap = std::max(0.0, closing - std::sqrt(most)),
               warm_from = gap * gap;
  std::vector<uint8_t> of(n);
  for (std::size_t row = 0; row < n; ++row) {
    const double own = square(row);
    of[row] = own < warm_from ? cool : own < hot_from ? warm : hot;
  }
  return of;
}

}  // namespace

StepBound soonest_closing(const Contacts& contacts, const Balls& balls, const PeriodicCell& cell, double depth,
                          double longest, Team& team) {
  const std::size_t n = balls.size();
  if (n == 0) return {};
  const BallView b(balls);
  const std::vector<uint8_t> of = heat(b, n, depth * *std::min_element(b.radius, b.radius + n) / longest * (1 - 1e-9));
  if (of.empty()) return {};
  const ImageShifts shifts(cell);
  struct First {
    double time;
    std::size_t row, other;
  };
  const std::size_t blocks = (n + block_rows - 1) / block_rows;
  std::vector<First> first(blocks, {longest, 0, 0});
  team.each_block(blocks, [&](std::size_t block) {
    First& soonest = first[block];
    const std::size_t end = std::min(n, (block + 1) * block_rows);
    for (const TouchList& list : contacts.lists()) {
      if (list.size() == 0 || list.bonded || contacts.book.rules[list.rule].model == nullptr) continue;
      for (std::size_t i = block * block_rows; i < end; ++i)
        for (uint64_t slot = list.begin[i]; slot < list.begin[i + 1]; ++slot) {
          const std::size_t j = list.other[slot];
          if (of[i] * of[j] < 2) continue;
          const double* shift = shifts.of[target::image(list.where[slot])];
          const double x = b.x[j] - b.x[i] + shift[0], y = b.y[j] - b.y[i] + shift[1], z = b.z[j] - b.z[i] + shift[2];
          const double along = x * (b.vx[j] - b.vx[i]) + y * (b.vy[j] - b.vy[i]) + z * (b.vz[j] - b.vz[i]);
          if (!(along < 0)) continue;
          const double time = depth * std::min(b.radius[i], b.radius[j]) * std::sqrt(x * x + y * y + z * z) / -along;
          if (time < soonest.time) soonest = {time, i, j};
        }
    }
  });
  const First* soonest = &first[0];
  for (const First& one : first)
    if (one.time < soonest->time) soonest = &one;
  if (!(soonest->time < longest)) return {};
  return {soonest->time, balls.id()[soonest->row], balls.id()[soonest->other], "", "kinematic", false};
}

}  // namespace scree::core
