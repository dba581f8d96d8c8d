#include "core/contact/diagonal_rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/contact/links.hpp"

namespace scree::core {

DiagonalRule diagonal_rule(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                           const PeriodicCell& cell, Team& team) {
  if (!contacts.built()) return {};
  const Links now = gather_links(contacts, balls, walls, cell, LinkQuery(), 0, balls.size(), team);
  std::vector<std::array<double, 6>> sums(balls.size());
  for (const Link& link : now.links)
    for (int end = 0; end < 2; ++end) {
      if (link.row[end] == no_row) continue;
      std::array<double, 6>& sum = sums[link.row[end]];
      const double turn = link.arm[end] * link.arm[end] * link.ks + link.kb;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = link.normal[axis] * link.normal[axis], across = 1 - along;
        sum[axis] += link.kn * along + link.ks * across;
        sum[3 + axis] += turn * across + link.kt * along;
      }
    }
  double square = std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < sums.size(); ++row) {
    if (balls[Column::inverse_mass][row] == 0) continue;
    const double mass = balls[Column::mass][row], radius = balls[Column::radius][row];
    for (std::size_t k = 0; k < 6; ++k)
      if (sums[row][k] > 0) square = std::min(square, (k < 3 ? mass : 0.4 * mass * radius * radius) / sums[row][k]);
  }
  return {std::isfinite(square) ? std::sqrt(square) : 0, now.dashpots};
}

}  // namespace scree::core
