#pragma once
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

 private:
  void resize(std::size_t touches);
  void ask(const Wall& wall, std::size_t rows);
  std::vector<double> x_, y_, z_, reach_;
};

}  // namespace scree::core
