#pragma once
/// Linear springs with a bond at the contact point that carries forces and no moment (PFC's contact bond), to build a
/// contact model on. While it holds, the springs also pull, at any gap, and do not slip; then they are those of
/// LinearSprings. Equations: the page of the contact model `contact_bond`.
#include <scree/linear_springs.hpp>

namespace scree {

/// The mode of a bond, a word of Bond: it starts at 0, and what is above 0 has broken.
constexpr double bond_holds = -1, bond_new = 0, bond_broke_in_tension = 1, bond_broke_in_shear = 2;
SCREE_INLINE bool bond_broke(double mode) { return mode > 0; }
SCREE_INLINE bool bond_intact(double mode) { return mode <= 0; }
/// As `broken` of a contact model says it: 0 intact, 1 tension, 2 shear.
SCREE_INLINE double break_of(double mode) { return mode > 0 ? mode : 0.0; }

struct GluedSprings : LinearSprings {
  double cb_tenf, cb_shearf;

  /// Forces of the springs before they may slip or break.
  struct Glued {
    double normal_before, normal;  ///< N, pushing: at the end of the cycle before, and now
    Vec3 shear_before;             ///< N
    bool active;                   ///< below the reference gap
  };
  /// `opened`: how far the gap grew over the motion that led here, m.
  SCREE_INLINE Glued glued(const Contact& c, const State& s, double opened, bool holds) const {
    const double depth = rgap - c.gap;
    const Vec3 carried = c.carried(s.spring);
    const double along = carried.dot(c.normal);
    const bool active = !(depth < 0);
    const double depth_before = holds ? depth + opened : max(0.0, depth + opened);
    const double before = lin_mode != 0 ? along : kn * (depth + opened);
    const double now = lin_mode != 0 ? along + kn * (depth - depth_before) : kn * depth;
    return {before, now, carried - along * c.normal, active};
  }
  /// What is left of a normal force that held: a contact without a bond does not pull, nor act above its reference gap.
  SCREE_INLINE static double left_of(double normal, bool active) { return active ? max(0.0, normal) : 0.0; }

  /// One cycle of a bond in `mode`, where 1 and 2 are no bond; its mode afterwards.
  SCREE_INLINE double glued_law(const Contact& c, double opened, State& s, double mode, Response& r) const {
    const Glued before = glued(c, s, opened, bond_intact(mode));
    const Vec3 trial = before.shear_before - ks * c.slip();
    const double size = trial.norm();
    // A strength of zero breaks at the first load, and not before there is one. Numbers instead of truth values, or g++
    // makes no vector loop of it.
    const double sheared = size > 0 ? (size < cb_shearf ? +bond_holds : +bond_broke_in_shear) : +bond_holds;
    const double torn = before.normal < 0 ? (-before.normal < cb_tenf ? +sheared : +bond_broke_in_tension) : +sheared;
    const double next = mode > 0 ? +mode : +torn;
    const bool holds = bond_intact(next);
    const double normal = holds ? +before.normal : left_of(before.normal, before.active);
    const double limit = fric * normal;
    const bool sliding = !holds && size > limit;
    const Vec3 shear = (sliding ? limit / size : 1.0) * trial;
    s.spring = shear + (lin_mode * normal) * c.normal;
    r.force = glued_normal(c, normal, before.active, holds) * c.normal + shear -
              glued_dashpot(c, before.active, holds, sliding);
    r.sliding = sliding;
    return next;
  }
  // Dashpots of a contact that holds act at any gap, and the modes that spare a free contact leave them alone.
  SCREE_INLINE double glued_normal(const Contact& c, double spring, bool active, bool holds) const {
    return holds ? spring - c.dashpot(dp_nratio, kn) * c.opening() : normal_force(c, spring, active);
  }
  SCREE_INLINE Vec3 glued_dashpot(const Contact& c, bool active, bool holds, bool sliding) const {
    return holds ? c.dashpot(dp_sratio, ks) * c.slip_rate() : shear_dashpot(c, active, sliding);
  }

  SCREE_INLINE void glued_energy(const Contact& c, double opened, const State& old, double mode_before, const State& s,
                                 double mode, const Response& r, Energies& e) const {
    const bool held = bond_intact(mode_before), holds = bond_intact(mode), broke = held && !holds;
    const Glued before = glued(c, old, opened, held);
    const double normal = holds ? before.normal : left_of(before.normal, before.active);
    const Vec3 trial = before.shear_before - ks * c.slip(), shear = s.spring - s.spring.dot(c.normal) * c.normal;
    e.strain += stored(normal, kn) + stored(shear.norm(), ks);
    const double slipped = let_go(before.shear_before, trial, shear, ks);
    e.friction += r.sliding && !broke ? slipped : 0.0;
    const double torn = kn > 0 ? 0.5 * (before.normal_before + normal) * (before.normal - normal) / kn : 0.0;
    // Increments of a bond may leave a free contact a force at its reference gap, where it ends.
    const double left = lin_mode != 0 && !held ? max(0.0, torn) : 0.0;
    e.broken += broke ? torn + slipped : left;
    const double pull = normal - glued_normal(c, normal, before.active, holds);
    const Vec3 drag = glued_dashpot(c, before.active, holds, r.sliding);
    e.dashpot += c.dt * (pull * c.opening() + drag.dot(c.slip_rate()));
  }
  /// Work of the mean force over the stretch that a spring gave up, from `trial` to `now`. With it the account of a
  /// cycle closes to rounding, since the motion sees the forces before and after.
  SCREE_INLINE static double let_go(const Vec3& before, const Vec3& trial, const Vec3& now, double k) {
    return k > 0 ? 0.5 * (before + now).dot(trial - now) / k : 0.0;
  }
  /// How far the gap grew since the bond's law last ran: from the gaps, so that a pair that turns keeps its force. A
  /// new bond knows no gap yet.
  SCREE_INLINE static double opened_since(const Contact& c, double mode, double gap_before) {
    return mode == bond_new ? c.opening() * c.dt : c.gap - gap_before;
  }
};

}  // namespace scree
