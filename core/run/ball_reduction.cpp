#include "core/run/ball_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace scree::core {

const std::vector<std::string>& BallFormula::words() {
  static const std::vector<std::string> names = {"x",     "y",  "z",        "vx",     "vy",   "vz",
                                                 "wx",    "wy", "wz",       "radius", "mass", "volume",
                                                 "speed", "id", "contacts", "fx",     "fy",   "fz"};
  return names;
}

BallFormula::BallFormula(const Formula& formula, Engine& engine, Instant& now)
    : formula_(formula), engine_(engine), now_(now), values_(formula.names().size()) {
  for (const std::string& name : formula.names()) {
    const auto found = std::find(words().begin(), words().end(), name);
    if (found == words().end())
      throw Refusal(Exit::scene, formula.place().text() + ": error: '" + name + "' is no column of the balls");
    words_.push_back(static_cast<std::size_t>(found - words().begin()));
  }
}

double BallFormula::word(std::size_t index, std::size_t row) {
  const Balls& balls = engine_.balls;
  const auto column = [&](Column first, std::size_t c) {
    return balls[static_cast<Column>(static_cast<std::size_t>(first) + c)][row];
  };
  const auto velocity = [&](std::size_t c) { return now_.observation().velocity[c][row]; };
  if (index < 3) return column(Column::x, index);
  if (index < 6) return velocity(index - 3);
  if (index < 9) {
    const auto& spin = now_.observation().spin[index - 6];
    return row < spin.size() ? spin[row] : 0.0;
  }
  const double radius = balls[Column::radius][row];
  switch (index) {
    case 9:
      return radius;
    case 10:
      return balls[Column::mass][row];
    case 11:
      return 4 * std::numbers::pi / 3 * radius * radius * radius;
    case 12:
      return std::sqrt(velocity(0) * velocity(0) + velocity(1) * velocity(1) + velocity(2) * velocity(2));
    case 13:
      return static_cast<double>(balls.id()[row]);
    case 14:
      return now_.contacts_of_balls()[row];
    default:
      return now_.observation().force[index - 15][row];
  }
}

double BallFormula::at(std::size_t row) {
  for (std::size_t k = 0; k < words_.size(); ++k) values_[k] = word(words_[k], row);
  return formula_.evaluate(values_);
}

double reduced(const Quantity& quantity, Simulation& simulation, Instant& now) {
  Engine& engine = simulation.engine;
  const std::vector<uint8_t> covered = simulation.groups.cover(quantity.over);
  std::optional<BallFormula> each, where;
  if (quantity.each) each.emplace(*quantity.each, engine, now);
  if (quantity.where) where.emplace(*quantity.where, engine, now);
  double sum = 0, least = std::nan(""), most = std::nan("");
  std::size_t count = 0;
  for (std::size_t row = 0; row < engine.balls.size(); ++row) {
    if (covered[engine.balls.group()[row]] == 0) continue;
    if (where) {
      const double answer = where->at(row);
      if (answer == 0 || std::isnan(answer)) continue;
    }
    const double value = each ? each->at(row) : 0.0;
    sum += value;
    least = count == 0 || value < least || std::isnan(value) ? value : least;
    most = count == 0 || value > most || std::isnan(value) ? value : most;
    ++count;
  }
  if (quantity.reduction == "count") return static_cast<double>(count);
  if (quantity.reduction == "sum") return sum;
  if (quantity.reduction == "min") return least;
  if (quantity.reduction == "max") return most;
  return count == 0 ? std::nan("") : sum / static_cast<double>(count);
}

}  // namespace scree::core
