#include "core/contact/links.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/contact/impact_limit.hpp"
#include "core/contact/run_law.hpp"
#include "core/contact/wall_touches.hpp"

namespace scree::core {

namespace {

// The rule of a list of pairs.
const BoundRule& rule_of(const Contacts& contacts, std::size_t list) {
  return contacts.book.rules[contacts.lists()[list].rule];
}

/// Gathers the links of one block of rows at a time. One per thread.
class Gatherer {
 public:
  Gatherer(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls, const PeriodicCell& cell,
           const LinkQuery& query, std::size_t first, std::size_t last, const LinkSink* sink)
      : contacts_(contacts),
        balls_(balls),
        view_(balls),
        walls_(walls),
        shifts_(cell),
        periodic_(cell.any()),
        query_(query),
        first_(first),
        last_(last),
        sink_(sink) {}

  void pairs(std::size_t block, Links& out);
  void walls(std::size_t index, Links& out);

 private:
  bool holds(std::size_t row) const { return row >= first_ && row < last_; }
  bool concerns(const TouchList& list, std::size_t block) const;
  void list(std::size_t index, std::size_t block, Links& out);
  void batch(const BoundRule& rule, uint32_t n, Links& out);
  void limits(const BoundRule& rule, uint32_t n, Links& out);
  void fill(const BoundRule& rule, uint32_t n, const double* gap);
  void keep(Links& out) const;
  void lower(StepBound& held, double step, const char* term, uint32_t k) const;
  void load(const BoundRule& rule, const Wall& wall, uint32_t row, uint32_t touch, uint32_t k);
  void place(const Wall& wall, uint32_t row, uint32_t touch, uint32_t k);
  void wall_bonds(const WallList& list, Links& out);
  bool bonded() const { return bonded_ != nullptr || glued_; }

