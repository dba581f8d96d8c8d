#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/stages.hpp"
#include "core/world/wall.hpp"

namespace scree::core {

/// Where a wall is near a set of balls: one entry for each ball and patch, in the scene's frame. Keeps its memory from
/// one call to the next. [one thread]
class WallTouches {
 public:
  std::vector<uint32_t> ball;  ///< index into the rows that were asked for
  std::vector<uint32_t> patch;
  std::vector<double> nx, ny, nz, distance;  ///< unit normal from the ball to the wall; of the centre, m
  std::vector<uint32_t> order;               ///< indices of all touches, by ball and patch
  uint32_t count = 0;

  /// All touches nearer to the centres of `rows` than radii * radius + margin.
  void find(const Wall& wall, const BallView& balls, const std::vector<uint32_t>& rows, double radii, double margin);
  /// All touches nearer to the centre of each row than its reach, m.
  void find(const Wall& wall, const BallView& balls, const std::vector<uint32_t>& rows,
            const std::vector<double>& reach);
  /// Puts a touch behind those that were found, outside the order. Its index.
  uint32_t add(const std::array<double, 3>& normal, double away);

 private:
  void resize(std::size_t touches);
  void ask(const Wall& wall, const std::vector<double>& reach);
  std::vector<double> x_, y_, z_, reach_;
};

}  // namespace scree::core
