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
  template <class Class>
  double raise(const BoundRule& rule, double times, Class& most) {
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

}  // namespace

Crowd::Crowd(const RuleBook& book, const Balls& balls, const PeriodicCell& cell, Team& team)
    : loose_(book.groups(), 0) {
  sort(balls);
  if (classes_.size() <= most_classes) look_for_loose(book, balls, cell, team);
}

void Crowd::take(const RuleBook& book, const Balls& balls, double depth, double local_damping) {
  depth_ = depth;
  local_damping_ = local_damping;
  pair_step_ = 0;
  bound_ = {};
  unknown_.clear();
  if (classes_.size() > most_classes) unknown_ = "the balls are of too many groups";
  if (loose_moves_) unknown_ = "balls that move may overlap others without a force";
  if (loose_overlap_ > depth) unknown_ = "fixed balls overlap without a force";
  if (!unknown_.empty()) return;
  sort(balls);
  weigh(book);
  if (unknown_.empty()) find_bound();
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
  std::vector<uint8_t> asked(book.rules.size(), 0);
  bool constant = true, any = false;
  double pair_square = std::numeric_limits<double>::infinity();
  for (Class& c : classes_) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Class& p : classes_) {
      const BoundRule* rule = c.moving == no_row ? nullptr : law_between(book, c.group, p.group);
      if (rule == nullptr) continue;
      if (rule->drawn) return refuse("properties of rule '" + rule->name + "' differ from contact to contact");
      Birth birth;
      birth.row1 = c.moving;
      birth.row2 = p.row;
      birth.mass = 1 / (1 / c.most_mass + (p.fixed ? 0 : 1 / p.most_mass));
      for (const double a : {c.low, c.high})
        for (const double b : {p.low, p.high}) {
          birth.r1 = a;
          birth.r2 = b;
          trials.add(*rule, birth);
        }
      // Weights as the network's where they are equal: a contact with what does not move counts once.
      const double stiffest = trials.raise(*rule, p.moving == no_row ? 1 : 2, c);
      uint8_t& known = asked[static_cast<std::size_t>(rule - book.rules.data())];
      if (known == 0 && trials.remembers(*rule, birth))
        return refuse("the stiffness of rule '" + rule->name + "' follows from what a contact remembers");
      known = 1;
      c.reach = std::max(c.reach, rule->reach);
      smallest = std::min(smallest, p.low);
      constant = constant && (rule->model->flags & SCREE_NONLINEAR) == 0;
      const double yielding = 1 / c.least_mass + (p.moving == no_row ? 0 : 1 / p.least_mass);
      if (stiffest > 0) pair_square = std::min(pair_square, 1 / (stiffest * yielding));
    }
    if (!(c.normal + c.shear + c.bending + c.twist > 0)) continue;
    if (!std::isfinite(c.normal + c.shear + c.bending + c.twist + c.dashpot_normal + c.dashpot_shear))
      return refuse("the stiffness of a contact is not finite");
    find_room(c, smallest);
    if (c.cosine == 0) return refuse("balls are small beside others for so deep an overlap");
    any = true;
  }
  if (!any) return refuse("no ball that moves can touch another");
  if (constant) pair_step_ = 2 * std::sqrt(pair_square);
}

// Of two neighbours at most `far` away and at least `nearest` apart the angle is least where both are far, unless one
// could be much nearer than the other.
void Crowd::find_room(Class& c, double smallest) {
  const double nearest = 2 * smallest * (1 - depth_ / 2), far = c.high + smallest + c.reach;
  if (depth_ * smallest + c.reach > nearest * nearest / far || nearest >= 2 * far) return;
  const double sine = nearest / (2 * far);
  c.cosine = std::sqrt(1 - sine * sine);
}

