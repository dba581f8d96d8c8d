// A law that obeys no principle: its force leans sideways by a fixed axis of the scene, and its moment has a fixed
// direction and depends on which piece is called the first.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct CrookedLaw {
  double kn, tear;
  Vec3 lean, moment;

  static constexpr bool nonlinear = true;
  static void describe(Properties<CrookedLaw>& p) {
    p.number("kn", &CrookedLaw::kn, "N/m", "normal stiffness, for pull and push").above(0);
    p.number("tear", &CrookedLaw::tear, "m", "gap at which it lets go").at_least(0);
    p.vector("lean", &CrookedLaw::lean, "N", "sideways force, whatever the contact does");
    p.vector("moment", &CrookedLaw::moment, "N m", "moment, whatever the contact does");
  }
  double reach(const Pair&) const { return tear; }
  void law(const SpinContact& c, MomentResponse& r) const {
    r.force = -kn * c.gap * c.normal + (1 + c.normal.z) * lean;
    r.moment = (1 + c.normal.x + 0.5 * (c.r1 - c.r2) / c.r1) * moment;
  }
  Stiffness stiffness(const Contact&) const { return {.normal = kn}; }
};

}  // namespace

SCREE_CONTACT_MODEL(CrookedLaw, "crooked_law", "1.0.0", "a law without any symmetry")