  const Contacts& contacts_;
  const Balls& balls_;
  const BallView view_;
  const std::vector<Wall>& walls_;
  const ImageShifts shifts_;
  const bool periodic_;
  const LinkQuery query_;
  const std::size_t first_, last_;
  const LinkSink* sink_;
  std::size_t block_ = 0;
  LinkColumns columns_;
  Scratch s_;
  Tangents t_;
  WallTouches touches_;
  std::vector<uint8_t> nobody_;
  uint32_t wall_ = no_row;             ///< of the batch; no_row for pairs of balls
  const TouchList* bonded_ = nullptr;  ///< of the batch, when its pairs are bonded
  bool glued_ = false;                 ///< the batch is of balls that are bonded to a wall
};

// Does the block own a pair with an end among the rows that are asked about?
bool Gatherer::concerns(const TouchList& list, std::size_t block) const {
  const std::size_t begin = block * block_rows, end = std::min(balls_.size(), begin + block_rows);
  if (begin < last_ && end > first_) return true;
  const uint32_t* other = list.other.data();
  return std::any_of(other + list.begin[begin], other + list.begin[end], [&](uint32_t row) { return holds(row); });
}

void Gatherer::pairs(std::size_t block, Links& out) {
  wall_ = no_row;
  glued_ = false;
  for (std::size_t index = 0; index < contacts_.lists().size(); ++index) {
    const TouchList& list = contacts_.lists()[index];
    if (rule_of(contacts_, index).model != nullptr && list.size() > 0 && concerns(list, block))
      this->list(index, block, out);
  }
}

void Gatherer::list(std::size_t index, std::size_t block, Links& out) {
  const TouchList& list = contacts_.lists()[index];
  const BoundRule& rule = rule_of(contacts_, index);
  bonded_ = list.bonded ? &list : nullptr;
  const StageTable& stage = stages(contacts_.isa);
  const std::size_t begin = block * block_rows, end = std::min(balls_.size(), begin + block_rows);
  // The filter marks which active contacts have ended; here none is active, and none is marked.
  if (nobody_.size() < list.size()) nobody_.resize(list.size(), 0);
  // Whatever is listed may collide or be bonded; else only what may touch before the next estimate counts.
  const bool all = bonded_ != nullptr || query_.impact_share > 0;
  const FilterInput near{list.begin.data(), list.other.data(), list.where.data(), periodic_ ? shifts_.of : nullptr,
                         all ? std::numeric_limits<double>::infinity() : rule.reach + query_.margin};
  block_ = block;
  if (sink_ == nullptr) out.links.reserve(out.links.size() + (list.begin[end] - list.begin[begin]));
  Cursor cursor{list.begin[begin], begin, end};
  while (cursor.row < cursor.last_row) {
    uint32_t drops[Scratch::padded], dropped = 0;
    const uint32_t n = stage.filter[periodic_](view_, near, cursor, nobody_.data(), s_, drops, dropped);
    if (n == 0) continue;
    stage.geometry[0][0](view_, n, 0.0, 1.0, s_);
    for (std::size_t v = 0; v < list.property.size(); ++v)
      for (uint32_t k = 0; k < n; ++k) s_.property[v][k] = list.property[v][s_.slot[k]];
    for (std::size_t w = 0; w < list.state.size(); ++w)
      for (uint32_t k = 0; k < n; ++k) s_.state[w][k] = list.state[w][s_.slot[k]];
    batch(rule, n, out);
  }
}

void Gatherer::batch(const BoundRule& rule, uint32_t n, Links& out) {
  // A bond is no collision.
  if (!bonded() && (query_.impact_share > 0 || query_.birth_depth > 0)) limits(rule, n, out);
  // The deepest that a pair can get before the next estimate: laws that stiffen are taken at the stiffness of then.
  double gap[Scratch::size];
  std::copy_n(s_.gap, n, gap);
  for (uint32_t k = 0; k < n; ++k) s_.gap[k] -= query_.margin;
  tangents(rule, n, bonded(), s_, t_);
  std::copy_n(gap, n, s_.gap);
  fill(rule, n, gap);
  if (sink_ != nullptr && wall_ == no_row)
    (*sink_)(block_, columns_);
  else
    keep(out);
}

void Gatherer::lower(StepBound& held, double step, const char* term, uint32_t k) const {
  if (!(step > 0) || (held.step > 0 && held.step <= step)) return;
  held = {step, balls_.id()[s_.row[k]], 0, "", term, false};
  if (wall_ == no_row)
    held.other = balls_.id()[s_.other[k]];
  else
    held.wall = walls_[wall_].name;
}

void Gatherer::limits(const BoundRule& rule, uint32_t n, Links& out) {
  double opening[Scratch::size], speed[Scratch::size], peak[Scratch::size];
  double soonest = out.kinematic.step > 0 ? out.kinematic.step : std::numeric_limits<double>::infinity();
  if (query_.birth_depth == 0) soonest = 0;
  bool any = false;
  for (uint32_t k = 0; k < n; ++k) {
    opening[k] = s_.vx[k] * s_.nx[k] + s_.vy[k] * s_.ny[k] + s_.vz[k] * s_.nz[k];
    speed[k] = std::fabs(opening[k]);
    any = any || speed[k] > 0;
    const double least = wall_ == no_row ? std::min(s_.r1[k], s_.r2[k]) : s_.r1[k];
    // A division only for those that may be the first.
    if (opening[k] < 0 && query_.birth_depth * least < soonest * speed[k]) {
      lower(out.kinematic, query_.birth_depth * least / speed[k], "kinematic", k);
      soonest = out.kinematic.step;
    }
  }
  if (!any || query_.impact_share == 0) return;
  tangents(rule, n, false, s_, t_);
  double now[Scratch::size];
  std::copy_n(t_.normal, n, now);
  peak_stiffness(rule, n, speed, t_, s_, peak);
  for (uint32_t k = 0; k < n; ++k)
    if (s_.mass[k] > 0 && peak[k] > 0 && collides(s_.gap[k] - rule.reach, opening[k], s_.mass[k], now[k]))
      lower(out.impact, query_.impact_share * 2 * std::sqrt(s_.mass[k] / peak[k]), "pair", k);
}

// The links of a batch, which touch at `gap` or could: first which, then column by column, so that vectors hold them.
void Gatherer::fill(const BoundRule& rule, uint32_t n, const double* gap) {
  uint32_t which[Scratch::size], m = 0;
  const double near = rule.reach + query_.margin;
  const bool pairs = wall_ == no_row;
  for (uint32_t k = 0; k < n; ++k) {
    const bool bond = glued_ || (bonded_ != nullptr && bonded_->broken[s_.slot[k]] == 0);
    const bool asked = holds(s_.row[k]) || (pairs && holds(s_.other[k]));
    which[m] = k;
    m += asked && (bond || !(gap[k] >= near)) && s_.mass[k] > 0;
  }
  LinkColumns& to = columns_;
  to.count = m;
  const double *radius = view_.radius, most = bonded() ? std::numeric_limits<double>::infinity() : rule.reach;
  for (uint32_t k = 0; k < m; ++k) {
    const uint32_t from = which[k];
    to.row[0][k] = s_.row[from];
    to.row[1][k] = pairs ? s_.other[from] : no_row;
    to.record[k] = pairs ? s_.where[from] & target::record_mask : 0;
  }
  for (uint32_t k = 0; k < m; ++k) {
    const uint32_t from = which[k];
    // The stages give the normal from the lower to the higher id; a block wants it outward from its ball, as contacts
    // of one ball couple translation and rotation with the sign of their side.
    const double sign = pairs ? s_.sign[from] : 1.0, mass = s_.mass[from];
    // A gap that has yet to close does not lengthen the arm it will have.
    const double half = 0.5 * std::min(most, gap[from]);
    to.x[k] = sign * s_.nx[from];
    to.y[k] = sign * s_.ny[from];
    to.z[k] = sign * s_.nz[from];
    to.arm[0][k] = radius[to.row[0][k]] + half;
    to.arm[1][k] = pairs ? radius[to.row[1][k]] + half : 0.0;
    to.kn[k] = t_.normal[from];
    to.ks[k] = t_.shear[from];
    to.kb[k] = t_.bending[from];
    to.kt[k] = t_.twist[from];
    to.cn[k] = 2 * t_.ratio_normal[from] * std::sqrt(mass * t_.normal[from]);
    to.cs[k] = 2 * t_.ratio_shear[from] * std::sqrt(mass * t_.shear[from]);
  }
}

void Gatherer::keep(Links& out) const {
  const LinkColumns& c = columns_;
  for (std::size_t k = 0; k < c.count; ++k) {
    out.links.push_back({{c.row[0][k], c.row[1][k]},
                         wall_,
                         c.record[k],
                         {c.x[k], c.y[k], c.z[k]},
                         {c.arm[0][k], c.arm[1][k]},
                         c.kn[k],
                         c.ks[k],
                         c.kb[k],
                         c.kt[k],
                         c.cn[k],
                         c.cs[k]});
    out.dashpots = out.dashpots || c.cn[k] > 0 || c.cs[k] > 0;
    out.rotates = out.rotates || c.ks[k] > 0 || c.kb[k] > 0 || c.kt[k] > 0;
  }
}

/// Where a ball meets a wall, and how it moves there.
void Gatherer::place(const Wall& wall, uint32_t row, uint32_t touch, uint32_t k) {
  s_.row[k] = row;
  s_.nx[k] = touches_.nx[touch];
  s_.ny[k] = touches_.ny[touch];
  s_.nz[k] = touches_.nz[touch];
  s_.gap[k] = touches_.distance[touch] - view_.radius[row];
  s_.r1[k] = view_.radius[row];
  s_.r2[k] = 0;
  s_.mass[k] = 1.0 / view_.inverse_mass[row];
  const double away = touches_.distance[touch];
  const double arm[3] = {view_.x[row] + away * s_.nx[k] - wall.centre[0],
                         view_.y[row] + away * s_.ny[k] - wall.centre[1],
                         view_.z[row] + away * s_.nz[k] - wall.centre[2]};
  const auto& w = wall.spin;
  s_.vx[k] = wall.velocity[0] + w[1] * arm[2] - w[2] * arm[1] - view_.vx[row];
  s_.vy[k] = wall.velocity[1] + w[2] * arm[0] - w[0] * arm[2] - view_.vy[row];
  s_.vz[k] = wall.velocity[2] + w[0] * arm[1] - w[1] * arm[0] - view_.vz[row];
}

/// One touch of a candidate as a contact that is or could be.
void Gatherer::load(const BoundRule& rule, const Wall& wall, uint32_t row, uint32_t touch, uint32_t k) {
  place(wall, row, touch, k);
  for (uint32_t word = 0; word < rule.state_words(); ++word) s_.state[word][k] = 0;
  if (rule.varying.empty()) return;
  Birth birth;
  birth.row1 = row;
  birth.wall = &wall;
  birth.patch = touches_.patch[touch];
  birth.r1 = s_.r1[k];
  birth.mass = s_.mass[k];
  birth.x = view_.x[row];
  birth.y = view_.y[row];
  birth.z = view_.z[row];
  const auto index = static_cast<uint16_t>(wall_);
  birth.bonding = bondings(contacts_.wall_breaks, {balls_.id()[row], index, birth.patch}, false);
  thread_local std::vector<double> words;
  words = rule.words;
  rule.vary(birth, words.data());
  for (std::size_t v = 0; v < rule.varying.size(); ++v) s_.property[v][k] = words[rule.varying[v]];
}

void Gatherer::walls(std::size_t index, Links& out) {
  const WallList& list = contacts_.wall_lists()[index];
  if (list.bonded) return wall_bonds(list, out);
  const BoundRule& rule = contacts_.book.rules[list.rule];
  std::vector<uint32_t> rows;
  for (const uint32_t row : list.candidates)
    if (holds(row) && view_.inverse_mass[row] > 0) rows.push_back(row);
  if (rows.empty() || rule.model == nullptr) return;
  wall_ = list.wall;
  bonded_ = nullptr;
  glued_ = false;
  const Wall& wall = walls_[list.wall];
  // Twice the radius shows those that come, for the limits of collisions.
  touches_.find(wall, view_, rows, 2, rule.reach + query_.margin);
  for (const WallList& bonds : bonds_beside(contacts_.wall_lists(), index)) leave_out(touches_, rows, bonds);
  uint32_t n = 0;
  const auto flush = [&] {
    if (n > 0) batch(rule, n, out);
    n = 0;
  };
  for (const uint32_t touch : touches_.order) {
    load(rule, wall, rows[touches_.ball[touch]], touch, n++);
    if (n == Scratch::size) flush();
  }
  flush();
}

// Bonds hold at any distance; a wall does not move by their forces.
void Gatherer::wall_bonds(const WallList& list, Links& out) {
  const BoundRule& rule = contacts_.book.rules[list.rule];
  wall_ = list.wall;
  bonded_ = nullptr;
  glued_ = true;
  const Wall& wall = walls_[list.wall];
  place_bonds(list, wall, view_, touches_);
  const std::size_t words = rule.memory_words(true), varying = rule.varying.size();
  uint32_t n = 0;
  const auto flush = [&] {
    if (n > 0) batch(rule, n, out);
    n = 0;
  };
  for (std::size_t slot = 0; slot < list.slots.size(); ++slot) {
    const uint32_t row = list.slots[slot].row;
    if (!holds(row) || !(view_.inverse_mass[row] > 0)) continue;
    place(wall, row, touches_.order[slot], n);
    for (std::size_t w = 0; w < words; ++w) s_.state[w][n] = list.state[slot * words + w];
    for (std::size_t v = 0; v < varying; ++v) s_.property[v][n] = list.property[slot * varying + v];
    if (++n == Scratch::size) flush();
  }
  flush();
}

void append(Links& all, const Links& part) {
  all.links.insert(all.links.end(), part.links.begin(), part.links.end());
  all.impact = smaller(all.impact, part.impact);
  all.kinematic = smaller(all.kinematic, part.kinematic);
  all.dashpots = all.dashpots || part.dashpots;
  all.rotates = all.rotates || part.rotates;
}

struct Rows {
  std::size_t first, last;
};
enum class Meet { all, walls };
Links gather(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls, const PeriodicCell& cell,
             const LinkQuery& query, Rows rows, Meet meet, Team& team, const LinkSink* sink) {
  const std::size_t lists = contacts.wall_lists().size(),
                    blocks = meet == Meet::walls ? 0 : (balls.size() + block_rows - 1) / block_rows;
  std::vector<Links> parts(blocks + lists);
  std::vector<std::unique_ptr<Gatherer>> gatherers(team.size());
  team.each_block(parts.size(), [&](std::size_t part, unsigned thread) {
    if (!gatherers[thread])
      gatherers[thread] = std::make_unique<Gatherer>(contacts, balls, walls, cell, query, rows.first, rows.last, sink);
    if (part < blocks)
      gatherers[thread]->pairs(part, parts[part]);
    else
      gatherers[thread]->walls(part - blocks, parts[part]);
  });
  Links all;
  std::size_t total = 0;
  for (const Links& part : parts) total += part.links.size();
  all.links.reserve(total);
  for (Links& part : parts) {
    append(all, part);
    part = Links();
  }
  return all;
}

}  // namespace

Links gather_links(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                   const PeriodicCell& cell, const LinkQuery& query, std::size_t first, std::size_t last, Team& team) {
  return gather(contacts, balls, walls, cell, query, {first, last}, Meet::all, team, nullptr);
}

void LinkColumns::add(const Link& link) {
  const std::size_t k = count++;
  for (int end = 0; end < 2; ++end) {
    row[end][k] = link.row[end];
    arm[end][k] = link.arm[end];
  }
  record[k] = link.record;
  x[k] = link.normal[0];
  y[k] = link.normal[1];
  z[k] = link.normal[2];
  kn[k] = link.kn;
  ks[k] = link.ks;
  kb[k] = link.kb;
  kt[k] = link.kt;
  cn[k] = link.cn;
  cs[k] = link.cs;
}

Links wall_links(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls, const PeriodicCell& cell,
                 const LinkQuery& query, Team& team) {
  return gather(contacts, balls, walls, cell, query, {0, balls.size()}, Meet::walls, team, nullptr);
}

Links stream_links(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                   const PeriodicCell& cell, const LinkQuery& query, Team& team, const LinkSink& sink) {
  return gather(contacts, balls, walls, cell, query, {0, balls.size()}, Meet::all, team, &sink);
}

double coordination(const Contacts& contacts, const Balls& balls, const PeriodicCell& cell) {
  const ImageShifts shifts(cell);
  const BallView b(balls);
  uint64_t ends = 0;
  for (std::size_t index = 0; index < contacts.lists().size(); ++index) {
    const TouchList& list = contacts.lists()[index];
    const double reach = rule_of(contacts, index).reach;
    if (rule_of(contacts, index).model == nullptr) continue;
    for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
      for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
        const std::size_t j = list.other[slot];
        const double* shift = shifts.of[target::image(list.where[slot])];
        const double x = b.x[j] - b.x[row] + shift[0], y = b.y[j] - b.y[row] + shift[1],
                     z = b.z[j] - b.z[row] + shift[2], far = b.radius[row] + b.radius[j] + reach;
        const bool holds = list.bonded && list.broken[slot] == 0;
        if (holds || x * x + y * y + z * z < far * far) ends += 2;
      }
  }
  for (const WallList& list : contacts.wall_lists()) ends += list.slots.size();
  return balls.size() == 0 ? 0.0 : static_cast<double>(ends) / static_cast<double>(balls.size());
}

}  // namespace scree::core
