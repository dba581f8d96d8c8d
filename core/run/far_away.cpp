#include "core/run/far_away.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace scree::core {

namespace {

// Of the radius. Overlaps are some thousandths of it, so these are some 1e-5 and 1e-3 of an overlap.
constexpr double coarse = 1e-8, useless = 1e-6;

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Distance from |value| to the next double.
double spacing(double value) {
  const double size = std::fabs(value);
  return std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
}

struct Coarsest {
  std::size_t row = 0;
  double at = 0, step = 0, share = 0;  ///< m, m, of the radius
};

Coarsest coarsest(const Balls& balls) {
  Coarsest worst;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (balls[Column::inverse_mass][row] == 0) continue;
    double at = 0;
    for (const Column c : {Column::x, Column::y, Column::z}) at = std::max(at, std::fabs(balls[c][row]));
    const double step = spacing(at), share = step / balls[Column::radius][row];
    if (share > worst.share) worst = {row, at, step, share};
  }
  return worst;
}

bool stalls(const Balls& balls, std::size_t row, double dt) {
  constexpr Column place[] = {Column::x, Column::y, Column::z}, speed[] = {Column::vx, Column::vy, Column::vz};
  bool moves = false;
  for (int c = 0; c < 3; ++c) {
    const double x = balls[place[c]][row], v = balls[speed[c]][row];
    if (v == 0) continue;
    moves = true;
    if (x + v * dt != x) return false;
  }
  return moves;
}

}  // namespace

std::vector<std::string> far_away(const Engine& engine, const std::vector<double>& net_force) {
  std::vector<std::string> out;
  const Balls& balls = engine.balls;
  const Coarsest worst = coarsest(balls);
  if (worst.share > coarse) {
    const std::string what = "ball " + std::to_string(balls.id()[worst.row]) + " lies " + number(worst.at) +
                             " m from the origin, where a coordinate moves by " + number(worst.step) + " m at least, " +
                             number(worst.share) + " of its radius: ";
    if (worst.share > useless && !engine.unsafe)
      throw Refusal(Exit::scene, what +
                                     "overlaps there are rounding; put the origin near the balls, or say "
                                     "'unsafe: true'");
    out.push_back(what + "overlaps there are rounded to that; put the origin near the balls");
  }
  std::size_t first = balls.size(), count = 0;
  for (std::size_t row = engine.clock.dt > 0 ? balls.size() : 0; row-- > 0;) {
    if (net_force[row] != 0 || !stalls(balls, row, engine.clock.dt)) continue;
    first = row;
    ++count;
  }
  if (count > 0)
    out.push_back("ball " + std::to_string(balls.id()[first]) +
                  (count > 1 ? " and " + std::to_string(count - 1) + " more do" : " does") +
                  " not move although a velocity is given: in one cycle of " + number(engine.clock.dt) +
                  " s it goes less far than a coordinate there can change; put the origin near the balls, or use a "
                  "larger step");
  return out;
}

}  // namespace scree::core
