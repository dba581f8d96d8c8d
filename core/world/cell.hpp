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

}  // namespace scree::core