double Crowd::share(const Class& c, double h) const {
  const double least_arm = c.low * (1 - depth_ / 2), arm = c.low + c.reach / 2, per = 2.5 / (c.low * c.low);
  const double across = h * (h * c.shear + c.dashpot_shear);
  ContactShape one;
  one.along = h * (h * c.normal + c.dashpot_normal);
  // Contacts of shorter arm: (x + t y)^2 with t below 1 is at most (x + y)^2 + (1 - t)/(1 + t) x^2.
  one.across = across * (1 + (arm - least_arm) / (arm + least_arm));
  one.twist = per * h * h * c.twist;
  one.bend = per * (across * arm * arm + h * h * c.bending);
  one.mixed = std::sqrt(per) * across * arm;
  return cap_sum(one, c.cosine) / c.least_mass;
}

void Crowd::find_bound() {
  const double limit = 1 / (1 + local_damping_);
  for (const Class& c : classes_) {
    if (c.cosine == 0) continue;
    double low = 0, high = 1;
    // It grows at most with the square of h.
    while (share(c, high) < limit) high *= 2;
    while (share(c, high) > 4 * limit) high /= 2;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (low + high);
      (share(c, middle) < limit ? low : high) = middle;
    }
    bound_ = smaller(bound_, {2 * low, c.id, 0, "", "crowd", false});
  }
}

double Crowd::share(uint16_t group, double radius, double h) const {
  double most = 0;
  for (const Class& c : classes_)
    if (c.cosine > 0 && c.group == group && radius >= c.low && radius <= c.high) most = std::max(most, share(c, h));
  return most;
}

namespace {

/// A ball at walls: what they add to its block, and the balls round it.
struct AtWalls {
  uint32_t row, wall;
  uint16_t group;
  double radius;
  Block stiffness = Block::Zero(), damping = Block::Zero();
  bool bears(const Crowd& crowd, double h, double limit) const {
    Block all = h * h * stiffness + h * damping;
    all.diagonal().array() += crowd.share(group, radius, h);
    return stable(all, Block::Zero(), 1, limit);
  }
  double size(double h) const { return h * h * stiffness.trace() + h * damping.trace(); }
};

std::vector<AtWalls> balls_at_walls(const std::vector<Link>& links, const Balls& balls) {
  std::vector<const Link*> order;
  for (const Link& link : links) order.push_back(&link);
  std::stable_sort(order.begin(), order.end(), [](const Link* a, const Link* b) { return a->row[0] < b->row[0]; });
  std::vector<AtWalls> all;
  all.reserve(links.size());
  for (const Link* link : order) {
    const uint32_t row = link->row[0];
    if (all.empty() || all.back().row != row)
      all.push_back({row, link->wall, balls.group()[row], balls[Column::radius][row]});
    const double inverse = balls[Column::inverse_mass][row];
    add_end(all.back().stiffness, *link, 0, link->kn, link->ks, link->kb, link->kt, inverse, all.back().radius);
    add_end(all.back().damping, *link, 0, link->cn, link->cs, 0, 0, inverse, all.back().radius);
  }
  return all;
}

}  // namespace

StepBound crowd_at_walls(const Crowd& crowd, const std::vector<Link>& with_walls, const Balls& balls,
                         const std::vector<Wall>& walls, double least) {
  StepBound bound = crowd.bound();
  const double limit = 1 / (1 + crowd.local_damping()), at = 0.5 * bound.step;
  const auto lower = [&](const AtWalls& ball) {
    double low = 0, high = 0.5 * bound.step;
    if (ball.bears(crowd, high, limit)) return;
    for (int k = 0; k < 20; ++k) {
      const double middle = 0.5 * (low + high);
      (ball.bears(crowd, middle, limit) ? low : high) = middle;
    }
    bound = {2 * low, balls.id()[ball.row], 0, walls[ball.wall].name, "crowd", false};
  };
  const std::vector<AtWalls> all = balls_at_walls(with_walls, balls);
  if (all.empty()) return bound;
  // The stiffest first: few of the others lower the step again.
  const AtWalls& stiffest = *std::max_element(
      all.begin(), all.end(), [&](const AtWalls& a, const AtWalls& b) { return a.size(at) < b.size(at); });
  if (least > 0 && !stiffest.bears(crowd, 0.5 * least, limit)) return {};
  lower(stiffest);
  for (const AtWalls& ball : all) lower(ball);
  return bound;
}

}  // namespace scree::core
