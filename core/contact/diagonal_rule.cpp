#include "core/contact/diagonal_rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/contact/run_law.hpp"
#include "core/contact/stages.hpp"

namespace scree::core {

namespace {

class Diagonals {
 public:
  explicit Diagonals(const Balls& balls) : balls_(balls), of_(balls.size()) {}

  void add(std::size_t row, double arm, const Scratch& s, const Tangents& t, uint32_t k) {
    dashpots_ = dashpots_ || t.ratio_normal[k] > 0 || t.ratio_shear[k] > 0;
    const double n[3] = {s.nx[k], s.ny[k], s.nz[k]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double along = n[axis] * n[axis], across = 1 - along;
      of_[row][axis] += t.normal[k] * along + t.shear[k] * across;
      of_[row][3 + axis] += (arm * arm * t.shear[k] + t.bending[k]) * across + t.twist[k] * along;
    }
  }
  DiagonalRule rule() const {
    double square = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < of_.size(); ++row) {
      if (balls_[Column::inverse_mass][row] == 0) continue;
      const double mass = balls_[Column::mass][row], radius = balls_[Column::radius][row];
      for (std::size_t k = 0; k < 6; ++k)
        if (of_[row][k] > 0) square = std::min(square, (k < 3 ? mass : 0.4 * mass * radius * radius) / of_[row][k]);
    }
    return {std::isfinite(square) ? std::sqrt(square) : 0, dashpots_};
  }

 private:
  const Balls& balls_;
  std::vector<std::array<double, 6>> of_;
  bool dashpots_ = false;
};

void add_pairs(Diagonals& sums, const TouchList& list, const BoundRule& rule, const Balls& balls,
               const double (*shift)[3], Scratch& s, Tangents& t) {
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
    tangents(rule, n, list.bonded, s, t);
    for (uint32_t k = 0; k < n; ++k) {
      if (list.active[s.slot[k]] == 0) continue;
      sums.add(s.row[k], view.radius[s.row[k]] + 0.5 * s.gap[k], s, t, k);
      sums.add(s.other[k], view.radius[s.other[k]] + 0.5 * s.gap[k], s, t, k);
    }
  }
}

void add_wall(Diagonals& sums, const WallList& list, const BoundRule& rule, const Balls& balls, Scratch& s,
              Tangents& t) {
  const std::size_t words = rule.memory_words(list.bonded), varying = rule.varying.size();
  for (std::size_t slot = 0; slot < list.slots.size(); ++slot) {
    const WallSlot& contact = list.slots[slot];
    const double radius = balls[Column::radius][contact.row];
    s.nx[0] = contact.normal[0];
    s.ny[0] = contact.normal[1];
    s.nz[0] = contact.normal[2];
    // The overlap is not kept; a law without memory of it reports what it has at first touch.
    s.gap[0] = -1e-6 * radius;
    s.r1[0] = radius;
    s.r2[0] = 0;
    s.mass[0] = balls[Column::mass][contact.row];
    for (std::size_t w = 0; w < words; ++w) s.state[w][0] = list.state[slot * words + w];
    for (std::size_t v = 0; v < varying; ++v) s.property[v][0] = list.property[slot * varying + v];
    tangents(rule, 1, list.bonded, s, t);
    sums.add(contact.row, radius, s, t, 0);
  }
}

}  // namespace

DiagonalRule diagonal_rule(const Contacts& contacts, const Balls& balls, const PeriodicCell& cell) {
  if (!contacts.built()) return {};
  Diagonals sums(balls);
  const ImageShifts shifts(cell);
  const auto scratch = std::make_unique<Scratch>();
  const auto tangents = std::make_unique<Tangents>();
  for (const TouchList& list : contacts.lists())
    add_pairs(sums, list, contacts.book.rules[list.rule], balls, cell.any() ? shifts.of : nullptr, *scratch, *tangents);
  for (const WallList& list : contacts.wall_lists())
    if (contacts.book.rules[list.rule].model != nullptr)
      add_wall(sums, list, contacts.book.rules[list.rule], balls, *scratch, *tangents);
  return sums.rule();
}

}  // namespace scree::core
