#include "core/contact/touch_list.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/bond_table.hpp"

namespace scree::core {

uint32_t find_slot(const TouchList& list, uint32_t a, uint32_t b) {
  const uint32_t low = std::min(a, b), high = std::max(a, b);
  if (static_cast<std::size_t>(low) + 1 >= list.begin.size()) return no_slot;
  const uint32_t* first = list.other.data() + list.begin[low];
  const uint32_t* last = list.other.data() + list.begin[low + 1];
  const uint32_t* at = last - first > 16 ? std::lower_bound(first, last, high) : std::find(first, last, high);
  return at != last && *at == high ? static_cast<uint32_t>(at - list.other.data()) : no_slot;
}

namespace {

// A place below the size of the column itself is one in it, the next ones are in `beyond`; the rest is new.
template <class T>
Array<T> moved_column(const Array<T>& column, const Array<T>* beyond, const Array<uint32_t>& from, Team& team) {
  Array<T> fresh;
  fresh.resize_for_overwrite(from.size());
  constexpr std::size_t part = 8192;
  const std::size_t own = column.size(), all = own + (beyond != nullptr ? beyond->size() : 0);
  team.each_block((from.size() + part - 1) / part, [&](std::size_t p) {
    for (std::size_t k = p * part; k < std::min(from.size(), (p + 1) * part); ++k) {
      const std::size_t at = from[k];
      fresh[k] = at < own ? column[at] : at < all ? (*beyond)[at - own] : T{};
    }
  });
  return fresh;
}

template <class T>
const Array<T>* at(const std::vector<Array<T>>& columns, std::size_t index) {
  return index < columns.size() ? &columns[index] : nullptr;
}

double shifted(double separation, uint32_t image, int axis, const PeriodicCell& cell) {
  const uint32_t code = (image >> (2 * axis)) & 3u;
  return code == 0 ? separation : separation + (code == 1 ? cell.length(axis) : -cell.length(axis));
}

// How many bonds the pair had before the one that it has or had last.
uint64_t bondings(const Carry& carry, const Birth& birth, bool bonded) {
  if (carry.breaks == nullptr || carry.breaks->empty()) return 0;
  const uint64_t *id = carry.balls->id(), a = id[birth.row1], b = id[birth.row2];
  const auto found = carry.breaks->find({std::min(a, b), std::max(a, b)});
  if (found == carry.breaks->end()) return 0;
  return bonded ? found->second : found->second - 1;
}

Birth birth_of(const Carry& carry, uint32_t low, uint32_t high, uint32_t image, bool bonded) {
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
  birth.bonding = bondings(carry, birth, bonded);
  return birth;
}

// Slots of this rule: count, then fill; also where each came from.
void select(const Carry& carry, uint16_t rule, TouchList& fresh, Array<uint32_t>& from, const TouchList& old,
            const TouchList& bonded) {
  const Balls& balls = *carry.balls;
  const PairTable& pairs = *carry.pairs;
  const uint16_t* group = balls.group();
  const uint64_t* id = balls.id();
  const std::size_t rows = balls.size();
  const auto fits = [&](std::size_t row, uint64_t k) {
    return carry.book->balls(group[row], group[pairs.other[k]]) == rule &&
           !carry.bonds->holds(static_cast<uint32_t>(row), pairs.other[k]);
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
      const uint32_t other = pairs.other[k], me = static_cast<uint32_t>(row);
      fresh.other[slot] = other;
      fresh.where[slot] =
          static_cast<uint32_t>(pairs.image[k]) << target::image_shift | (id[row] > id[other] ? target::flip : 0u);
      const uint32_t a = moved ? (*carry.old_row)[me] : me, b = moved ? (*carry.old_row)[other] : other;
      uint32_t place = find_slot(old, a, b);
      if (place == no_slot && bonded.size() > 0)
        if (const uint32_t broken = find_slot(bonded, a, b); broken != no_slot)
          place = static_cast<uint32_t>(old.size()) + broken;
      from[slot] = place;
      ++slot;
    }
  }
}

// A pair that is bonded anew draws its properties anew; `kept` slots came from the list itself.
void give_properties(TouchList& list, const BoundRule& rule, const Carry& carry, const Array<uint32_t>& from,
                     std::size_t kept) {
  if (rule.varying.empty()) return;
  std::vector<double> words(rule.words.size());
  for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
    for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
      if (from[slot] < kept && !list.stale) continue;
      words = rule.words;
      rule.vary(
          birth_of(carry, static_cast<uint32_t>(row), list.other[slot], target::image(list.where[slot]), list.bonded),
          words.data());
      for (std::size_t v = 0; v < rule.varying.size(); ++v) list.property[v][slot] = words[rule.varying[v]];
    }
}

