#include "core/contact/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/base/hash.hpp"
#include "core/contact/ball_block.hpp"
#include "core/contact/cap_sum.hpp"
#include "core/contact/pair_search.hpp"
#include "core/contact/run_law.hpp"
#include "core/contact/trial_pair.hpp"

namespace scree::core {

namespace {

/// Classes of radius in a group, at most, and of all balls: every two of them are tried.
constexpr std::size_t most_sizes = 16, most_classes = 64;

/// The most that the contacts of a class of balls do, one by one, each as often as it counts.
struct Most {
  double normal = 0, shear = 0, bending = 0, twist = 0;
  double dashpot_normal = 0, dashpot_shear = 0;
  double reach = 0, smallest = std::numeric_limits<double>::infinity();  ///< m; of those that it touches, radius
};

const BoundRule* law_between(const RuleBook& book, std::size_t a, std::size_t b) {
  const uint16_t index = book.balls(static_cast<uint16_t>(a), static_cast<uint16_t>(b));
  return index == no_rule || book.rules[index].model == nullptr ? nullptr : &book.rules[index];
}

/// Tries contacts of balls that could be, in batches of what one pair of classes needs.
class Trials {
 public:
  explicit Trials(double depth) : depth_(depth) {}
  void add(const BoundRule& rule, const Birth& birth) {
    const double least = std::min(birth.r1, birth.r2);
    // Laws that stiffen as they close, and laws that soften.
    for (const double gap : {-depth_ * least, -1e-9 * least}) load_trial(rule, birth, gap, n_++, *s_);
  }
  /// `times`: how often a contact counts for the ball. The stiffest normal spring, without that.
  double raise(const BoundRule& rule, double times, Most& most) {
    tangents(rule, n_, false, *s_, t_);
    double stiffest = 0;
    const auto raise = [&](double& held, double now) { held = std::max(held, times * now); };
    for (uint32_t k = 0; k < n_; ++k) {
      stiffest = std::max(stiffest, t_.normal[k]);
      raise(most.normal, t_.normal[k]);
      raise(most.shear, t_.shear[k]);
      raise(most.bending, t_.bending[k]);
      raise(most.twist, t_.twist[k]);
      raise(most.dashpot_normal, 2 * t_.ratio_normal[k] * std::sqrt(s_->mass[k] * t_.normal[k]));
      raise(most.dashpot_shear, 2 * t_.ratio_shear[k] * std::sqrt(s_->mass[k] * t_.shear[k]));
    }
    n_ = 0;
    return stiffest;
  }
  /// Whether what a contact remembers changes its stiffness: then nothing can be said of contacts that are yet to be.
  bool remembers(const BoundRule& rule, const Birth& birth) {
    const double depth = depth_ * std::min(birth.r1, birth.r2);
    load_trial(rule, birth, -depth, 0, *s_);
    tangents(rule, 1, false, *s_, t_);
    const double force = t_.normal[0] * depth;
    uint32_t n = 0;
    for (const double word : {0.0, force, -force, depth, 1.0}) {
      load_trial(rule, birth, -depth, n, *s_);
      for (uint32_t w = 0; w < rule.state_words(); ++w) s_->state[w][n] = word;
      ++n;
    }
    tangents(rule, n, false, *s_, t_);
    for (const double* column : {t_.normal, t_.shear, t_.bending, t_.twist})
      for (uint32_t k = 1; k < n; ++k)
        if (column[k] != column[0]) return true;
    return false;
  }

