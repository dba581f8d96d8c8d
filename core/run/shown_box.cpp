#include "core/run/shown_box.hpp"

#include <algorithm>

namespace scree::core {

void ShownBox::follow(const Engine& engine) {
  const Balls& balls = engine.balls;
  const PeriodicCell& cell = engine.cell;
  if (balls.size() == 0 && !cell.any()) return;
  std::array<double, 3> low{}, high{};
  double longest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double* at = balls[static_cast<Column>(static_cast<std::size_t>(Column::x) + c)];
    const double* radius = balls[Column::radius];
    bool any = cell.periodic[c];
    low[c] = any ? cell.low[c] : 0.0;
    high[c] = any ? cell.high[c] : 0.0;
    for (std::size_t row = 0; row < balls.size(); ++row) {
      low[c] = any ? std::min(low[c], at[row] - radius[row]) : at[row] - radius[row];
      high[c] = any ? std::max(high[c], at[row] + radius[row]) : at[row] + radius[row];
      any = true;
    }
    longest = std::max(longest, high[c] - low[c]);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (!seen_ || low[c] < low_[c]) low_[c] = low[c] - 0.1 * longest;
    if (!seen_ || high[c] > high_[c]) high_[c] = high[c] + 0.1 * longest;
  }
  seen_ = true;
}

std::vector<double> ShownBox::saved() const {
  if (!seen_) return {};
  return {low_[0], low_[1], low_[2], high_[0], high_[1], high_[2]};
}

void ShownBox::restore(const std::vector<double>& saved) {
  seen_ = saved.size() == 6;
  if (!seen_) return;
  std::copy_n(saved.begin(), 3, low_.begin());
  std::copy_n(saved.begin() + 3, 3, high_.begin());
}

}  // namespace scree::core
