#include "core/contact/possible_pairs.hpp"

#include <cmath>
#include <memory>

#include "core/contact/ball_block.hpp"
#include "core/contact/run_law.hpp"
#include "core/contact/trial_pair.hpp"

namespace scree::core {

namespace {

/// Tries pairs that could be, one at a time, and keeps the one with the shortest step.
class Trial {
 public:
  Trial(const RuleBook& book, const Balls& balls, double local_damping)
      : book_(book), balls_(balls), limit_(1 / (1 + local_damping)) {}
  /// `other`: the ball that it meets, which may stand for another one like it; no_row with a wall.
  void meet(std::size_t row, std::size_t other, uint16_t index, const Wall* wall);
  const StepBound& bound() const { return bound_; }

 private:
  const RuleBook& book_;
  const Balls& balls_;
  const double limit_;
  StepBound bound_;
  const std::unique_ptr<Scratch> s_ = std::make_unique<Scratch>();
  Tangents t_;
};

void Trial::meet(std::size_t row, std::size_t other, uint16_t index, const Wall* wall) {
  if (index == no_rule || book_.rules[index].model == nullptr) return;
  const BoundRule& rule = book_.rules[index];
  const double inverse = balls_[Column::inverse_mass][row], radius = balls_[Column::radius][row];
  if (inverse == 0) return;
  Birth birth;
  birth.row1 = static_cast<uint32_t>(row);
  birth.row2 = static_cast<uint32_t>(other);
  birth.wall = wall;
  birth.r1 = radius;
  birth.r2 = wall != nullptr ? 0 : balls_[Column::radius][other];
  birth.mass = 1 / (inverse + (wall != nullptr ? 0 : balls_[Column::inverse_mass][other]));
  birth.x = balls_[Column::x][row];
  birth.y = balls_[Column::y][row];
  birth.z = balls_[Column::z][row];
  load_trial(rule, birth, -1e-6 * radius, 0, *s_);
  tangents(rule, 1, false, *s_, t_);
  Link link{};
  link.normal[0] = 1;
  link.arm[0] = radius;
  link.kn = t_.normal[0];
  link.ks = t_.shear[0];
  // Weights as the network's: a ball counts its contact more, the lighter the other one is. Equal balls count it twice.
  const double theirs = wall != nullptr ? 0 : balls_[Column::inverse_mass][other];
  const double times = (1 + std::sqrt(theirs / inverse)) * inverse;
  Block stiffness = Block::Zero(), damping = Block::Zero();
  add_end(stiffness, link, 0, link.kn, link.ks, t_.bending[0], t_.twist[0], times, radius);
  add_end(damping, link, 0, 2 * t_.ratio_normal[0] * std::sqrt(s_->mass[0] * link.kn),
          2 * t_.ratio_shear[0] * std::sqrt(s_->mass[0] * link.ks), 0, 0, times, radius);
  const double largest = nearly_largest(stiffness);
  if (!(largest > 0)) return;
  const double step = 2 * largest_stable(stiffness, damping, 1.01 * std::sqrt(limit_ / largest), limit_);
  if (bound_.step > 0 && bound_.step <= step) return;
  bound_ = {step, balls_.id()[row], 0, wall != nullptr ? wall->name : "", "possible pair", false};
}

}  // namespace

StepBound possible_pairs(const RuleBook& book, const Balls& balls, const std::vector<Wall>& walls,
                         double local_damping) {
  Trial trial(book, balls, local_damping);
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
        trial.meet(lightest[group], lightest[other],
                   book.balls(static_cast<uint16_t>(group), static_cast<uint16_t>(other)), nullptr);
    for (std::size_t w = 0; w < walls.size(); ++w)
      trial.meet(lightest[group], no_row, book.wall(static_cast<uint16_t>(group), static_cast<uint16_t>(w)), &walls[w]);
  }
  return trial.bound();
}

}  // namespace scree::core
