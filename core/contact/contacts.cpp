#include "core/contact/contacts.hpp"

#include <algorithm>

#include "core/base/crash_note.hpp"
#include "core/contact/run_law.hpp"

namespace scree::core {

namespace {

// Slots rise; those of bonds mostly follow each other, as every bond is looked at.
bool in_a_row(uint32_t n, const Scratch& s) { return s.slot[n - 1] - s.slot[0] == n - 1; }

void load(const Array<double>& column, uint32_t n, const Scratch& s, double* to) {
  if (in_a_row(n, s))
    std::copy_n(column.data() + s.slot[0], n, to);
  else
    for (uint32_t k = 0; k < n; ++k) to[k] = column[s.slot[k]];
}

void load_columns(const TouchList& list, uint32_t n, Scratch& s) {
  for (std::size_t w = 0; w < list.state.size(); ++w) load(list.state[w], n, s, s.state[w]);
  for (std::size_t v = 0; v < list.property.size(); ++v) load(list.property[v], n, s, s.property[v]);
}

void store_columns(TouchList& list, uint32_t n, const Scratch& s) {
  for (std::size_t w = 0; w < list.state.size(); ++w) {
    double* column = list.state[w].data();
    if (in_a_row(n, s))
      std::copy_n(s.state[w], n, column + s.slot[0]);
    else
      for (uint32_t k = 0; k < n; ++k) column[s.slot[k]] = s.state[w][k];
  }
  for (uint32_t k = 0; k < n; ++k) list.active[s.slot[k]] = 1;
}

// Contacts that ended.
void forget_state(TouchList& list, const uint32_t* slots, uint32_t count, ContactEnergy& energy) {
  for (auto& column : list.state)
    for (uint32_t k = 0; k < count; ++k) column[slots[k]] = 0;
  if (list.dashpot.size() != list.size()) return;
  for (uint32_t k = 0; k < count; ++k) {
    energy.dashpot += ContactEnergy::dashpot_end(list.dashpot[slots[k]]);
    list.dashpot[slots[k]] = 0;
  }
}

// A bond that broke waits in its list for the next rebuild; until then it is a contact while its pieces touch.
void mark_broken(TouchList& list, double reach, uint32_t n, const Scratch& s) {
  for (uint32_t k = 0; k < n; ++k) {
    uint8_t& broken = list.broken[s.slot[k]];
    if (s.event[k] != 0) broken = static_cast<uint8_t>(s.event[k]);
    list.active[s.slot[k]] = broken == 0 || s.gap[k] <= reach;
  }
}

void note_breaks(const TouchList& list, const Balls& balls, uint32_t n, const Scratch& s, std::vector<Break>& out) {
  for (uint32_t k = 0; k < n; ++k) {
    if (s.event[k] == 0) continue;
    Break one;
    const uint32_t row = s.row[k];
    const uint64_t a = balls.id()[row], b = balls.id()[s.other[k]];
    one.ids = {std::min(a, b), std::max(a, b)};
    one.rule = list.rule;
    one.mode = static_cast<uint8_t>(s.event[k]);
    const double arm = s.sign[k] * (balls[Column::radius][row] + 0.5 * s.gap[k]);
    one.point = {balls[Column::x][row] + arm * s.nx[k], balls[Column::y][row] + arm * s.ny[k],
                 balls[Column::z][row] + arm * s.nz[k]};
    one.energy = s.energy[3][k];
    out.push_back(one);
  }
}

void store_report(TouchList& list, const BoundRule& rule, uint32_t n, const Scratch& s) {
  if (list.report.size() != 7) list.report.assign(7, Array<double>(list.size()));
  const bool moment = !rule.normal_only() && (rule.needs & SCREE_GIVES_MOMENT) != 0;
  const double* from[7] = {s.fx,
                           s.fy,
                           s.fz,
                           moment ? s.mx : nullptr,
                           moment ? s.my : nullptr,
                           moment ? s.mz : nullptr,
                           rule.normal_only() ? nullptr : s.sliding};
  for (std::size_t w = 0; w < 7; ++w)
    if (from[w] != nullptr)
      for (uint32_t k = 0; k < n; ++k) list.report[w][s.slot[k]] = from[w][k];
}

Excess pair_excess(const BoundRule& rule, const Balls& balls, uint32_t n, double limit, const Scratch& s) {
  Excess excess;
  for (uint32_t k = 0; k < n; ++k) {
    const double least = std::min(s.r1[k], s.r2[k]);
    if (!(-s.gap[k] > limit * least) || -s.gap[k] <= excess.overlap) continue;
    excess = {true, rule.name, rule.model_name, balls.id()[s.row[k]], balls.id()[s.other[k]], "", -s.gap[k], least};
    if (excess.id1 > excess.id2) std::swap(excess.id1, excess.id2);
  }
  return excess;
}

// Of the smaller radius; 0 where none is beyond the limit.
double deepest_of(uint32_t n, double limit, const Scratch& s) {
  double most = 0;
  for (uint32_t k = 0; k < n; ++k) most = std::max(most, -s.gap[k] / std::min(s.r1[k], s.r2[k]));
  return most > limit ? most : 0;
}

std::string pair_text(uint64_t a, uint64_t b) {
  return "balls " + std::to_string(std::min(a, b)) + " and " + std::to_string(std::max(a, b));
}

// Called after the forces were added: they have the sign of the higher row.
Excess useless_force(const BoundRule& rule, const Balls& balls, uint32_t n, const Scratch& s) {
  const bool moment = !rule.normal_only() && (rule.needs & SCREE_GIVES_MOMENT) != 0;
  Excess excess;
  for (uint32_t k = 0; k < n && !excess.found; ++k) {
    const std::array<double, 3> force{s.sign[k] * s.fx[k], s.sign[k] * s.fy[k], s.sign[k] * s.fz[k]};
    const uint64_t a = balls.id()[s.row[k]], b = balls.id()[s.other[k]];
    excess = {true, rule.name, rule.model_name, std::min(a, b), std::max(a, b), "", 0, 0, "force", force};
    if (usable(force) && moment) {
      excess.useless = "moment";
      excess.value = {s.sign[k] * s.mx[k], s.sign[k] * s.my[k], s.sign[k] * s.mz[k]};
    }
    excess.found = !usable(excess.value);
  }
  return excess;
}

double least_of(const double* values, std::size_t n) { return n == 0 ? 1.0 : *std::min_element(values, values + n); }

}  // namespace

// Runs the law on the batch; on a break once more with energies, which the log of breaks wants.
void Contacts::run_batch(TouchList& list, uint32_t n, const Balls& balls, const PassOptions& options, std::size_t block,
                         Scratch& s) {
  const BoundRule& rule = book.rules[list.rule];
  LawCall call{options.dt, list.bonded, options.energy};
  load_columns(list, n, s);
  crash_note = {rule.model_name.c_str(), rule.name.c_str(),     options.cycle, block,
                balls.id()[s.row[0]],    balls.id()[s.other[0]]};
  uint32_t broke = run_law(rule, n, call, s);
  if (broke == law_threw) {
    load_columns(list, n, s);
    const uint32_t k = find_thrower(rule, n, call, s);
    refuse_thrower(rule, k == n ? "" : pair_text(balls.id()[s.row[k]], balls.id()[s.other[k]]), options.cycle);
  }
  if (broke > 0 && !call.energy) {
    call.energy = true;
    load_columns(list, n, s);
    run_law(rule, n, call, s);
  }
  store_columns(list, n, s);
  if (list.bonded) mark_broken(list, rule.reach, n, s);
  if (broke > 0) note_breaks(list, balls, n, s, broke_[block]);
  if (options.energy) {
    for (uint32_t k = 0; k < n && options.dt > 0; ++k) {
      double& last = list.dashpot[s.slot[k]];
      const double now = s.energy[2][k];
      s.energy[2][k] = ContactEnergy::dashpot_work(now, last);
      last = now;
    }
    block_energy_[block].add(list.bonded, n, s);
  }
  if (options.report) store_report(list, rule, n, s);
}

Excess Contacts::run_list(std::size_t block, std::size_t index, const Balls& balls, const double (*shift)[3],
                          const PassOptions& options, Scratch& s) {
  TouchList& list = lists_[index];
  const BoundRule& rule = book.rules[list.rule];
  Excess excess;
  if (rule.model == nullptr || list.size() == 0) return excess;
  const BallView view(balls);
  const StageTable& stage = stages(isa);
  const bool lean = slices_.stride() == Slices::lean, spin = !rule.normal_only();
  const bool turn = spin && (rule.needs & SCREE_NEEDS_TURN) != 0,
             moment = spin && (rule.needs & SCREE_GIVES_MOMENT) != 0;
  const auto filter = stage.filter[shift != nullptr];
  const auto geometry = stage.geometry[spin][turn];
  const auto scatter = lean ? stage.scatter[0][0][options.sums] : stage.scatter[spin ? 2 : 1][moment][options.sums];
  const double reach = list.bonded ? std::numeric_limits<double>::infinity() : rule.reach;
  const FilterInput input{list.begin.data(), list.other.data(), list.where.data(), shift, reach};
  const std::size_t first = block * block_rows, last = first + slices_.block_size(block);
  Cursor cursor{list.begin[first], first, last};
  while (cursor.row < last) {
    uint32_t drops[Scratch::padded], dropped = 0;
    const uint32_t n = filter(view, input, cursor, list.active.data(), s, drops, dropped);
    if (!list.bonded) forget_state(list, drops, dropped, block_energy_[block]);
    if (n == 0) continue;
    if (geometry(view, n, options.dt, std::min(options.depth, options.overlap_limit), s)) {
      block_deepest_[block] = std::max(block_deepest_[block], deepest_of(n, options.depth, s));
      if (!excess.found) excess = pair_excess(rule, balls, n, options.overlap_limit, s);
    }
    run_batch(list, n, balls, options, block, s);
    if (scatter(n, first, slices_.slice(block), s) && !excess.found) excess = useless_force(rule, balls, n, s);
  }
  return excess;
}

Excess Contacts::run_block(std::size_t block, const Balls& balls, const std::vector<Wall>& walls,
                           const double (*shift)[3], const PassOptions& options, Scratch& s) {
  slices_.clear(block);
  broke_[block].clear();
  block_energy_[block] = {};
  block_deepest_[block] = 0;
  Excess worst;
  for (std::size_t index = 0; index < lists_.size(); ++index) {
    Excess excess = run_list(block, index, balls, shift, options, s);
    if (excess.found && !worst.found) worst = excess;
  }
  run_walls(block, balls, walls, options, worst, s);
  crash_note = CrashNote{};
  return worst;
}

Excess Contacts::evaluate(const Balls& balls, std::vector<Wall>& walls, const PeriodicCell& cell,
                          const PassOptions& options, Team& team) {
  const ImageShifts shifts(cell);
  const double(*shift)[3] = cell.any() ? shifts.of : nullptr;
  if (scratch_.size() < team.size()) scratch_.resize(team.size());
  if (options.report)
    for (TouchList& list : lists_)
      if (list.report.empty() || list.report[0].size() != list.size())
        list.report.assign(7, Array<double>(list.size()));
  for (TouchList& list : lists_)
    if (options.energy && list.dashpot.size() != list.size()) list.dashpot = Array<double>(list.size());
  std::vector<Excess> excess(slices_.blocks());
  broke_.resize(slices_.blocks());
  block_energy_.resize(slices_.blocks());
  block_deepest_.resize(slices_.blocks());
  team.each_block(slices_.blocks(), [&](std::size_t block, unsigned thread) {
    excess[block] = run_block(block, balls, walls, shift, options, scratch_[thread]);
  });
  deepest_ = block_deepest_.empty() ? 0 : *std::max_element(block_deepest_.begin(), block_deepest_.end());
  for (Wall& wall : walls) {
    wall.force = wall.moment = {};
    wall.contacts = 0;
  }
  for (const WallList& list : wall_lists_) {
    Wall& wall = walls[list.wall];
    for (std::size_t c = 0; c < 3; ++c) {
      wall.force[c] += list.force[c];
      wall.moment[c] += list.moment[c];
    }
    wall.contacts += list.slots.size();
  }
  energy_ = {};
  if (options.energy)
    for (const ContactEnergy& part : block_energy_) energy_ += part;
  for (Excess& found : excess)
    if (found.found) return found;
  return {};
}

void Contacts::forget() {
  lists_.clear();
  fresh_.clear();
  fresh_walls_.clear();
  wall_lists_.clear();
  wall_first_.clear();
  built_ = false;
}

void Contacts::rebuild(Balls& balls, std::vector<Wall>& walls, const PeriodicCell& cell, double skin, Team& team) {
  const std::size_t n = balls.size();
  for (int axis = 0; axis < 3; ++axis) {
    if (!cell.periodic[axis]) continue;
    double* at = balls[static_cast<Column>(static_cast<int>(Column::x) + axis)];
    for (std::size_t row = 0; row < n; ++row) at[row] = cell.wrapped(at[row], axis);
  }
  const std::vector<uint32_t> order = spatial_order(balls, 4 * least_of(balls[Column::radius], n) + skin);
  const bool moved = !std::is_sorted(order.begin(), order.end());
  if (moved) balls.reorder(order.data());
  std::vector<uint32_t> old_row = moved || !before_.empty() ? order : std::vector<uint32_t>();
  if (!before_.empty())
    for (uint32_t& row : old_row) row = row < before_.size() ? before_[row] : no_row;
  before_.clear();
  std::vector<uint32_t> new_row(moved ? n : 0);
  for (std::size_t row = 0; row < new_row.size(); ++row) new_row[order[row]] = static_cast<uint32_t>(row);
  const PairTable pairs = find_pairs(balls, cell, skin + book.reach(), team, isa);
  lay_out_lists();
  const BondTable bonds = bond_table(lists_, fresh_, book, old_row, n);
  fresh_.clear();
  const Carry carry{&balls, &pairs, &book, &old_row, &cell, &bonds, &breaks};
  const std::size_t rules = book.rules.size();
  for (std::size_t rule = 0; rule < rules; ++rule) {
    if (book.rules[rule].model == nullptr) continue;
    TouchList bonded = rebuilt_bonds(lists_[rules + rule], lists_[rule], carry, team);
    core::rebuild(lists_[rule], lists_[rules + rule], carry, team);
    lists_[rules + rule] = std::move(bonded);
  }
  rebuild_wall_lists(balls, walls, new_row, skin, team);
  slices_.build(lists_, n, book.spins() ? Slices::with_spin : Slices::lean, team);
  built_ = true;
}

// Rules may have been added since the last rebuild.
void Contacts::lay_out_lists() {
  const std::size_t rules = book.rules.size();
  if (lists_.size() == 2 * rules) return;
  std::vector<TouchList> fresh(2 * rules);
  for (std::size_t k = 0; k < fresh.size(); ++k) {
    fresh[k].rule = static_cast<uint16_t>(k % rules);
    fresh[k].bonded = k >= rules;
  }
  for (TouchList& list : lists_)
    if (list.rule < rules) fresh[list.rule + (list.bonded ? rules : 0)] = std::move(list);
  lists_.swap(fresh);
}

void Contacts::rows_kept(const std::vector<uint8_t>& keep) {
  std::vector<uint32_t> rows;
  for (std::size_t row = 0; row < keep.size(); ++row)
    if (keep[row]) rows.push_back(before_.empty() ? static_cast<uint32_t>(row) : before_[row]);
  before_.swap(rows);
  std::vector<uint32_t> now(keep.size(), no_row);
  uint32_t next = 0;
  for (std::size_t row = 0; row < keep.size(); ++row)
    if (keep[row]) now[row] = next++;
  for (WallList& list : wall_lists_) follow_rows(list, now);
  built_ = false;
}

void Contacts::restore(std::vector<TouchList> lists, std::vector<WallList> wall_lists,
                       std::vector<uint32_t> rows_before, bool built, std::size_t rows, Team& team) {
  lists_ = std::move(lists);
  wall_lists_ = std::move(wall_lists);
  before_ = std::move(rows_before);
  built_ = built;
  wall_first_.clear();
  if (!built) return;
  std::size_t next = 0;
  for (std::size_t block = 0; block <= (rows + block_rows - 1) / block_rows; ++block) {
    while (next < wall_lists_.size() && wall_lists_[next].block < block) ++next;
    wall_first_.push_back(next);
  }
  slices_.build(lists_, rows, book.spins() ? Slices::with_spin : Slices::lean, team);
}

void Contacts::renew(std::size_t rule, const Balls& balls, const std::vector<Wall>& walls) {
  built_ = false;
  for (TouchList& list : lists_)
    if (list.rule == rule) list.stale = true;
  for (WallList& list : wall_lists_)
    if (list.rule == rule) renew_wall_list(list, book.rules[rule], balls, walls[list.wall], wall_breaks);
}

std::size_t Contacts::bytes() const {
  std::size_t sum = slices_.bytes();
  for (const TouchList& list : lists_) sum += list.bytes();
  for (const WallList& list : wall_lists_)
    sum += list.candidates.capacity() * sizeof(uint32_t) + list.slots.capacity() * sizeof(WallSlot) +
           list.bonds.capacity() * sizeof(WallBond) +
           (list.state.capacity() + list.property.capacity() + list.report.capacity()) * sizeof(double);
  return sum;
}

uint64_t Contacts::active() const {
  uint64_t sum = 0;
  for (const TouchList& list : lists_)
    for (std::size_t k = 0; k < list.active.size(); ++k) sum += list.active[k];
  return sum;
}

uint64_t Contacts::listed() const {
  uint64_t sum = 0;
  for (const TouchList& list : lists_) sum += list.size();
  return sum;
}

}  // namespace scree::core