 private:
  double depth_;
  uint32_t n_ = 0;
  const std::unique_ptr<Scratch> s_ = std::make_unique<Scratch>();
  Tangents t_;
};

/// Springs or dashpots of one contact of a ball of this radius, whose arm lies between two lengths.
double sum_of(double along, double across, double twist, double bending, double radius, std::pair<double, double> arm,
              double cosine) {
  const double per = 2.5 / (radius * radius);
  ContactShape one;
  one.along = along;
  // Contacts of shorter arm: (x + t y)^2 with t below 1 is at most (x + y)^2 + (1 - t)/(1 + t) x^2.
  one.across = across * (1 + (arm.second - arm.first) / (arm.second + arm.first));
  one.twist = per * twist;
  one.bend = per * (across * arm.second * arm.second + bending);
  one.mixed = std::sqrt(per) * across * arm.second;
  return cap_sum(one, cosine);
}

}  // namespace

Crowd::Crowd(const RuleBook& book, const Balls& balls, const PeriodicCell& cell, Team& team)
    : loose_(book.groups(), 0) {
  sort(balls);
  if (classes_.size() <= most_classes) look_for_loose(book, balls, cell, team);
}

void Crowd::take(const RuleBook& book, const Balls& balls, double depth) {
  depth_ = depth;
  pair_step_ = 0;
  unknown_.clear();
  if (classes_.size() > most_classes) unknown_ = "the balls are of too many groups";
  if (loose_moves_) unknown_ = "balls that move may overlap others without a force";
  if (loose_overlap_ > depth) unknown_ = "fixed balls overlap without a force";
  if (!unknown_.empty()) return;
  sort(balls);
  weigh(book);
}

void Crowd::sort(const Balls& balls) {
  classes_.clear();
  std::vector<uint8_t> there(loose_.size(), 0);
  for (std::size_t row = 0; row < balls.size(); ++row) there[balls.group()[row]] = 1;
  const auto groups = static_cast<std::size_t>(std::count(there.begin(), there.end(), 1));
  const std::size_t sizes = std::clamp<std::size_t>(most_classes / std::max<std::size_t>(1, groups), 1, most_sizes);
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = 0;
  };
  std::vector<Range> range(loose_.size());
  const double *radius = balls[Column::radius], *mass = balls[Column::mass], *inverse = balls[Column::inverse_mass];
  for (std::size_t row = 0; row < balls.size(); ++row) {
    Range& own = range[balls.group()[row]];
    own.low = std::min(own.low, radius[row]);
    own.high = std::max(own.high, radius[row]);
  }
  std::vector<Class> all(loose_.size() * sizes);
  for (std::size_t row = 0; row < balls.size(); ++row) {
    const uint16_t group = balls.group()[row];
    const Range& own = range[group];
    std::size_t size = 0;
    if (own.high > own.low)
      size = std::min(sizes - 1,
                      static_cast<std::size_t>(static_cast<double>(sizes) *
                                               (std::log(radius[row] / own.low) / std::log(own.high / own.low))));
    Class& c = all[group * sizes + size];
    if (c.row == no_row) {
      c.group = group;
      c.low = c.high = radius[row];
      c.row = static_cast<uint32_t>(row);
    }
    c.low = std::min(c.low, radius[row]);
    c.high = std::max(c.high, radius[row]);
    c.fixed = c.fixed || inverse[row] == 0;
    if (inverse[row] == 0) continue;
    c.most_mass = std::max(c.most_mass, mass[row]);
    if (c.moving != no_row && mass[row] >= c.least_mass) continue;
    c.least_mass = mass[row];
    c.moving = static_cast<uint32_t>(row);
    c.id = balls.id()[row];
  }
  for (const Class& c : all)
    if (c.row != no_row) classes_.push_back(c);
}

// Balls that pass through each other are as many as like round a third one, unless they are fixed and do not overlap.
void Crowd::look_for_loose(const RuleBook& book, const Balls& balls, const PeriodicCell& cell, Team& team) {
  const std::size_t groups = book.groups();
  std::vector<uint8_t> there(groups, 0);
  for (const Class& c : classes_) there[c.group] = 1;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t p = 0; p < groups; ++p)
    for (std::size_t q = p; q < groups; ++q) {
      if (!there[p] || !there[q] || law_between(book, p, q) != nullptr) continue;
      bool meet = false;
      for (std::size_t g = 0; g < groups; ++g)
        meet = meet || (there[g] && law_between(book, g, p) != nullptr && law_between(book, g, q) != nullptr);
      if (!meet) continue;
      pairs.emplace_back(p, q);
      loose_[p] = loose_[q] = 1;
    }
  if (pairs.empty()) return;
  for (const Class& c : classes_) loose_moves_ = loose_moves_ || (loose_[c.group] && c.moving != no_row);
  if (loose_moves_) return;
  const PairTable near = find_pairs(balls, cell, 0, team);
  const double *x = balls[Column::x], *y = balls[Column::y], *z = balls[Column::z], *radius = balls[Column::radius];
  for (std::size_t row = 0; row < balls.size(); ++row)
    for (uint64_t k = near.begin[row]; k < near.begin[row + 1]; ++k) {
      const uint32_t other = near.other[k];
      const std::pair<std::size_t, std::size_t> groups_of =
          std::minmax<std::size_t>(balls.group()[row], balls.group()[other]);
      if (std::find(pairs.begin(), pairs.end(), groups_of) == pairs.end()) continue;
      const double apart[3] = {x[other] - x[row], y[other] - y[row], z[other] - z[row]};
      double square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double way = cell.periodic[axis] ? std::remainder(apart[axis], cell.length(axis)) : apart[axis];
        square += way * way;
      }
      const double overlap = radius[row] + radius[other] - std::sqrt(square);
      loose_overlap_ = std::max(loose_overlap_, overlap / std::min(radius[row], radius[other]));
    }
  resting_ = at_rest(balls);
}

uint64_t Crowd::at_rest(const Balls& balls) const {
  if (std::find(loose_.begin(), loose_.end(), 1) == loose_.end()) return 0;
  uint64_t sum = 0;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (!loose_[balls.group()[row]]) continue;
    const double at[3] = {balls[Column::x][row], balls[Column::y][row], balls[Column::z][row]};
    sum += hash64(at, sizeof at) + balls.id()[row];
  }
  return sum;
}

