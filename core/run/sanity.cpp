#include "core/run/sanity.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>

#include "core/contact/run_law.hpp"
#include "core/run/far_away.hpp"
#include "core/run/rule_doubts.hpp"

namespace scree::core {

namespace {

constexpr double deep = 0.01;    // of the radius: ten times what stiff enough contacts show under one ball's weight
constexpr double unequal = 300;  // between the fastest and the slowest ball: a swing of 2000 cycles

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

/// Size of the force on every ball, N: of applied forces and processes that add, and with `contacts` of contacts too.
std::vector<double> sizes(Engine& engine, bool contacts) {
  const Observation& now = engine.observe();
  std::vector<double> size(engine.balls.size());
  for (std::size_t row = 0; row < size.size(); ++row) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double own = now.force[c][row] - (contacts ? 0 : engine.contacts.slices().record(row)[c]);
      square += own * own;
    }
    size[row] = std::sqrt(square);
  }
  return size;
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
  const std::vector<double> pull = sizes(engine, false);
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

/// How fast a ball swings on the stiffest contact that it may have.
struct Pace {
  double square = 0;  ///< rad2/s2
  uint64_t id = 0;
  std::string rule;
};

/// Of every group the lightest and the heaviest free ball: the fastest of the ones and the slowest of the others.
std::pair<Pace, Pace> paces(const Engine& engine) {
  const RuleBook& book = engine.contacts.book;
  const Balls& balls = engine.balls;
  const auto scratch = std::make_unique<Scratch>();
  std::vector<std::size_t> light(book.groups(), no_row), heavy(book.groups(), no_row);
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (balls[Column::inverse_mass][row] == 0) continue;
    std::size_t &least = light[balls.group()[row]], &most = heavy[balls.group()[row]];
    if (least == no_row || balls[Column::mass][row] < balls[Column::mass][least]) least = row;
    if (most == no_row || balls[Column::mass][row] > balls[Column::mass][most]) most = row;
  }
  const auto pace = [&](std::size_t group, std::size_t row) {
    Pace fastest;
    const auto consider = [&](uint16_t index, const Wall* wall) {
      if (index == no_rule || book.rules[index].model == nullptr) return;
      const double square = normal_stiffness(book.rules[index], balls, row, wall, *scratch) / balls[Column::mass][row];
      if (square > fastest.square) fastest = {square, balls.id()[row], book.rules[index].name};
    };
    for (std::size_t b = 0; b < light.size(); ++b)
      if (light[b] != no_row) consider(book.balls(static_cast<uint16_t>(group), static_cast<uint16_t>(b)), nullptr);
    for (std::size_t w = 0; w < engine.walls.size(); ++w)
      consider(book.wall(static_cast<uint16_t>(group), static_cast<uint16_t>(w)), &engine.walls[w]);
    return fastest;
  };
  Pace fastest, slowest;
  for (std::size_t group = 0; group < light.size(); ++group) {
    if (light[group] == no_row) continue;
    const Pace quick = pace(group, light[group]), lazy = pace(group, heavy[group]);
    if (quick.square > fastest.square) fastest = quick;
    if (lazy.square > 0 && (slowest.square == 0 || lazy.square < slowest.square)) slowest = lazy;
  }
  return {fastest, slowest};
}

std::string unequal_paces(const Engine& engine) {
  const auto [fastest, slowest] = paces(engine);
  if (!(fastest.square > unequal * unequal * slowest.square) || slowest.square == 0 || engine.clock.dt == 0) return "";
  const double cycles = 2 * std::numbers::pi / std::sqrt(slowest.square) / engine.clock.dt;
  return "ball " + std::to_string(slowest.id) + " on rule '" + slowest.rule + "' swings " +
         number(std::sqrt(fastest.square / slowest.square)) + " times as slowly as ball " + std::to_string(fastest.id) +
         " on rule '" + fastest.rule + "', so that one of its swings takes about " + number(cycles) +
         " cycles (the step is set by " + engine.step.bound().text() +
         "): softer contacts of the one, or less mass of the other, make the run as much shorter";
}

/// A step of the user's that leaves less than the share of the limit that the automatic one leaves.
std::string no_margin(const Engine& engine) {
  const StepControl& step = engine.step;
  if (step.automatic() || step.bound().step == 0 || *step.fixed <= step.allowed()) return "";
  char share[40];
  std::snprintf(share, sizeof share, "%.4g", *step.fixed / step.bound().step);
  return "the step of " + number(*step.fixed) + " s is " + share + " of the stable limit of " +
         number(step.bound().step) + " s (" + step.bound().text() + "): give a 'timestep' of at most " +
         number(step.allowed()) + " s, or leave it out";
}

}  // namespace

std::vector<std::string> doubts(Simulation& simulation) {
  Engine& engine = simulation.engine;
  std::vector<std::string> out = rule_doubts(simulation);
  for (const std::string& one : far_away(engine, sizes(engine, true))) out.push_back(one);
  for (const std::string& one : {unequal_paces(engine), no_margin(engine)})
    if (!one.empty()) out.push_back(one);
  const Rest rest = deepest(engine);
  if (rest.share > deep)
    out.push_back("overlap under own weight = " + number(rest.share) + " R: ball " + std::to_string(rest.id) +
                  " of radius " + number(rest.radius) + " m weighs " + number(rest.pull) + " N, and rule '" +
                  rest.rule + "' holds it with " + number(rest.stiffness) +
                  " N/m: check the units of sizes, densities and stiffnesses, or make the contacts stiffer");
  return out;
}

}  // namespace scree::core
