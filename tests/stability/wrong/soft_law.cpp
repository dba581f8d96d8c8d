// A law that reports only a share of its stiffness, so that the automatic step is too long.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct SoftLaw {
  double kn, share;

  static void describe(Properties<SoftLaw>& p) {
    p.number("kn", &SoftLaw::kn, "N/m", "normal stiffness").at_least(0);
    p.number("share", &SoftLaw::share, "1", "of it that is reported").above(0).at_most(1);
  }
  void law(const Contact& c, Response& r) const { r.force = -kn * c.gap * c.normal; }
  Stiffness stiffness(const Contact&) const { return {.normal = share * kn}; }
};

}  // namespace

SCREE_CONTACT_MODEL(SoftLaw, "soft_law", "1.0.0", "a law that claims to be soft")
