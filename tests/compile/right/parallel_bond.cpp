// Sketch: linear contact with a parallel bond (Potyondy and Cundall 2004): force and moment increments over a disc of
// cement, beam stresses, break in tension or shear.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct ParallelBond {
  double kn, ks, fric, pb_kn, pb_ks, pb_ten, pb_coh, pb_radius;

  static void describe(Properties<ParallelBond>& p) {
    p.number("kn", &ParallelBond::kn, "N/m", "normal stiffness").at_least(0).mix(series);
    p.number("ks", &ParallelBond::ks, "N/m", "shear stiffness").at_least(0).mix(series);
    p.number("fric", &ParallelBond::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
    p.number("pb_kn", &ParallelBond::pb_kn, "Pa/m", "normal stiffness of the bond per area").at_least(0);
    p.number("pb_ks", &ParallelBond::pb_ks, "Pa/m", "shear stiffness of the bond per area").at_least(0);
    p.number("pb_ten", &ParallelBond::pb_ten, "Pa", "tensile strength").at_least(0).infinite();
    p.number("pb_coh", &ParallelBond::pb_coh, "Pa", "cohesion").at_least(0).infinite();
    p.number("pb_radius", &ParallelBond::pb_radius, "m", "radius of the bond").derived();
    p.remembers("shear", &State::shear, "N");
    p.remembers("bond_force", &Bond::force, "N");
    p.remembers("bond_broken", &Bond::mode, "1");
  }
  struct State {
    Vec3 shear;
  };
  struct Bond {
    double mode, pull, twist;
    Vec3 force, moment;
  };

  void derive(const Pair& p) { pb_radius = p.wall() ? p.r1 : min(p.r1, p.r2); }
  double area() const { return 3.14159265358979323846 * pb_radius * pb_radius; }

  void law(const Contact& c, State& s, Response& r) const {
    const double spring = max(0.0, -kn * c.gap);
    const Vec3 trial = c.turned(s.shear) - ks * c.slip();
    const double size = trial.norm(), limit = fric * spring;
    s.shear = (size > limit ? limit / size : 1.0) * trial;
    r.force = spring * c.normal + s.shear;
    r.sliding = size > limit;
  }
  void law(const SpinContact& c, State& s, Bond& b, MomentResponse& r) const {
    law(c, s, r);
    if (b.mode != 0) return;
    const double a = area(), inertia = 0.25 * a * pb_radius * pb_radius;
    b.pull += pb_kn * a * c.opening() * c.dt;
    b.force = c.turned(b.force) - pb_ks * a * c.slip();
    b.twist -= pb_ks * 2 * inertia * c.twist();
    b.moment = c.turned(b.moment) - pb_kn * inertia * c.bend();
    const double tension = b.pull / a + b.moment.norm() * pb_radius / inertia;
    const double shear = b.force.norm() / a + abs(b.twist) * pb_radius / (2 * inertia);
    b.mode = tension >= pb_ten ? 1.0 : (shear >= pb_coh ? 2.0 : 0.0);
    const double holds = b.mode == 0 ? 1.0 : 0.0;
    r.force += holds * (b.force - b.pull * c.normal);
    r.moment += holds * (b.moment + b.twist * c.normal);
  }
  double broken(const Bond& b) const { return b.mode; }
  Stiffness stiffness(const Contact&) const { return {.normal = kn, .shear = ks}; }
  Stiffness stiffness(const Contact&, const State&, const Bond& b) const {
    if (b.mode != 0) return {.normal = kn, .shear = ks};
    const double a = area(), inertia = 0.25 * a * pb_radius * pb_radius;
    return {
        .normal = kn + pb_kn * a, .shear = ks + pb_ks * a, .bending = pb_kn * inertia, .twist = 2 * pb_ks * inertia};
  }
};

}  // namespace

SCREE_CONTACT_MODEL(ParallelBond, "parallel_bond", "0.1.0")
