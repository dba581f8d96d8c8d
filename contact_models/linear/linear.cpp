// Linear springs, dashpots and Coulomb slip: P. A. Cundall and O. D. L. Strack, "A discrete numerical model for
// granular assemblies", Geotechnique 29 (1979) 47-65. Property names and modes follow PFC. Equations: linear.md.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct Linear {
  double kn, ks, fric, dp_nratio, dp_sratio, dp_mode, rgap, lin_mode, emod, kratio;

  static void describe(Properties<Linear>& p) {
    p.number("kn", &Linear::kn, "N/m", "normal stiffness").at_least(0).mix(series).derived("emod kratio");
    p.number("ks", &Linear::ks, "N/m", "shear stiffness").at_least(0).mix(series).derived("emod kratio");
    p.number("emod", &Linear::emod, "Pa", "effective modulus: kn = emod area / length of the pair")
        .at_least(0)
        .mix(harmonic);
    p.number("kratio", &Linear::kratio, "1", "normal over shear stiffness; 0 means no shear stiffness")
        .at_least(0)
        .mix(mean);
    p.number("fric", &Linear::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
    p.number("dp_nratio", &Linear::dp_nratio, "1", "normal dashpot, share of critical damping")
        .at_least(0)
        .fallback(0)
        .mix(mean);
    p.number("dp_sratio", &Linear::dp_sratio, "1", "shear dashpot, share of critical damping")
        .at_least(0)
        .fallback(0)
        .mix(mean);
    p.integer("dp_mode", &Linear::dp_mode,
              "0 full dashpots, 1 normal force never pulls, 2 no shear dashpot while sliding, 3 both")
        .at_least(0)
        .at_most(3)
        .fallback(0);
    p.number("rgap", &Linear::rgap, "m", "reference gap: the springs act below this gap").fallback(0);
    p.integer("lin_mode", &Linear::lin_mode, "normal force 0 from the overlap, 1 from its increments")
        .at_least(0)
        .at_most(1)
        .fallback(0);
    p.either("kn ks", "emod kratio");
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
  Springs springs(const Contact& c, const State& s) const {
    const double depth = rgap - c.gap;
    const Vec3 carried = c.carried(s.spring);
    const double along = carried.dot(c.normal);
    // A pair that only now came into reach loads its spring by the part of the motion below the reference gap.
    const double depth_before = max(0.0, depth + c.opening() * c.dt);
    const double incremental = max(0.0, along + kn * (depth - depth_before));
    const bool active = !(depth < 0);
    const double normal = lin_mode != 0 ? incremental : kn * depth;
    return {active ? normal : 0.0, carried - along * c.normal, active};
  }
  double normal_force(const NormalContact& c, double spring, bool active) const {
    const double total = spring - (active ? c.dashpot(dp_nratio, kn) : 0.0) * c.opening();
    return (dp_mode == 1 || dp_mode == 3) ? max(0.0, total) : total;
  }
  Vec3 shear_dashpot(const Contact& c, bool active, bool sliding) const {
    // Without an increment nobody can tell a sliding contact from a sticking one; modes 2 and 3 then leave it out.
    const bool off = !active || (dp_mode >= 2 && (sliding || c.dt == 0));
    return (off ? 0.0 : c.dashpot(dp_sratio, ks)) * c.slip_rate();
  }

  void law(const Contact& c, State& s, Response& r) const {
    const Springs before = springs(c, s);
    const Vec3 trial = before.shear_before - ks * c.slip();
    const double size = trial.norm(), limit = fric * before.normal;  // the dashpot does not add to friction
    const bool sliding = size > limit;
    const Vec3 shear = (sliding ? limit / size : 1.0) * trial;
    s.spring = shear + (lin_mode != 0 ? before.normal : 0.0) * c.normal;
    r.force =
        normal_force(c, before.normal, before.active) * c.normal + shear - shear_dashpot(c, before.active, sliding);
    r.sliding = sliding;
  }

  void energy(const Contact& c, const State& old, const State& s, const Response& r, Energies& e) const {
    const Springs before = springs(c, old);
    const Vec3 shear = s.spring - s.spring.dot(c.normal) * c.normal;
    e.strain = stored(before.normal, kn) + stored(shear.norm(), ks);
    const Vec3 elastic = ks > 0 ? (before.shear_before - shear) / ks : Vec3{};
    e.friction = r.sliding ? -0.5 * (before.shear_before + shear).dot(c.slip() - elastic) : 0.0;
    const double pull = before.normal - normal_force(c, before.normal, before.active);
    e.dashpot = c.dt * (pull * c.opening() + shear_dashpot(c, before.active, r.sliding).dot(c.slip_rate()));
  }
  static double stored(double force, double k) { return k > 0 ? 0.5 * force * force / k : 0.0; }

  // A rule given by emod has ks only after `derive`; its kratio says as much.
  bool normal_only() const {
    const bool no_shear_spring = (ks == 0 && kratio == 0) || fric == 0;
    const bool no_shear_dashpot = (ks == 0 && kratio == 0) || dp_sratio == 0;
    return no_shear_spring && no_shear_dashpot && lin_mode == 0;
  }
  void law_normal(const NormalContact& c, NormalResponse& r) const {
    const double depth = rgap - c.gap;
    const bool active = !(depth < 0);
    r.force = normal_force(c, active ? kn * depth : 0.0, active);
  }
  void energy_normal(const NormalContact& c, const NormalResponse& r, Energies& e) const {
    const double spring = rgap - c.gap < 0 ? 0.0 : kn * (rgap - c.gap);
    e.strain = stored(spring, kn);
    e.dashpot = c.dt * (spring - r.force) * c.opening();
  }

  /// Deformability of a pair as in PFC: a bar of the smaller radius between the centres.
  void derive(const Pair& p) {
    if (p.form != 1) return;
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

}  // namespace

SCREE_CONTACT_MODEL(Linear, "linear", "1.0.0", "linear springs, dashpots and Coulomb friction")