void Crowd::weigh(const RuleBook& book) {
  const auto refuse = [&](const std::string& why) { unknown_ = why; };
  Trials trials(depth_);
  bool constant = true, any = false;
  double pair_square = std::numeric_limits<double>::infinity();
  for (Class& c : classes_) {
    if (c.moving == no_row) continue;
    Most most;
    for (const Class& p : classes_) {
      const BoundRule* rule = law_between(book, c.group, p.group);
      if (rule == nullptr) continue;
      if (rule->drawn) return refuse("properties of rule '" + rule->name + "' differ from contact to contact");
      Birth birth;
      birth.row1 = c.moving;
      birth.row2 = p.row;
      birth.mass = 1 / (1 / c.most_mass + (p.fixed ? 0 : 1 / p.most_mass));
      Most here = most;
      for (const double a : {c.low, c.high})
        for (const double b : {p.low, p.high}) {
          birth.r1 = a;
          birth.r2 = b;
          trials.add(*rule, birth);
        }
      // Weights as the network's where they are equal: a contact with what does not move counts once.
      const double stiffest = trials.raise(*rule, p.moving == no_row ? 1 : 2, here);
      if (trials.remembers(*rule, birth))
        return refuse("the stiffness of rule '" + rule->name + "' follows from what a contact remembers");
      here.reach = std::max(most.reach, rule->reach);
      here.smallest = std::min(most.smallest, p.low);
      constant = constant && (rule->model->flags & SCREE_NONLINEAR) == 0;
      most = here;
      const double yielding = 1 / c.least_mass + (p.moving == no_row ? 0 : 1 / p.least_mass);
      if (stiffest > 0) pair_square = std::min(pair_square, 1 / (stiffest * yielding));
    }
    if (!(most.normal + most.shear + most.bending + most.twist > 0)) continue;
    const double nearest = 2 * most.smallest * (1 - depth_ / 2), far = c.high + most.smallest + most.reach;
    // Of two neighbours at most `far` away and at least `nearest` apart the angle is least where both are far, unless
    // one could be much nearer than the other.
    if (depth_ * most.smallest + most.reach > nearest * nearest / far || nearest >= 2 * far)
      return refuse("balls are small beside others for so deep an overlap");
    const double sine = nearest / (2 * far), cosine = std::sqrt(1 - sine * sine), times = 1 / c.least_mass;
    const std::pair<double, double> arm(c.low * (1 - depth_ / 2), c.low + most.reach / 2);
    c.load = {times * sum_of(most.normal, most.shear, most.twist, most.bending, c.low, arm, cosine),
              times * sum_of(most.dashpot_normal, most.dashpot_shear, 0, 0, c.low, arm, cosine)};
    if (!std::isfinite(c.load.stiffness + c.load.damping)) return refuse("the stiffness of a contact is not finite");
    any = true;
  }
  if (!any) return refuse("no ball that moves can touch another");
  if (constant) pair_step_ = 2 * std::sqrt(pair_square);
}

StepBound Crowd::bound(double local_damping) const {
  StepBound least;
  if (!unknown_.empty()) return least;
  const double limit = 1 / (1 + local_damping);
  for (const Class& c : classes_) {
    if (!(c.load.stiffness > 0)) continue;
    // h^2 stiffness + h damping = limit.
    const double half =
        2 * limit / (c.load.damping + std::sqrt(c.load.damping * c.load.damping + 4 * limit * c.load.stiffness));
    least = smaller(least, {2 * half, c.id, 0, "", "crowd", false});
  }
  return least;
}

Crowd::Load Crowd::load(uint16_t group, double radius) const {
  Load most;
  for (const Class& c : classes_) {
    if (c.group != group || radius < c.low || radius > c.high) continue;
    most.stiffness = std::max(most.stiffness, c.load.stiffness);
    most.damping = std::max(most.damping, c.load.damping);
  }
  return most;
}

StepBound crowd_at_walls(const Crowd& crowd, const std::vector<Link>& with_walls, const Balls& balls,
                         const std::vector<Wall>& walls, double local_damping) {
  StepBound bound = crowd.bound(local_damping);
  std::vector<const Link*> order;
  for (const Link& link : with_walls) order.push_back(&link);
  std::stable_sort(order.begin(), order.end(), [](const Link* a, const Link* b) { return a->row[0] < b->row[0]; });
  const double limit = 1 / (1 + local_damping);
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    const uint32_t row = order[first]->row[0];
    const double inverse = balls[Column::inverse_mass][row], radius = balls[Column::radius][row];
    const Crowd::Load others = crowd.load(balls.group()[row], radius);
    Block stiffness = others.stiffness * Block::Identity(), damping = others.damping * Block::Identity();
    for (; last < order.size() && order[last]->row[0] == row; ++last) {
      const Link& link = *order[last];
      add_end(stiffness, link, 0, link.kn, link.ks, link.kb, link.kt, inverse, radius);
      add_end(damping, link, 0, link.cn, link.cs, 0, 0, inverse, radius);
    }
    if (bound.step > 0 && stable(stiffness, damping, 0.5 * bound.step, limit)) continue;
    const double high = bound.step > 0 ? 0.5 * bound.step : 1.01 * std::sqrt(limit / nearly_largest(stiffness));
    bound = {2 * largest_stable(stiffness, damping, high, limit),
             balls.id()[row],
             0,
             walls[order[first]->wall].name,
             "crowd",
             false};
  }
  return bound;
}

}  // namespace scree::core
