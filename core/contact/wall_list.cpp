#include "core/contact/wall_list.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/crash_note.hpp"
#include "core/contact/run_law.hpp"
#include "core/contact/slices.hpp"
#include "core/contact/wall_bonds.hpp"
#include "core/contact/wall_touches.hpp"

namespace scree::core {

namespace {

using V = std::array<double, 3>;

V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A contact of the wall at one place: ball, patch, direction to the contact point.
Birth birth_at_wall(const BallView& balls, const Wall& wall, const WallSlot& slot, double distance, uint64_t bonding) {
  const uint32_t row = slot.row;
  const V& normal = slot.normal;
  Birth birth;
  birth.row1 = row;
  birth.patch = slot.patch;
  birth.bonding = bonding;
  birth.wall = &wall;
  birth.r1 = balls.radius[row];
  birth.mass = balls.inverse_mass[row] > 0 ? 1.0 / balls.inverse_mass[row] : 0.0;
  birth.x = balls.x[row] + distance * normal[0];
  birth.y = balls.y[row] + distance * normal[1];
  birth.z = balls.z[row] + distance * normal[2];
  return birth;
}

// Lines up what is remembered with the touches of now: both are sorted, so one merge does it.
void carry_over(WallList& list, const WallTouches& touches, const WallPass& pass) {
  const std::size_t words = pass.rule->state_words(), varying = pass.rule->varying.size();
  thread_local std::vector<WallSlot> slots;
  thread_local std::vector<double> state, property, all;
  slots.resize(touches.count);
  state.assign(touches.count * words, 0.0);
  property.resize(touches.count * varying);
  std::size_t old = 0;
  const auto end_contact = [&](const WallSlot& slot) {
    if (pass.energy != nullptr) pass.energy->dashpot += ContactEnergy::dashpot_end(slot.dashpot);
  };
  for (uint32_t k = 0; k < touches.count; ++k) {
    const uint32_t t = touches.order[k], row = list.candidates[touches.ball[t]], patch = touches.patch[t];
    const V normal{touches.nx[t], touches.ny[t], touches.nz[t]};
    while (old < list.slots.size() &&
           (list.slots[old].row < row || (list.slots[old].row == row && list.slots[old].patch < patch)))
      end_contact(list.slots[old++]);
    const bool known = old < list.slots.size() && list.slots[old].row == row && list.slots[old].patch == patch;
    slots[k] = {row, patch, known ? list.slots[old].normal : normal, known ? list.slots[old].dashpot : 0.0};
    if (known) {
      std::copy_n(list.state.data() + old * words, words, state.begin() + static_cast<std::ptrdiff_t>(k * words));
      std::copy_n(list.property.data() + old * varying, varying,
                  property.begin() + static_cast<std::ptrdiff_t>(k * varying));
      ++old;
    } else if (varying > 0) {
      all = pass.rule->words;
      const uint64_t bonding =
          pass.breaks == nullptr ? 0 : bondings(*pass.breaks, {pass.id[row], list.wall, patch}, false);
      pass.rule->vary(birth_at_wall(*pass.balls, *pass.wall, slots[k], touches.distance[t], bonding), all.data());
      for (std::size_t v = 0; v < varying; ++v) property[k * varying + v] = all[pass.rule->varying[v]];
    }
  }
  for (; old < list.slots.size(); ++old) end_contact(list.slots[old]);
  list.slots.swap(slots);
  list.state.swap(state);
  list.property.swap(property);
}

// Geometry of slots [first, first + n): piece 1 is the ball, piece 2 the wall.
bool geometry(WallList& list, const WallPass& pass, const WallTouches& touches, std::size_t first, uint32_t n,
              Scratch& s) {
  const BallView& b = *pass.balls;
  const Wall& wall = *pass.wall;
  const bool spin = b.wx != nullptr && !pass.rule->normal_only();
  bool beyond = false;
  const double half = 0.5 * pass.dt;
  const bool turns = dot(wall.spin, wall.spin) > 0;
  const auto turned_back = [&](const V& v) {
    if (!turns) return v;
    const V way = cross(wall.spin, v);
    return V{v[0] - half * way[0], v[1] - half * way[1], v[2] - half * way[2]};
  };
  for (uint32_t k = 0; k < n; ++k) {
    WallSlot& slot = list.slots[first + k];
    const uint32_t t = touches.order[first + k], i = slot.row;
    const V normal{touches.nx[t], touches.ny[t], touches.nz[t]};
    const double gap = touches.distance[t] - b.radius[i], arm = b.radius[i] + 0.5 * gap;
    const V point{b.x[i] + arm * normal[0], b.y[i] + arm * normal[1], b.z[i] + arm * normal[2]};
    const V from_centre{point[0] - wall.centre[0], point[1] - wall.centre[1], point[2] - wall.centre[2]};
    // Velocities are those of half a step before: so is the arm they turn with, or what sticks creeps with half a step.
    const V turning = cross(wall.spin, turned_back(from_centre));
    V v{wall.velocity[0] + turning[0] - b.vx[i], wall.velocity[1] + turning[1] - b.vy[i],
        wall.velocity[2] + turning[2] - b.vz[i]};
    if (spin) {
      const V w{b.wx[i], b.wy[i], b.wz[i]};
      const V surface = cross(w, turned_back(normal));
      for (std::size_t c = 0; c < 3; ++c) v[c] -= arm * surface[c];
      const V tilt = cross(slot.normal, normal);
      const double both = 1 + dot(slot.normal, normal);
      const double scale = both > 0 ? 2 / both : 0.0;
      const V sum{w[0] + wall.spin[0], w[1] + wall.spin[1], w[2] + wall.spin[2]};
      const double about = 0.5 * pass.dt * dot(sum, normal);
      s.tx[k] = scale * tilt[0] + about * normal[0];
      s.ty[k] = scale * tilt[1] + about * normal[1];
      s.tz[k] = scale * tilt[2] + about * normal[2];
      s.wx[k] = wall.spin[0] - w[0];
      s.wy[k] = wall.spin[1] - w[1];
      s.wz[k] = wall.spin[2] - w[2];
    }
    s.nx[k] = normal[0];
    s.ny[k] = normal[1];
    s.nz[k] = normal[2];
    s.gap[k] = gap;
    s.vx[k] = v[0];
    s.vy[k] = v[1];
    s.vz[k] = v[2];
    s.r1[k] = b.radius[i];
    s.r2[k] = 0;
    s.mass[k] = b.inverse_mass[i] > 0 ? 1.0 / b.inverse_mass[i] : 0.0;
    s.arm_i[k] = arm;
    beyond |= -gap > pass.overlap_limit * b.radius[i];
    slot.normal = normal;
  }
  return beyond;
}

void gather_columns(const WallList& list, std::size_t words, std::size_t varying, std::size_t first, uint32_t n,
                    Scratch& s) {
  for (std::size_t w = 0; w < words; ++w)
    for (uint32_t k = 0; k < n; ++k) s.state[w][k] = list.state[(first + k) * words + w];
  for (std::size_t v = 0; v < varying; ++v)
    for (uint32_t k = 0; k < n; ++k) s.property[v][k] = list.property[(first + k) * varying + v];
}

void scatter(WallList& list, const WallPass& pass, std::size_t first, uint32_t n, Scratch& s, WallExcess& excess) {
  const BallView& b = *pass.balls;
  const bool spin = pass.stride == Slices::with_spin && !pass.rule->normal_only();
  const bool moment = spin && (pass.rule->needs & SCREE_GIVES_MOMENT) != 0;
  for (uint32_t k = 0; k < n; ++k) {
    const uint32_t i = list.slots[first + k].row;
    double* a = pass.slice + (i - pass.first_row) * pass.stride;
    const V force{s.fx[k], s.fy[k], s.fz[k]}, normal{s.nx[k], s.ny[k], s.nz[k]};
    const V own = moment ? V{s.mx[k], s.my[k], s.mz[k]} : V{};
    if (excess.slot < 0 && !usable(force)) excess = {static_cast<int64_t>(first + k), "force", force, 0};
    if (excess.slot < 0 && !usable(own)) excess = {static_cast<int64_t>(first + k), "moment", own, 0};
    const V torque = cross(normal, force);
    const V point{b.x[i] + s.arm_i[k] * normal[0], b.y[i] + s.arm_i[k] * normal[1], b.z[i] + s.arm_i[k] * normal[2]};
    const V lever{point[0] - pass.wall->centre[0], point[1] - pass.wall->centre[1], point[2] - pass.wall->centre[2]};
    const V about = cross(lever, force);
    for (std::size_t c = 0; c < 3; ++c) {
      a[c] -= force[c];
      if (spin) a[3 + c] -= s.arm_i[k] * torque[c] + own[c];
      list.force[c] += force[c];
      list.moment[c] += about[c] + own[c];
    }
    if (pass.sums) a[pass.stride == Slices::with_spin ? 6 : 3] += std::sqrt(dot(force, force));
    if (!pass.report) continue;
    const double sliding = pass.rule->normal_only() ? 0.0 : s.sliding[k];
    for (double value : {force[0], force[1], force[2], own[0], own[1], own[2], sliding, point[0], point[1], point[2]})
      list.report.push_back(value);
  }
}

}  // namespace

std::span<const WallList> bonds_beside(const std::vector<WallList>& lists, std::size_t index) {
  const auto same_wall = [&](const WallList& list) {
    return list.block == lists[index].block && list.wall == lists[index].wall;
  };
  std::size_t last = index, first = index;
  while (last < lists.size() && same_wall(lists[last])) {
    first += lists[last].bonded ? 0 : 1;
    ++last;
  }
  return lists[index].bonded ? std::span<const WallList>() : std::span(lists).subspan(first, last - first);
}

void renew_wall_list(WallList& list, const BoundRule& rule, const Balls& balls, const Wall& wall,
                     const WallBreakHistory& breaks) {
  const std::size_t words = rule.memory_words(list.bonded), varying = rule.varying.size();
  if (list.state.size() != list.slots.size() * words) list.state.assign(list.slots.size() * words, 0.0);
  list.property.resize(list.slots.size() * varying);
  const BallView view(balls);
  std::vector<double> all;
  for (std::size_t k = 0; k < list.slots.size() && varying > 0; ++k) {
    const WallSlot& slot = list.slots[k];
    const uint64_t bonding = bondings(breaks, {balls.id()[slot.row], list.wall, slot.patch}, list.bonded);
    all = rule.words;
    rule.vary(birth_at_wall(view, wall, slot, view.radius[slot.row], bonding), all.data());
    for (std::size_t v = 0; v < varying; ++v) list.property[k * varying + v] = all[rule.varying[v]];
  }
}

void follow_rows(WallList& list, const std::vector<uint32_t>& now) {
  const std::size_t n = list.slots.size();
  const std::size_t words = n == 0 ? 0 : list.state.size() / n, varying = n == 0 ? 0 : list.property.size() / n;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const uint32_t row = now[list.slots[k].row];
    if (row == no_row) continue;
    list.slots[kept] = list.slots[k];
    list.slots[kept].row = row;
    if (list.bonded) list.bonds[kept] = list.bonds[k];
    for (std::size_t w = 0; w < words; ++w) list.state[kept * words + w] = list.state[k * words + w];
    for (std::size_t v = 0; v < varying; ++v) list.property[kept * varying + v] = list.property[k * varying + v];
    ++kept;
  }
  list.slots.resize(kept);
  list.bonds.resize(list.bonded ? kept : 0);
  list.state.resize(kept * words);
  list.property.resize(kept * varying);
  list.candidates.clear();
}

