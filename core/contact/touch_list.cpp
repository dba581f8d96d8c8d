#include "core/contact/touch_list.hpp"

#include <algorithm>
#include <cmath>

namespace scree::core {

namespace {

constexpr uint32_t no_slot = std::numeric_limits<uint32_t>::max();

uint32_t find(const TouchList& list, uint32_t a, uint32_t b) {
  const uint32_t low = std::min(a, b), high = std::max(a, b);
  if (static_cast<std::size_t>(low) + 1 >= list.begin.size()) return no_slot;
  const uint32_t* first = list.other.data() + list.begin[low];
  const uint32_t* last = list.other.data() + list.begin[low + 1];
  const uint32_t* at = last - first > 16 ? std::lower_bound(first, last, high) : std::find(first, last, high);
  return at != last && *at == high ? static_cast<uint32_t>(at - list.other.data()) : no_slot;
}

template <class T>
void move_column(Array<T>& column, const Array<uint32_t>& from, Team& team) {
  Array<T> fresh;
  fresh.resize_for_overwrite(from.size());
  constexpr std::size_t part = 8192;
  team.each_block((from.size() + part - 1) / part, [&](std::size_t p) {
    for (std::size_t k = p * part; k < std::min(from.size(), (p + 1) * part); ++k)
      fresh[k] = from[k] >= column.size() ? T{} : column[from[k]];
  });
  column.swap(fresh);
}

double shifted(double separation, uint32_t image, int axis, const PeriodicCell& cell) {
  const uint32_t code = (image >> (2 * axis)) & 3u;
  return code == 0 ? separation : separation + (code == 1 ? cell.length(axis) : -cell.length(axis));
}

Birth birth_of(const Carry& carry, uint32_t low, uint32_t high, uint32_t image) {
  const Balls& balls = *carry.balls;
  const double *x = balls[Column::x], *y = balls[Column::y], *z = balls[Column::z], *radius = balls[Column::radius];
  const double* inverse = balls[Column::inverse_mass];
  Birth birth;
  const bool flip = balls.id()[low] > balls.id()[high];
  birth.row1 = flip ? high : low;
  birth.row2 = flip ? low : high;
  birth.r1 = radius[birth.row1];
  birth.r2 = radius[birth.row2];
  const double inverse_sum = inverse[low] + inverse[high];
  birth.mass = inverse_sum > 0 ? 1.0 / inverse_sum : 0.0;
  const double share = radius[low] / (radius[low] + radius[high]);
  birth.x = x[low] + share * shifted(x[high] - x[low], image, 0, *carry.cell);
  birth.y = y[low] + share * shifted(y[high] - y[low], image, 1, *carry.cell);
  birth.z = z[low] + share * shifted(z[high] - z[low], image, 2, *carry.cell);
  return birth;
}

// Slots of this rule: count, then fill; also where each came from.
void select(const Carry& carry, uint16_t rule, TouchList& fresh, Array<uint32_t>& from, const TouchList& old) {
  const Balls& balls = *carry.balls;
  const PairTable& pairs = *carry.pairs;
  const uint16_t* group = balls.group();
  const uint64_t* id = balls.id();
  const std::size_t rows = balls.size();
  const auto fits = [&](std::size_t row, uint64_t k) {
    return carry.book->balls(group[row], group[pairs.other[k]]) == rule;
  };
  fresh.begin = Array<uint64_t>(rows + 1);
  for (std::size_t row = 0; row < rows; ++row) {
    uint64_t count = 0;
    for (uint64_t k = pairs.begin[row]; k < pairs.begin[row + 1]; ++k) count += fits(row, k);
    fresh.begin[row + 1] = fresh.begin[row] + count;
  }
  const std::size_t total = fresh.begin[rows];
  fresh.other.resize_for_overwrite(total);
  fresh.where.resize_for_overwrite(total);
  from.resize_for_overwrite(total);
  const bool moved = !carry.old_row->empty();
  for (std::size_t row = 0; row < rows; ++row) {
    uint64_t slot = fresh.begin[row];
    for (uint64_t k = pairs.begin[row]; k < pairs.begin[row + 1]; ++k) {
      if (!fits(row, k)) continue;
      const uint32_t other = pairs.other[k];
      fresh.other[slot] = other;
      fresh.where[slot] =
          static_cast<uint32_t>(pairs.image[k]) << target::image_shift | (id[row] > id[other] ? target::flip : 0u);
      const auto me = static_cast<uint32_t>(row);
      from[slot] = moved ? find(old, (*carry.old_row)[me], (*carry.old_row)[other]) : find(old, me, other);
      ++slot;
    }
  }
}

void give_properties(TouchList& list, const BoundRule& rule, const Carry& carry, const Array<uint32_t>& from) {
  if (rule.varying.empty()) return;
  std::vector<double> words(rule.words.size());
  for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
    for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
      if (from[slot] != no_slot && !list.stale) continue;
      words = rule.words;
      rule.vary(birth_of(carry, static_cast<uint32_t>(row), list.other[slot], target::image(list.where[slot])),
                words.data());
      for (std::size_t v = 0; v < rule.varying.size(); ++v) list.property[v][slot] = words[rule.varying[v]];
    }
}

}  // namespace

std::size_t TouchList::bytes() const {
  std::size_t sum = begin.bytes() + other.bytes() + where.bytes() + active.bytes();
  for (const auto& column : state) sum += column.bytes();
  for (const auto& column : property) sum += column.bytes();
  for (const auto& column : report) sum += column.bytes();
  return sum;
}

void rebuild(TouchList& list, uint16_t index, const Carry& carry, Team& team) {
  const BoundRule& rule = carry.book->rules[index];
  TouchList fresh;
  Array<uint32_t> from;
  select(carry, index, fresh, from, list);
  // Column by column, so that at most one of them exists twice.
  list.begin.swap(fresh.begin);
  list.other.swap(fresh.other);
  list.where.swap(fresh.where);
  fresh = TouchList();
  list.state.resize(rule.state_words());
  list.property.resize(rule.varying.size());
  move_column(list.active, from, team);
  for (auto& column : list.state) move_column(column, from, team);
  for (auto& column : list.property) move_column(column, from, team);
  for (auto& column : list.report) column.resize(list.size());
  give_properties(list, rule, carry, from);
  list.stale = false;
}

}  // namespace scree::core
