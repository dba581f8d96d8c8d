#pragma once
#include <cmath>

namespace scree::core {

/// An orthogonal cell of fixed size, periodic per axis. Without periodic axes it means nothing to the kernel.
struct PeriodicCell {
  double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  bool periodic[3] = {false, false, false};

  bool any() const { return periodic[0] || periodic[1] || periodic[2]; }
  double length(int axis) const { return high[axis] - low[axis]; }
  /// The image of a coordinate inside [low, high).
  double wrapped(double value, int axis) const {
    if (!periodic[axis]) return value;
    const double edge = length(axis);
    double inside = value - std::floor((value - low[axis]) / edge) * edge;
    if (inside >= high[axis]) inside -= edge;
    return inside < low[axis] ? low[axis] : inside;
  }
};

/// What is added to the higher row's position for each image code of a pair: two bits per axis, 0 none, 1 one edge up,
/// 2 one edge down, m.
struct ImageShifts {
  double of[64][3];
  explicit ImageShifts(const PeriodicCell& cell) {
    for (int code = 0; code < 64; ++code)
      for (int axis = 0; axis < 3; ++axis) {
        const int image = (code >> (2 * axis)) & 3;
        of[code][axis] = image == 1 ? cell.length(axis) : image == 2 ? -cell.length(axis) : 0.0;
      }
  }
};

}  // namespace scree::core
