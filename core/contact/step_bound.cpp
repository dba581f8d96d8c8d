#include "core/contact/step_bound.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/contact/run_law.hpp"
#include "core/contact/wall_touches.hpp"

namespace scree::core {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct Sums {
  std::vector<Matrix6> stiffness, damping;
  bool dashpots = false;
};

// Adds one contact to the scaled block of a ball: weight counts how often it must be counted.
void add(Matrix6& block, const Eigen::Vector3d& n, double arm, double kn, double ks, double kb, double kt,
         double weight, double inverse_mass, double radius) {
  const Eigen::Matrix3d nn = n * n.transpose(), across = Eigen::Matrix3d::Identity() - nn;
  Eigen::Matrix3d turn;
  turn << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
  const double per_mass = weight * inverse_mass, per_inertia = per_mass * 2.5 / (radius * radius);
  const double mixed = per_mass * std::sqrt(2.5) / radius;
  block.topLeftCorner<3, 3>() += per_mass * (kn * nn + ks * across);
  block.bottomRightCorner<3, 3>() += per_inertia * ((ks * arm * arm + kb) * across + kt * nn);
  // Shear motion of the surface is across u + rotation x (arm n).
  const Eigen::Matrix3d coupling = mixed * ks * arm * turn;
  block.bottomLeftCorner<3, 3>() += coupling;
  block.topRightCorner<3, 3>() += coupling.transpose();
}

struct Piece {
  std::size_t row;
  double arm, weight;
};

class Accumulator {
 public:
  Accumulator(const Balls& balls, std::size_t first, std::size_t last) : balls_(balls), first_(first), last_(last) {
    sums_.stiffness.assign(last - first, Matrix6::Zero());
    sums_.damping.assign(last - first, Matrix6::Zero());
  }
  bool holds(std::size_t row) const { return row >= first_ && row < last_; }
  void contact(const Piece& piece, const Eigen::Vector3d& n, const Tangents& t, uint32_t k, double mass) {
    if (!holds(piece.row)) return;
    const double inverse = balls_[Column::inverse_mass][piece.row], radius = balls_[Column::radius][piece.row];
    if (inverse == 0) return;
    add(sums_.stiffness[piece.row - first_], n, piece.arm, t.normal[k], t.shear[k], t.bending[k], t.twist[k],
        piece.weight, inverse, radius);
    if (t.ratio_normal[k] == 0 && t.ratio_shear[k] == 0) return;
    sums_.dashpots = true;
    add(sums_.damping[piece.row - first_], n, piece.arm, 2 * t.ratio_normal[k] * std::sqrt(mass * t.normal[k]),
        2 * t.ratio_shear[k] * std::sqrt(mass * t.shear[k]), 0, 0, piece.weight, inverse, radius);
  }
  // Largest eigenvalue over the rows; a Cholesky test spares the eigenvalues of all but a few.
  void largest(StepBound& bound) const {
    for (std::size_t k = 0; k < sums_.stiffness.size(); ++k) {
      if (raise(sums_.stiffness[k], bound.stiffness)) bound.ball = balls_.id()[first_ + k];
      if (sums_.dashpots) raise(sums_.damping[k], bound.damping);
    }
  }