// The image through which two wrapped centres are nearest.
uint32_t nearest_image(const Balls& balls, const PeriodicCell& cell, uint32_t low, uint32_t high) {
  uint32_t image = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!cell.periodic[axis]) continue;
    const double* x = balls[static_cast<Column>(static_cast<int>(Column::x) + axis)];
    const double apart = x[high] - x[low], half = 0.5 * cell.length(axis);
    image |= (apart < -half ? 1u : apart > half ? 2u : 0u) << (2 * axis);
  }
  return image;
}

}  // namespace

std::size_t TouchList::bytes() const {
  std::size_t sum = begin.bytes() + other.bytes() + where.bytes() + active.bytes() + broken.bytes() + dashpot.bytes();
  for (const auto& column : state) sum += column.bytes();
  for (const auto& column : property) sum += column.bytes();
  for (const auto& column : report) sum += column.bytes();
  return sum;
}

void rebuild(TouchList& list, const TouchList& bonded, const Carry& carry, Team& team) {
  const BoundRule& rule = carry.book->rules[list.rule];
  TouchList fresh;
  Array<uint32_t> from;
  select(carry, list.rule, fresh, from, list, bonded);
  const std::size_t before = list.size(), kept = before + bonded.size();
  // Column by column, so that at most one of them exists twice.
  list.begin.swap(fresh.begin);
  list.other.swap(fresh.other);
  list.where.swap(fresh.where);
  fresh = TouchList();
  list.state.resize(rule.state_words());
  list.property.resize(rule.varying.size());
  const auto follow = [&](auto& column, const auto* beyond) {
    if (column.size() != before) column = std::decay_t<decltype(column)>(before);
    column = moved_column(column, beyond, from, team);
  };
  follow(list.active, &bonded.active);
  if (list.dashpot.size() + bonded.dashpot.size() > 0) follow(list.dashpot, &bonded.dashpot);
  for (std::size_t w = 0; w < list.state.size(); ++w) follow(list.state[w], at(bonded.state, w));
  for (std::size_t v = 0; v < list.property.size(); ++v) follow(list.property[v], at(bonded.property, v));
  for (auto& column : list.report) column.resize(list.size());
  give_properties(list, rule, carry, from, kept);
  list.stale = false;
}

TouchList rebuilt_bonds(const TouchList& old, const TouchList& touch, const Carry& carry, Team& team) {
  const Balls& balls = *carry.balls;
  const BoundRule& rule = carry.book->rules[old.rule];
  TouchList list;
  list.rule = old.rule;
  list.bonded = true;
  list.stale = old.stale;
  std::size_t count = 0;
  for (const BondTable::Pair& pair : carry.bonds->pairs) count += pair.rule == old.rule;
  if (count == 0) return list;
  list.begin = Array<uint64_t>(balls.size() + 1);
  list.other.resize_for_overwrite(count);
  list.where.resize_for_overwrite(count);
  list.broken = Array<uint8_t>(count);
  Array<uint32_t> from;
  from.resize_for_overwrite(count);
  std::size_t slot = 0;
  for (const BondTable::Pair& pair : carry.bonds->pairs) {
    if (pair.rule != old.rule) continue;
    ++list.begin[pair.low + 1];
    list.other[slot] = pair.high;
    list.where[slot] = nearest_image(balls, *carry.cell, pair.low, pair.high) << target::image_shift |
                       (balls.id()[pair.low] > balls.id()[pair.high] ? target::flip : 0u);
    from[slot++] = pair.from;
  }
  for (std::size_t row = 1; row < list.begin.size(); ++row) list.begin[row] += list.begin[row - 1];
  const std::size_t words = rule.memory_words(true);
  const Array<double> nothing(old.size());
  list.active = moved_column(old.active, &touch.active, from, team);
  if (old.dashpot.size() == old.size() && touch.dashpot.size() > 0)
    list.dashpot = moved_column(old.dashpot, &touch.dashpot, from, team);
  for (std::size_t w = 0; w < words; ++w)
    list.state.push_back(moved_column(w < old.state.size() ? old.state[w] : nothing, at(touch.state, w), from, team));
  for (std::size_t v = 0; v < rule.varying.size(); ++v)
    list.property.push_back(
        moved_column(v < old.property.size() ? old.property[v] : nothing, at(touch.property, v), from, team));
  if (!touch.report.empty()) list.report.assign(touch.report.size(), Array<double>(count));
  give_properties(list, rule, carry, from, old.size());
  list.stale = false;
  return list;
}

}  // namespace scree::core
