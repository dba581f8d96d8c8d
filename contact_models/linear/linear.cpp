// Linear springs, dashpots and Coulomb slip, as of scree/linear_springs.hpp. Equations: linear.md.
#include <scree/linear_springs.hpp>

namespace {
using namespace scree;

struct Linear : LinearSprings {
  static void describe(Properties<Linear>& p) {
    describe_springs(p, {"emod kratio"});
    p.either("kn ks", "emod kratio");
  }

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

  void derive(const Pair& p) {
    if (p.form == 1) stiffness_from_modulus(p);
  }
};

}  // namespace

SCREE_CONTACT_MODEL(Linear, "linear", "1.0.0", "linear springs, dashpots and Coulomb friction")