 private:
  static bool raise(const Matrix6& block, double& most) {
    if (most > 0) {
      const Eigen::LLT<Matrix6> below(most * Matrix6::Identity() - block);
      if (below.info() == Eigen::Success) return false;
    }
    if (block.trace() == 0) return false;
    const double value = Eigen::SelfAdjointEigenSolver<Matrix6>(block, Eigen::EigenvaluesOnly).eigenvalues()(5);
    if (!(value > most)) return false;
    most = value;
    return true;
  }
  const Balls& balls_;
  std::size_t first_, last_;
  Sums sums_;
};

void add_pairs(Accumulator& sums, const Contacts& contacts, std::size_t index, const Balls& balls,
               const double (*shift)[3], Scratch& s, Tangents& t) {
  const TouchList& list = contacts.lists()[index];
  const BoundRule& rule = contacts.book.rules[index];
  if (rule.model == nullptr || list.size() == 0) return;
  const BallView view(balls);
  const StageTable& stage = stages(0);
  std::vector<uint8_t> nobody(list.size(), 0);
  const FilterInput everything{list.begin.data(), list.other.data(), list.where.data(), shift,
                               std::numeric_limits<double>::infinity()};
  Cursor cursor{0, 0, balls.size()};
  while (cursor.row < cursor.last_row) {
    uint32_t drops[Scratch::padded], dropped = 0;
    const uint32_t n = stage.filter[shift != nullptr](view, everything, cursor, nobody.data(), s, drops, dropped);
    if (n == 0) continue;
    stage.geometry[0][0](view, n, 0.0, 1.0, s);
    for (std::size_t v = 0; v < list.property.size(); ++v)
      for (uint32_t k = 0; k < n; ++k) s.property[v][k] = list.property[v][s.slot[k]];
    for (std::size_t w = 0; w < list.state.size(); ++w)
      for (uint32_t k = 0; k < n; ++k) s.state[w][k] = list.state[w][s.slot[k]];
    tangents(rule, n, s, t);
    for (uint32_t k = 0; k < n; ++k) {
      const std::size_t i = s.row[k], j = s.other[k];
      if (!sums.holds(i) && !sums.holds(j)) continue;
      // The geometry stage gives the normal from the lower to the higher id; a block wants it outward from its ball, as
      // contacts of one ball couple translation and rotation with the sign of their side.
      const Eigen::Vector3d normal = s.sign[k] * Eigen::Vector3d(s.nx[k], s.ny[k], s.nz[k]);
      // A gap that has yet to close does not lengthen the arm it will have.
      const double half = 0.5 * std::min(0.0, s.gap[k]);
      sums.contact({i, view.radius[i] + half, view.inverse_mass[j] > 0 ? 2.0 : 1.0}, normal, t, k, s.mass[k]);
      sums.contact({j, view.radius[j] + half, view.inverse_mass[i] > 0 ? 2.0 : 1.0}, -normal, t, k, s.mass[k]);
    }
  }
}

/// One touch of a candidate as a contact that could be; `t` is its index among the touches.
void load_wall_contact(const BoundRule& rule, const Wall& wall, const BallView& view, uint32_t row,
                       const WallTouches& touches, uint32_t t, uint32_t k, Scratch& s) {
  s.nx[k] = touches.nx[t];
  s.ny[k] = touches.ny[t];
  s.nz[k] = touches.nz[t];
  s.gap[k] = touches.distance[t] - view.radius[row];
  s.r1[k] = view.radius[row];
  s.r2[k] = 0;
  s.mass[k] = 1.0 / view.inverse_mass[row];
  s.row[k] = row;
  for (uint32_t w = 0; w < rule.state_words(); ++w) s.state[w][k] = 0;
  if (rule.varying.empty()) return;
  Birth birth;
  birth.row1 = row;
  birth.wall = &wall;
  birth.patch = touches.patch[t];
  birth.r1 = s.r1[k];
  birth.mass = s.mass[k];
  birth.x = view.x[row];
  birth.y = view.y[row];
  birth.z = view.z[row];
  thread_local std::vector<double> words;
  words = rule.words;
  rule.vary(birth, words.data());
  for (std::size_t v = 0; v < rule.varying.size(); ++v) s.property[v][k] = words[rule.varying[v]];
}

// A wall without walls' own motion: every candidate counts once with the normal it would have.
void add_walls(Accumulator& sums, const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
               Scratch& s, Tangents& t) {
  const BallView view(balls);
  WallTouches touches;
  std::vector<uint32_t> rows;
  for (const WallList& list : contacts.wall_lists()) {
    const BoundRule& rule = contacts.book.rules[list.rule];
    const Wall& wall = walls[list.wall];
    rows.clear();
    for (uint32_t row : list.candidates)
      if (sums.holds(row) && view.inverse_mass[row] > 0) rows.push_back(row);
    if (rows.empty()) continue;
    touches.find(wall, view, rows, 4, rule.reach);
    uint32_t n = 0;
    const auto flush = [&] {
      if (n > 0) tangents(rule, n, s, t);
      for (uint32_t k = 0; k < n; ++k)
        sums.contact({s.row[k], view.radius[s.row[k]], 1.0}, Eigen::Vector3d(s.nx[k], s.ny[k], s.nz[k]), t, k,
                     s.mass[k]);
      n = 0;
    };
    for (uint32_t touch : touches.order) {
      const uint32_t row = rows[touches.ball[touch]];
      if (touches.distance[touch] > 2 * view.radius[row] + rule.reach) continue;
      load_wall_contact(rule, wall, view, row, touches, touch, n++, s);
      if (n == Scratch::size) flush();
    }
    flush();
  }
}

void finish(StepBound& bound, double local_damping) {
  if (bound.stiffness > 0) {
    const double k = bound.stiffness, c = bound.damping;
    // Written without the cancellation of -c + sqrt(c^2 + 4 k).
    bound.step = 4 / (c + std::sqrt(c * c + 4 * k));
  } else if (bound.damping > 0) {
    bound.step = 2 / bound.damping;
  }
  bound.step /= std::sqrt(1 + local_damping);
}

}  // namespace