std::vector<uint32_t> wall_candidates(const BallView& balls, const Wall& wall, std::size_t first, std::size_t last,
                                      double margin) {
  thread_local WallTouches touches;
  std::vector<uint32_t> rows(last - first);
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<uint32_t>(first + k);
  touches.find(wall, balls, rows, 1, margin);
  std::vector<uint32_t> near;
  for (uint32_t k : touches.order) {
    const uint32_t row = rows[touches.ball[k]];
    if (near.empty() || near.back() != row) near.push_back(row);
  }
  return near;
}

namespace {

void note_breaks(WallList& list, const WallPass& pass, std::size_t first, uint32_t n, const Scratch& s) {
  const BallView& b = *pass.balls;
  for (uint32_t k = 0; k < n; ++k) {
    if (s.event[k] == 0) continue;
    const WallSlot& slot = list.slots[first + k];
    const double arm = s.arm_i[k];
    Break one;
    one.ids = {pass.id[slot.row], 0};
    one.rule = list.rule;
    one.mode = list.bonds[first + k].broke = static_cast<uint8_t>(s.event[k]);
    one.point = {b.x[slot.row] + arm * s.nx[k], b.y[slot.row] + arm * s.ny[k], b.z[slot.row] + arm * s.nz[k]};
    one.energy = s.energy[3][k];
    one.wall = list.wall;
    one.patch = slot.patch;
    pass.broke->push_back(one);
  }
}

// The law on slots [first, first + n); on a break once more with energies, which the log of breaks wants.
void run_slots(WallList& list, const WallPass& pass, std::size_t first, uint32_t n, Scratch& s) {
  const std::size_t words = pass.rule->memory_words(list.bonded), varying = pass.rule->varying.size();
  LawCall call{pass.dt, list.bonded, pass.energy != nullptr};
  gather_columns(list, words, varying, first, n, s);
  const auto id = [&](uint32_t k) { return pass.id[list.slots[first + k].row]; };
  crash_note = {pass.rule->model_name.c_str(), pass.rule->name.c_str(), pass.cycle, list.block, id(0), 0,
                pass.wall->name.c_str()};
  const uint32_t broke = run_law(*pass.rule, n, call, s);
  if (broke == law_threw) {
    gather_columns(list, words, varying, first, n, s);
    const uint32_t k = find_thrower(*pass.rule, n, call, s);
    const std::string pieces = "ball " + std::to_string(k == n ? 0 : id(k)) + " and wall '" + pass.wall->name + "'";
    refuse_thrower(*pass.rule, k == n ? "" : pieces, pass.cycle);
  }
  if (list.bonded && broke > 0 && !call.energy) {
    call.energy = true;
    gather_columns(list, words, varying, first, n, s);
    run_law(*pass.rule, n, call, s);
  }
  if (list.bonded && broke > 0) note_breaks(list, pass, first, n, s);
  for (std::size_t w = 0; w < words; ++w)
    for (uint32_t k = 0; k < n; ++k) list.state[(first + k) * words + w] = s.state[w][k];
  if (pass.energy == nullptr) return;
  for (uint32_t k = 0; k < n && pass.dt > 0; ++k) {
    double& last = list.slots[first + k].dashpot;
    const double now = s.energy[2][k];
    s.energy[2][k] = ContactEnergy::dashpot_work(now, last);
    last = now;
  }
  pass.energy->add(list.bonded, n, s);
}

// Where the contacts of the list are now; entry k of the order of touches belongs to slot k.
void meet(WallList& list, const WallPass& pass, WallTouches& touches) {
  if (list.bonded) {
    const uint32_t seen = place_bonds(list, *pass.wall, *pass.balls, touches);
    return keep_places(list, *pass.wall, *pass.balls, touches, seen);
  }
  touches.find(*pass.wall, *pass.balls, list.candidates, 1, pass.rule->reach);
  for (const WallList& bonds : pass.bonds) leave_out(touches, list.candidates, bonds);
  carry_over(list, touches, pass);
}

}  // namespace

