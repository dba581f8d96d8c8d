#pragma once
#include <string>
#include <vector>

#include "core/run/instant.hpp"
#include "core/run/published.hpp"

namespace scree::core {

/// An expression over one ball: x y z, vx vy vz, wx wy wz (all at time n), radius mass volume speed id contacts (active
/// ones of the ball), fx fy fz (net force). Bound to the engine once, evaluated per row. [one thread]
class BallFormula {
 public:
  BallFormula(const Formula& formula, Engine& engine, Instant& now);
  double at(std::size_t row);
  static const std::vector<std::string>& words();

 private:
  double word(std::size_t index, std::size_t row);
  const Formula& formula_;
  Engine& engine_;
  Instant& now_;
  std::vector<std::size_t> words_;
  std::vector<double> values_;
};

/// sum, min, max, mean or count over the balls of a group that fulfil `where`, in row order, so that it does not depend
/// on threads. Over no ball, sum and count are 0; mean, min and max are NaN.
double reduced(const Quantity& quantity, Simulation& simulation, Instant& now);

}  // namespace scree::core
