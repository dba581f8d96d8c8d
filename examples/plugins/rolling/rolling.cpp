// Springs with friction and a moment that resists rolling: the elastic-plastic model C without viscous part of J. Ai,
// J.-F. Chen, J. M. Rotter and J. Y. Ooi, "Assessment of rolling resistance models in discrete element simulations",
// Powder Technology 206 (2011) 269-282.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct Rolling {
  double kn, ks, fric, rolling, dp_nratio;

  static void describe(Properties<Rolling>& p) {
    p.number("kn", &Rolling::kn, "N/m", "normal stiffness").at_least(0).mix(series);
    p.number("ks", &Rolling::ks, "N/m", "shear stiffness").at_least(0).mix(series);
    p.number("fric", &Rolling::fric, "1", "friction coefficient").at_least(0).mix(least);
    p.number("rolling", &Rolling::rolling, "1", "coefficient of rolling friction").at_least(0).mix(least);
    p.number("dp_nratio", &Rolling::dp_nratio, "1", "normal dashpot, share of critical").at_least(0).fallback(0);
    p.remembers("shear", &State::shear, "N");
    p.remembers("moment", &State::moment, "N m");
  }

  /// What a contact remembers from cycle to cycle; both vectors turn with it.
  struct State {
    Vec3 shear, moment;
  };

  /// The shorter of a vector and a limit to its length.
  static Vec3 capped(const Vec3& v, double limit) {
    const double size = v.norm();
    return (size > limit ? limit / size : 1.0) * v;
  }
  /// 1/R = 1/r1 + 1/r2; a wall, with r2 = 0, is flat.
  static double rolling_radius(const Contact& c) { return c.r2 > 0 ? c.r1 * c.r2 / (c.r1 + c.r2) : c.r1; }
  /// Stiffness against rolling, N m/rad: shear springs at the rolling radius.
  double kr(const Contact& c) const { return ks * rolling_radius(c) * rolling_radius(c); }

  void law(const SpinContact& c, State& s, MomentResponse& r) const {
    const double spring = max(0.0, -kn * c.gap);
    const Vec3 trial = c.turned(s.shear) - ks * c.slip();
    s.shear = capped(trial, fric * spring);
    s.moment = capped(c.turned(s.moment) - kr(c) * c.bend(), rolling * rolling_radius(c) * spring);
    r.force = max(0.0, spring - c.dashpot(dp_nratio, kn) * c.opening()) * c.normal + s.shear;
    r.moment = s.moment;
    r.sliding = trial.norm() > fric * spring;
  }
  Stiffness stiffness(const Contact& c) const {
    return {.normal = kn, .shear = ks, .bending = kr(c), .dashpot = dp_nratio};
  }
};

}  // namespace

SCREE_CONTACT_MODEL(Rolling, "rolling", "1.0.0", "springs, friction and rolling resistance")
