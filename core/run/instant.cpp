#include "core/run/instant.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace scree::core {

namespace {

using V = std::array<double, 3>;

double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

template <class F>
void each_active(const TouchList& list, F act) {
  for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
    for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot)
      if (list.active[slot] != 0) act(row, list.other[slot], slot);
}

V centre(const Balls& balls, std::size_t row) {
  return {balls[Column::x][row], balls[Column::y][row], balls[Column::z][row]};
}

/// From the lower row to the image of the higher one that the pair meets.
V separation(const Engine& engine, std::size_t row, uint32_t other, uint32_t image) {
  const V a = centre(engine.balls, row), b = centre(engine.balls, other);
  V d{};
  for (std::size_t c = 0; c < 3; ++c) {
    const uint32_t code = (image >> (2 * c)) & 3u;
    const double edge = code == 0 ? 0.0 : engine.cell.length(static_cast<int>(c));
    d[c] = b[c] - a[c] + (code == 2 ? -edge : edge);
  }
  return d;
}

/// Gaps of the active contacts of a list, in the order of its slots. The pass keeps only those of bonds, so the wall is
/// asked.
std::vector<double> wall_gaps(const Engine& engine, const WallList& list) {
  const Wall& wall = engine.walls[list.wall];
  const double* radius = engine.balls[Column::radius];
  std::vector<double> gaps(list.slots.size(), 0.0);
  if (list.bonded) {
    for (std::size_t k = 0; k < gaps.size(); ++k) gaps[k] = list.bonds[k].distance - radius[list.slots[k].row];
    return gaps;
  }
  std::vector<uint32_t> rows;
  for (const WallSlot& slot : list.slots)
    if (rows.empty() || rows.back() != slot.row) rows.push_back(slot.row);
  const std::size_t n = rows.size();
  std::vector<double> at[3], reach(n);
  for (auto& column : at) column.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const V local = wall.to_frame(centre(engine.balls, rows[k]));
    for (std::size_t c = 0; c < 3; ++c) at[c][k] = local[c];
    reach[k] = radius[rows[k]] + engine.contacts.book.rules[list.rule].reach;
  }
  std::vector<uint32_t> ball, patch;
  std::vector<double> normal[3], distance;
  uint32_t count = 0;
  for (std::size_t room = 2 * list.slots.size() + 8; count == 0 || count > ball.size(); room = count) {
    for (auto* words : {&ball, &patch}) words->resize(room);
    for (auto* column : {&normal[0], &normal[1], &normal[2], &distance}) column->resize(room);
    const scree_touches touches{sizeof(scree_touches), static_cast<uint32_t>(room),
                                ball.data(),           patch.data(),
                                normal[0].data(),      normal[1].data(),
                                normal[2].data(),      distance.data()};
    count = wall.touch(static_cast<uint32_t>(n), at[0].data(), at[1].data(), at[2].data(), reach.data(), touches);
    if (count == 0) break;
  }
  for (uint32_t t = 0; t < count; ++t) {
    const auto key = std::pair(rows[ball[t]], patch[t]);
    const auto slot = std::lower_bound(
        list.slots.begin(), list.slots.end(), key,
        [](const WallSlot& s, const std::pair<uint32_t, uint32_t>& k) { return std::pair(s.row, s.patch) < k; });
    if (slot != list.slots.end() && std::pair(slot->row, slot->patch) == key)
      gaps[static_cast<std::size_t>(slot - list.slots.begin())] = distance[t] - radius[slot->row];
  }
  return gaps;
}

}  // namespace

double ActiveContact::normal_force() const { return dot(force, normal); }

double ActiveContact::shear_force() const {
  const double along = normal_force();
  V rest{};
  for (std::size_t c = 0; c < 3; ++c) rest[c] = force[c] - along * normal[c];
  return std::sqrt(dot(rest, rest));
}

void Instant::refresh() {
  const Moment now{engine_.clock.cycle, engine_.contact_updates(), engine_.rebuilds(), engine_.balls.size(),
                   engine_.clock.dt_back};
  if (known_ && now == moment_) return;
  known_ = true;
  moment_ = now;
  ++stamp_;
  observed_ = counted_ = sorted_ = listed_ = overlap_known_ = false;
}

uint64_t Instant::stamp() {
  refresh();
  return stamp_;
}

const Observation& Instant::observation() {
  refresh();
  if (!observed_) seen_ = &engine_.observe();
  observed_ = true;
  return *seen_;
}

const std::vector<uint32_t>& Instant::contacts_of_balls() {
  refresh();
  if (counted_) return counts_;
  counts_.assign(engine_.balls.size(), 0);
  for (const TouchList& list : engine_.contacts.lists())
    each_active(list, [&](std::size_t row, uint32_t other, uint64_t) {
      ++counts_[row];
      ++counts_[other];
    });
  for (const WallList& list : engine_.contacts.wall_lists())
    for (const WallSlot& slot : list.slots) ++counts_[slot.row];
  counted_ = true;
  return counts_;
}

