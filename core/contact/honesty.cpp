#include "core/contact/honesty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/contact/run_law.hpp"

namespace scree::core {

namespace {

using V = std::array<double, 3>;

double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// One contact in seven copies: as it is, then moved there and back along the normal and two directions across it.
class Copies {
 public:
  static constexpr uint32_t count = 7;
  /// False when the pair is out of reach.
  bool load(const TouchList& list, const BoundRule& rule, const Balls& balls, const PeriodicCell& cell, std::size_t row,
            uint64_t slot, double dt);
  void compare(Honesty& found);

 private:
  double slope(uint32_t direction) const;
  const BoundRule* rule_ = nullptr;
  V axis_[3]{};
  double way_ = 0, dt_ = 0;
  bool bonded_ = false;
  Scratch s_;
};

bool Copies::load(const TouchList& list, const BoundRule& rule, const Balls& balls, const PeriodicCell& cell,
                  std::size_t row, uint64_t slot, double dt) {
  rule_ = &rule;
  bonded_ = list.bonded;
  const ImageShifts shifts(cell);
  const std::size_t other = list.other[slot];
  const double* shift = shifts.of[target::image(list.where[slot])];
  V& n = axis_[0];
  for (std::size_t c = 0; c < 3; ++c) {
    const double* at = balls[static_cast<Column>(static_cast<std::size_t>(Column::x) + c)];
    n[c] = at[other] - at[row] + shift[c];
  }
  const bool flip = (list.where[slot] & target::flip) != 0;
  const double distance = std::sqrt(dot(n, n)), ri = balls[Column::radius][row], rj = balls[Column::radius][other];
  const double gap = distance - ri - rj, depth = std::fabs(gap - rule.reach);
  const double inverse = balls[Column::inverse_mass][row] + balls[Column::inverse_mass][other];
  const bool holds = bonded_ && list.broken[slot] == 0;
  if (!(holds || gap < rule.reach) || !(distance > 0) || !(inverse > 0)) return false;
  for (double& c : n) c *= (flip ? -1.0 : 1.0) / distance;
  const V least = std::fabs(n[0]) < 0.6 ? V{1, 0, 0} : V{0, 1, 0};
  axis_[1] = cross(n, least);
  const double length = std::sqrt(dot(axis_[1], axis_[1]));
  for (double& c : axis_[1]) c /= length;
  axis_[2] = cross(n, axis_[1]);
  // A bond starts where the pieces are, often without any depth.
  way_ = holds ? 1e-9 * std::min(ri, rj) : 1e-5 * depth;
  // A long step: what dashpots add fades beside the springs.
  dt_ = 1e4 * dt;
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t direction = k == 0 ? 0 : (k - 1) / 2;
    const double step = k == 0 ? 0.0 : k % 2 == 1 ? way_ : -way_;
    const V& axis = axis_[direction];
    s_.nx[k] = n[0];
    s_.ny[k] = n[1];
    s_.nz[k] = n[2];
    s_.gap[k] = gap + (direction == 0 ? step : 0.0);
    s_.vx[k] = axis[0] * step / dt_;
    s_.vy[k] = axis[1] * step / dt_;
    s_.vz[k] = axis[2] * step / dt_;
    s_.wx[k] = s_.wy[k] = s_.wz[k] = s_.tx[k] = s_.ty[k] = s_.tz[k] = 0;
    s_.r1[k] = flip ? rj : ri;
    s_.r2[k] = flip ? ri : rj;
    s_.mass[k] = 1 / inverse;
    for (std::size_t w = 0; w < list.state.size(); ++w) s_.state[w][k] = list.state[w][slot];
    for (std::size_t v = 0; v < list.property.size(); ++v) s_.property[v][k] = list.property[v][slot];
  }
  return true;
}

// The steeper side: a law may be stiffer one way than the other.
double Copies::slope(uint32_t direction) const {
  const V& axis = axis_[direction];
  const auto force = [&](uint32_t k) { return dot({s_.fx[k], s_.fy[k], s_.fz[k]}, axis); };
  const uint32_t there = 1 + 2 * direction;
  return std::max((force(0) - force(there)) / way_, (force(there + 1) - force(0)) / way_);
}

void Copies::compare(Honesty& found) {
  Tangents t;
  tangents(*rule_, count, bonded_, s_, t);
  const double normal = *std::max_element(t.normal, t.normal + count),
               shear = *std::max_element(t.shear, t.shear + count);
  // What throws or breaks shows no slope.
  if (run_law(*rule_, count, {dt_, bonded_, false}, s_) != 0) return;
  const auto part = [&](const char* name, double reported, double measured) {
    const Honesty one{found.rule, found.id1, found.id2, name, reported, measured};
    if (one.share() > found.share()) found = one;
  };
  // What a law gives for almost no stiffness at all is rounding beside the other part.
  part("normal", std::max(normal, 1e-6 * shear), slope(0));
  if (!rule_->normal_only()) part("shear", std::max(shear, 1e-6 * normal), std::max(slope(1), slope(2)));
}

}  // namespace

double Honesty::share() const {
  if (!(measured > 0)) return 0;
  return reported > 0 ? measured / reported : std::numeric_limits<double>::infinity();
}

Honesty look_at_stiffness(const Contacts& contacts, const Balls& balls, const PeriodicCell& cell, uint64_t at,
                          double dt) {
  Honesty found;
  for (std::size_t index = 0; index < contacts.lists().size(); ++index) {
    const TouchList& list = contacts.lists()[index];
    if (at >= list.size()) {
      at -= list.size();
      continue;
    }
    const BoundRule& rule = contacts.book.rules[list.rule];
    if (rule.model == nullptr || list.active[at] == 0 || !(dt > 0)) return found;
    const uint64_t* begin = list.begin.data();
    const auto row = static_cast<std::size_t>(std::upper_bound(begin, begin + list.begin.size(), at) - begin - 1);
    const auto copies = std::make_unique<Copies>();
    found.rule = list.rule;
    found.id1 = std::min(balls.id()[row], balls.id()[list.other[at]]);
    found.id2 = std::max(balls.id()[row], balls.id()[list.other[at]]);
    if (copies->load(list, rule, balls, cell, row, at, dt)) copies->compare(found);
    return found;
  }
  return found;
}

}  // namespace scree::core