StepBound step_bound(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                     const PeriodicCell& cell, double local_damping) {
  StepBound bound;
  bound.term = "contacts";
  const ImageShifts shifts(cell);
  const auto scratch = std::make_unique<Scratch>();
  const auto tangents = std::make_unique<Tangents>();
  // Rows in portions: the blocks of all balls at once would be the largest array of a run.
  constexpr std::size_t portion = 65536;
  for (std::size_t first = 0; first < balls.size(); first += portion) {
    Accumulator sums(balls, first, std::min(balls.size(), first + portion));
    for (std::size_t rule = 0; rule < contacts.lists().size(); ++rule)
      add_pairs(sums, contacts, rule, balls, cell.any() ? shifts.of : nullptr, *scratch, *tangents);
    add_walls(sums, contacts, balls, walls, *scratch, *tangents);
    sums.largest(bound);
  }
  finish(bound, local_damping);
  return bound;
}

StepBound possible_pairs(const RuleBook& book, const Balls& balls, const std::vector<Wall>& walls,
                         double local_damping) {
  StepBound bound;
  bound.term = "possible pair";
  const auto s = std::make_unique<Scratch>();
  const auto t = std::make_unique<Tangents>();
  const auto consider = [&](std::size_t row, uint16_t index, const Wall* wall) {
    if (index == no_rule || book.rules[index].model == nullptr) return;
    const BoundRule& rule = book.rules[index];
    const double inverse = balls[Column::inverse_mass][row], radius = balls[Column::radius][row];
    if (inverse == 0) return;
    Birth birth;
    birth.row1 = static_cast<uint32_t>(row);
    birth.row2 = wall != nullptr ? no_row : birth.row1;
    birth.wall = wall;
    birth.r1 = radius;
    birth.r2 = wall != nullptr ? 0 : radius;
    birth.mass = wall != nullptr ? 1 / inverse : 0.5 / inverse;
    birth.x = balls[Column::x][row];
    birth.y = balls[Column::y][row];
    birth.z = balls[Column::z][row];
    std::vector<double> words = rule.words;
    if (!rule.varying.empty()) rule.vary(birth, words.data());
    for (std::size_t v = 0; v < rule.varying.size(); ++v) s->property[v][0] = words[rule.varying[v]];
    for (uint32_t w = 0; w < rule.state_words(); ++w) s->state[w][0] = 0;
    s->nx[0] = 1;
    s->ny[0] = s->nz[0] = 0;
    s->gap[0] = -1e-6 * radius;
    s->r1[0] = radius;
    s->r2[0] = birth.r2;
    s->mass[0] = birth.mass;
    tangents(rule, 1, *s, *t);
    Matrix6 block = Matrix6::Zero();
    const double weight = wall != nullptr ? 1 : 2;
    add(block, Eigen::Vector3d::UnitX(), radius, t->normal[0], t->shear[0], t->bending[0], t->twist[0], weight, inverse,
        radius);
    const double value = Eigen::SelfAdjointEigenSolver<Matrix6>(block, Eigen::EigenvaluesOnly).eigenvalues()(5);
    if (value > bound.stiffness) {
      bound.stiffness = value;
      bound.ball = balls.id()[row];
    }
    if (t->ratio_normal[0] == 0 && t->ratio_shear[0] == 0) return;
    Matrix6 dashpot = Matrix6::Zero();
    add(dashpot, Eigen::Vector3d::UnitX(), radius, 2 * t->ratio_normal[0] * std::sqrt(birth.mass * t->normal[0]),
        2 * t->ratio_shear[0] * std::sqrt(birth.mass * t->shear[0]), 0, 0, weight, inverse, radius);
    bound.damping = std::max(bound.damping,
                             Eigen::SelfAdjointEigenSolver<Matrix6>(dashpot, Eigen::EigenvaluesOnly).eigenvalues()(5));
  };
  // Within one group the lightest ball is the stiffest to move; uniform rules see it through radius and mass alone.
  std::vector<std::size_t> lightest(book.groups(), no_row);
  for (std::size_t row = 0; row < balls.size(); ++row) {
    std::size_t& held = lightest[balls.group()[row]];
    if (held == no_row || balls[Column::mass][row] < balls[Column::mass][held]) held = row;
  }
  for (std::size_t group = 0; group < book.groups(); ++group) {
    if (lightest[group] == no_row) continue;
    for (std::size_t other = 0; other < book.groups(); ++other)
      if (lightest[other] != no_row)
        consider(lightest[group], book.balls(static_cast<uint16_t>(group), static_cast<uint16_t>(other)), nullptr);
    for (std::size_t w = 0; w < walls.size(); ++w)
      consider(lightest[group], book.wall(static_cast<uint16_t>(group), static_cast<uint16_t>(w)), &walls[w]);
  }
  finish(bound, local_damping);
  return bound;
}

StepBound smaller(const StepBound& a, const StepBound& b) {
  if (a.step == 0) return b;
  if (b.step == 0) return a;
  return b.step < a.step ? b : a;
}

}  // namespace scree::core
