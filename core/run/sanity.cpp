#include "core/run/sanity.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "core/contact/run_law.hpp"

namespace scree::core {

namespace {

constexpr double deep = 0.01;  // of the radius: ten times what stiff enough contacts show under one ball's weight

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// How one ball lies under its own weight on the softest contact that it may have.
struct Rest {
  double share = 0;  ///< overlap over radius
  double pull = 0, radius = 0, stiffness = 0;
  uint64_t id = 0;
  std::string rule;
};

/// Normal stiffness that a rule would give to this ball and another like it, or to this ball and a wall, N/m.
double normal_stiffness(const BoundRule& rule, const Balls& balls, std::size_t row, const Wall* wall, Scratch& s) {
  Birth birth;
  birth.row1 = static_cast<uint32_t>(row);
  birth.row2 = wall != nullptr ? no_row : birth.row1;
  birth.wall = wall;
  birth.r1 = balls[Column::radius][row];
  birth.r2 = wall != nullptr ? 0 : birth.r1;
  birth.mass = balls[Column::mass][row] * (wall != nullptr ? 1 : 0.5);
  birth.x = balls[Column::x][row];
  birth.y = balls[Column::y][row];
  birth.z = balls[Column::z][row];
  std::vector<double> words = rule.words;
  if (!rule.varying.empty()) rule.vary(birth, words.data());
  for (std::size_t v = 0; v < rule.varying.size(); ++v) s.property[v][0] = words[rule.varying[v]];
  for (uint32_t w = 0; w < rule.state_words(); ++w) s.state[w][0] = 0;
  s.nx[0] = 1;
  s.ny[0] = s.nz[0] = 0;
  s.gap[0] = -1e-6 * birth.r1;
  s.r1[0] = birth.r1;
  s.r2[0] = birth.r2;
  s.mass[0] = birth.mass;
  const auto tangent = std::make_unique<Tangents>();
  tangents(rule, 1, false, s, *tangent);
  return tangent->normal[0];
}

/// Applied forces and processes that add: the net force without that of contacts, N.
std::vector<double> pulls(Engine& engine) {
  const Observation& now = engine.observe();
  std::vector<double> pull(engine.balls.size());
  for (std::size_t row = 0; row < pull.size(); ++row) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double own = now.force[c][row] - engine.contacts.slices().record(row)[c];
      square += own * own;
    }
    pull[row] = std::sqrt(square);
  }
  return pull;
}

/// Per group the free ball with the most weight for its size: rules with one stiffness for all sizes press it deepest.
std::vector<std::size_t> heaviest(const Engine& engine, const std::vector<double>& pull) {
  const Balls& balls = engine.balls;
  std::vector<std::size_t> row_of(engine.contacts.book.groups(), no_row);
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (balls[Column::inverse_mass][row] == 0) continue;
    std::size_t& held = row_of[balls.group()[row]];
    if (held == no_row || pull[row] * balls[Column::radius][held] > pull[held] * balls[Column::radius][row]) held = row;
  }
  return row_of;
}

Rest deepest(Engine& engine) {
  const RuleBook& book = engine.contacts.book;
  const Balls& balls = engine.balls;
  const std::vector<double> pull = pulls(engine);
  const std::vector<std::size_t> rows = heaviest(engine, pull);
  const auto scratch = std::make_unique<Scratch>();
  Rest worst;
  const auto consider = [&](std::size_t row, uint16_t index, const Wall* wall) {
    if (index == no_rule || book.rules[index].model == nullptr) return;
    const double k = normal_stiffness(book.rules[index], balls, row, wall, *scratch);
    const double radius = balls[Column::radius][row], share = k > 0 ? pull[row] / (k * radius) : 0;
    if (share > worst.share) worst = {share, pull[row], radius, k, balls.id()[row], book.rules[index].name};
  };
  for (std::size_t a = 0; a < rows.size(); ++a) {
    if (rows[a] == no_row) continue;
    for (std::size_t b = 0; b < rows.size(); ++b)
      if (rows[b] != no_row) consider(rows[a], book.balls(static_cast<uint16_t>(a), static_cast<uint16_t>(b)), nullptr);
    for (std::size_t w = 0; w < engine.walls.size(); ++w)
      consider(rows[a], book.wall(static_cast<uint16_t>(a), static_cast<uint16_t>(w)), &engine.walls[w]);
  }
  return worst;
}

/// A rule that gives friction but has no tangential part: it lacks the shear spring that friction limits.
bool friction_in_vain(const Rule& rule, const BoundRule& bound) {
  if (bound.model == nullptr || !bound.normal_only()) return false;
  return std::any_of(rule.model.settings.begin(), rule.model.settings.end(), [](const Setting& setting) {
    return setting.name == "fric" &&
           (setting.formula != nullptr || setting.drawn != nullptr || setting.value.numbers.at(0) > 0);
  });
}

}  // namespace

std::vector<std::string> doubts(Simulation& simulation) {
  std::vector<std::string> out;
  Engine& engine = simulation.engine;
  const RuleBook& book = engine.contacts.book;
  for (uint16_t index : simulation.precedence)
    if (friction_in_vain(simulation.rules[index], book.rules[index]))
      out.push_back(simulation.rules[index].place.text() + ": warning: rule '" + simulation.rules[index].name +
                    "' gives friction but no shear stiffness, so friction has no effect: give a shear stiffness, or "
                    "leave 'fric' out");
  const Rest rest = deepest(engine);
  if (rest.share > deep)
    out.push_back("overlap under own weight = " + number(rest.share) + " R: ball " + std::to_string(rest.id) +
                  " of radius " + number(rest.radius) + " m weighs " + number(rest.pull) + " N, and rule '" +
                  rest.rule + "' holds it with " + number(rest.stiffness) +
                  " N/m: check the units of sizes, densities and stiffnesses, or make the contacts stiffer");
  return out;
}

}  // namespace scree::core