uint64_t Instant::between_balls() { return engine_.contacts.active(); }

uint64_t Instant::with_walls() {
  uint64_t sum = 0;
  for (const WallList& list : engine_.contacts.wall_lists()) sum += list.slots.size();
  return sum;
}

double Instant::overlap() {
  refresh();
  if (overlap_known_) return overlap_;
  overlap_ = engine_.largest_overlap();
  for (const WallList& list : engine_.contacts.wall_lists()) {
    if (list.slots.empty()) continue;
    const std::vector<double> gaps = wall_gaps(engine_, list);
    for (std::size_t k = 0; k < gaps.size(); ++k)
      overlap_ = std::max(overlap_, -gaps[k] / engine_.balls[Column::radius][list.slots[k].row]);
  }
  overlap_known_ = true;
  return overlap_;
}

void Instant::add_pairs(const TouchList& list) {
  const Balls& balls = engine_.balls;
  const double* radius = balls[Column::radius];
  each_active(list, [&](std::size_t row, uint32_t other, uint64_t slot) {
    ActiveContact one;
    const V d = separation(engine_, row, other, target::image(list.where[slot]));
    const double distance = std::sqrt(dot(d, d)), gap = distance - (radius[row] + radius[other]);
    const double sign = balls.id()[row] < balls.id()[other] ? 1.0 : -1.0, per = distance > 0 ? 1 / distance : 0.0;
    const double arm = radius[row] + 0.5 * gap;
    const V from = centre(balls, row);
    one.id1 = std::min(balls.id()[row], balls.id()[other]);
    one.id2 = std::max(balls.id()[row], balls.id()[other]);
    one.overlap = -gap;
    for (std::size_t c = 0; c < 3; ++c) {
      one.normal[c] = sign * d[c] * per;
      one.point[c] = from[c] + arm * d[c] * per;
      one.force[c] = list.report[c][slot];
      one.moment[c] = list.report[3 + c][slot];
    }
    one.sliding = list.report[6][slot] != 0;
    one.bonded = list.bonded && list.broken[slot] == 0;
    contacts_.push_back(one);
  });
}

void Instant::add_walls(std::size_t index) {
  const WallList& list = engine_.contacts.wall_lists()[index];
  if (list.slots.empty()) return;
  const std::vector<double> gaps = wall_gaps(engine_, list);
  for (std::size_t k = 0; k < list.slots.size(); ++k) {
    const WallSlot& slot = list.slots[k];
    const double* report = list.report.data() + k * WallList::report_words;
    ActiveContact one;
    one.id1 = engine_.balls.id()[slot.row];
    one.wall = list.wall;
    one.patch = slot.patch;
    one.normal = slot.normal;
    one.overlap = -gaps[k];
    for (std::size_t c = 0; c < 3; ++c) {
      one.force[c] = report[c];
      one.moment[c] = report[3 + c];
      one.point[c] = report[7 + c];
    }
    one.sliding = report[6] != 0;
    one.bonded = list.bonded;
    contacts_.push_back(one);
  }
}

const std::vector<ActiveContact>& Instant::contacts() {
  refresh();
  if (listed_) return contacts_;
  contacts_.clear();
  const Contacts& all = engine_.contacts;
  bool reported = engine_.report_wanted;
  for (const TouchList& list : all.lists())
    reported = reported && (list.size() == 0 || (list.report.size() == 7 && list.report[0].size() == list.size()));
  for (const WallList& list : all.wall_lists())
    reported = reported && list.report.size() == list.slots.size() * WallList::report_words;
  if (!reported && between_balls() + with_walls() > 0)
    throw Refusal(Exit::internal, "cycle " + std::to_string(engine_.clock.cycle) +
                                      ": contact forces were not kept in this cycle, yet they are to be read");
  for (const TouchList& list : all.lists()) add_pairs(list);
  for (std::size_t k = 0; k < all.wall_lists().size(); ++k) add_walls(k);
  std::sort(contacts_.begin(), contacts_.end(), [](const ActiveContact& a, const ActiveContact& b) {
    return std::tie(a.id1, a.id2, a.wall, a.patch) < std::tie(b.id1, b.id2, b.wall, b.patch);
  });
  listed_ = true;
  return contacts_;
}

const std::vector<uint32_t>& Instant::order() {
  refresh();
  if (sorted_) return order_;
  const uint64_t* id = engine_.balls.id();
  order_.resize(engine_.balls.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) { return id[a] < id[b]; });
  sorted_ = true;
  return order_;
}

uint32_t Instant::row_of(uint64_t id) {
  const uint64_t* ids = engine_.balls.id();
  const std::size_t n = engine_.balls.size();
  const auto hint = row_hint_.find(id);
  if (hint != row_hint_.end() && hint->second < n && ids[hint->second] == id) return hint->second;
  const auto row = static_cast<std::size_t>(std::find(ids, ids + n, id) - ids);
  if (row == n) return no_row;
  row_hint_[id] = static_cast<uint32_t>(row);
  return static_cast<uint32_t>(row);
}

}  // namespace scree::core
