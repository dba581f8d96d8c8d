#pragma once
#include <array>
#include <vector>

#include "core/cycle/engine.hpp"

namespace scree::core {

/// The box that unbounded walls are cut to in pictures: around the balls and a periodic cell, with a margin of a tenth
/// of its longest edge. It only grows, and by that margin, so that pictures keep their size while balls move about.
class ShownBox {
 public:
  /// Takes in where the balls are now. Depends on the frames shown so far alone.
  void follow(const Engine& engine);
  const std::array<double, 3>& low() const { return low_; }
  const std::array<double, 3>& high() const { return high_; }
  /// For checkpoints: six numbers, or none while nothing was to be seen.
  std::vector<double> saved() const;
  void restore(const std::vector<double>& saved);

 private:
  std::array<double, 3> low_{-1, -1, -1}, high_{1, 1, 1};
  bool seen_ = false;
};

}  // namespace scree::core
