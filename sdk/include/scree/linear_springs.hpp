#pragma once
/// Linear springs, dashpots and Coulomb slip, to build a contact model on:
///
///     struct Mine : LinearSprings {
///       double more;
///       static void describe(Properties<Mine>& p) {
///         describe_springs(p, {"emod kratio"});
///         p.number("more", &Mine::more, "1", "what the model adds");
///         p.either("kn ks", "emod kratio");
///       }
///     };
///
/// P. A. Cundall and O. D. L. Strack, "A discrete numerical model for granular assemblies", Geotechnique 29 (1979)
/// 47-65. Property names and modes follow PFC. Equations: the page of the contact model `linear`.
#include <scree/contact_model.hpp>

#include <initializer_list>

namespace scree {

struct LinearSprings {
  double kn, ks, fric, dp_nratio, dp_sratio, dp_mode, rgap, lin_mode, emod, kratio;

  /// Declares the properties above; `by_modulus` lists the forms of `either` in which `emod kratio` give the stiffness.
  template <class L>
  static void describe_springs(Properties<L>& p, std::initializer_list<const char*> by_modulus) {
    Property normal = p.number("kn", &L::kn, "N/m", "normal stiffness").at_least(0).mix(series);
    Property shear = p.number("ks", &L::ks, "N/m", "shear stiffness").at_least(0).mix(series);
    for (const char* form : by_modulus) {
      normal.derived(form);
      shear.derived(form);
    }
    p.number("emod", &L::emod, "Pa", "effective modulus: kn = emod area / length of the pair")
        .at_least(0)
        .mix(harmonic);
    p.number("kratio", &L::kratio, "1", "normal over shear stiffness; 0 means no shear stiffness")
        .at_least(0)
        .mix(mean);
    p.number("fric", &L::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
    p.number("dp_nratio", &L::dp_nratio, "1", "normal dashpot, share of critical damping")
        .at_least(0)
        .fallback(0)
        .mix(mean);
    p.number("dp_sratio", &L::dp_sratio, "1", "shear dashpot, share of critical damping")
        .at_least(0)
        .fallback(0)
        .mix(mean);
    p.integer("dp_mode", &L::dp_mode,
              "0 full dashpots, 1 normal force never pulls, 2 no shear dashpot while sliding, 3 both")
        .at_least(0)
        .at_most(3)
        .fallback(0);
    p.number("rgap", &L::rgap, "m", "reference gap: the springs act below this gap").fallback(0);
    p.integer("lin_mode", &L::lin_mode, "normal force 0 from the overlap, 1 from its increments")
        .at_least(0)
        .at_most(1)
        .fallback(0);
    p.remembers("spring", &State::spring, "N");
  }

  /// Force of the springs that is remembered: the shear force, and with lin_mode 1 the normal force along the normal.
  /// One vector holds both, so that the usual mode pays nothing for the other.
  struct State {
    Vec3 spring;
  };

  struct Springs {
    double normal;      ///< force, N, pushing
    Vec3 shear_before;  ///< remembered shear force, turned
    bool active;        ///< below the reference gap
  };
  /// `opened`: how far the gap grew over the motion that led here, m.
  SCREE_INLINE Springs springs(const Contact& c, const State& s, double opened) const {
    const double depth = rgap - c.gap;
    const Vec3 carried = c.carried(s.spring);
    const double along = carried.dot(c.normal);
    // A pair that only now came into reach loads its spring by the part of the motion below the reference gap.
    const double depth_before = max(0.0, depth + opened);
    const double incremental = max(0.0, along + kn * (depth - depth_before));
    const bool active = !(depth < 0);
    const double normal = lin_mode != 0 ? incremental : kn * depth;
    return {active ? normal : 0.0, carried - along * c.normal, active};
  }
  SCREE_INLINE double normal_force(const NormalContact& c, double spring, bool active) const {
    const double total = spring - (active ? c.dashpot(dp_nratio, kn) : 0.0) * c.opening();
    return (dp_mode == 1 || dp_mode == 3) ? max(0.0, total) : total;
  }
  SCREE_INLINE Vec3 shear_dashpot(const Contact& c, bool active, bool sliding) const {
    // Without an increment nobody can tell a sliding contact from a sticking one; modes 2 and 3 then leave it out.
    const bool off = !active || (dp_mode >= 2 && (sliding || c.dt == 0));
    return (off ? 0.0 : c.dashpot(dp_sratio, ks)) * c.slip_rate();
  }

  SCREE_INLINE void law(const Contact& c, State& s, Response& r) const {
    const Springs before = springs(c, s, c.opening() * c.dt);
    const Vec3 trial = before.shear_before - ks * c.slip();
    const double size = trial.norm(), limit = fric * before.normal;  // the dashpot does not add to friction
    const bool sliding = size > limit;
    const Vec3 shear = (sliding ? limit / size : 1.0) * trial;
    s.spring = shear + (lin_mode != 0 ? before.normal : 0.0) * c.normal;
    r.force =
        normal_force(c, before.normal, before.active) * c.normal + shear - shear_dashpot(c, before.active, sliding);
    r.sliding = sliding;
  }

  SCREE_INLINE void energy(const Contact& c, const State& old, const State& s, const Response& r, Energies& e) const {
    const Springs before = springs(c, old, c.opening() * c.dt);
    const Vec3 shear = s.spring - s.spring.dot(c.normal) * c.normal;
    e.strain = stored(before.normal, kn) + stored(shear.norm(), ks);
    const Vec3 elastic = ks > 0 ? (before.shear_before - shear) / ks : Vec3{};
    e.friction = r.sliding ? -0.5 * (before.shear_before + shear).dot(c.slip() - elastic) : 0.0;
    const double pull = before.normal - normal_force(c, before.normal, before.active);
    e.dashpot = c.dt * (pull * c.opening() + shear_dashpot(c, before.active, r.sliding).dot(c.slip_rate()));
  }
  SCREE_INLINE static double stored(double force, double k) { return k > 0 ? 0.5 * force * force / k : 0.0; }

  /// Deformability of a pair as in PFC: a bar of the smaller radius between the centres.
  void stiffness_from_modulus(const Pair& p) {
    constexpr double pi = 3.14159265358979323846;
    const double r = p.wall() ? p.r1 : min(p.r1, p.r2), length = p.r1 + p.r2;
    kn = emod * (pi * r * r) / length;
    ks = kratio > 0 ? kn / kratio : 0.0;
  }

  double reach(const Pair&) const { return max(0.0, rgap); }

  Stiffness stiffness(const Contact&) const {
    const bool shears = fric > 0 || dp_sratio > 0;
    return {.normal = kn, .shear = shears ? ks : 0.0, .dashpot = dp_nratio, .dashpot_shear = dp_sratio};
  }
};

}  // namespace scree
