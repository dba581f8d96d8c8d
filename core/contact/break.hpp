#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>

#include "core/contact/bond_table.hpp"

namespace scree::core {

constexpr uint16_t no_wall_index = std::numeric_limits<uint16_t>::max();

/// A ball at a smooth piece of a wall: what a bond with a wall joins.
struct WallSpot {
  uint64_t id = 0;
  uint16_t wall = no_wall_index;  ///< index
  uint32_t patch = 0;
  auto operator<=>(const WallSpot&) const = default;
};
/// How often the bond of a ball with a patch has broken; those that never broke are not in it.
using WallBreakHistory = std::map<WallSpot, uint32_t>;

/// A bond that broke in the last pass.
struct Break {
  IdPair ids;  ///< the second is 0 for a wall
  uint16_t rule = 0;
  uint8_t mode = 0;               ///< 1 tension, 2 shear
  std::array<double, 3> point{};  ///< where the pieces meet, m
  double energy = 0;              ///< that the bond held, J; 0 where the law says nothing of energy
  uint16_t wall = no_wall_index;  ///< index; no_wall_index for two balls
  uint32_t patch = 0;
};

/// How many bonds a ball had with a patch before the one that it has, or, without one, had last.
inline uint64_t bondings(const WallBreakHistory& history, const WallSpot& spot, bool bonded) {
  if (history.empty()) return 0;
  const auto found = history.find(spot);
  return found == history.end() ? 0 : found->second - (bonded ? 0u : 1u);
}

}  // namespace scree::core