WallExcess run_wall_list(WallList& list, const WallPass& pass, Scratch& s) {
  thread_local WallTouches touches;
  list.force = list.moment = {};
  list.report.clear();
  meet(list, pass, touches);
  WallExcess excess;
  for (std::size_t first = 0; first < list.slots.size(); first += Scratch::size) {
    const auto n = static_cast<uint32_t>(std::min<std::size_t>(Scratch::size, list.slots.size() - first));
    if (geometry(list, pass, touches, first, n, s) && excess.slot < 0)
      for (uint32_t k = 0; k < n && excess.slot < 0; ++k)
        if (-s.gap[k] > pass.overlap_limit * s.r1[k])
          excess = {static_cast<int64_t>(first + k), nullptr, {}, -s.gap[k]};
    run_slots(list, pass, first, n, s);
    scatter(list, pass, first, n, s, excess);
  }
  return excess;
}

double wall_list_stiffness(const WallList& list, const WallPass& pass, Scratch& s) {
  thread_local WallTouches touches;
  if (list.slots.empty() || (!list.bonded && list.candidates.empty())) return 0;
  // A copy: it is lined up with the touches of now, the list itself waits for the next pass.
  WallList now = list;
  meet(now, pass, touches);
  Tangents t;
  double sum = 0;
  for (std::size_t first = 0; first < now.slots.size(); first += SCREE_BATCH) {
    const auto n = static_cast<uint32_t>(std::min<std::size_t>(SCREE_BATCH, now.slots.size() - first));
    geometry(now, pass, touches, first, n, s);
    gather_columns(now, pass.rule->memory_words(now.bonded), pass.rule->varying.size(), first, n, s);
    tangents(*pass.rule, n, now.bonded, s, t);
    for (uint32_t k = 0; k < n; ++k) sum += t.normal[k];
  }
  return sum;
}

}  // namespace scree::core
