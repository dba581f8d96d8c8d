// Sketch: a pull that acts before touch, with nothing to remember.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct Capillary {
  double kn, pull, range;

  static void describe(Properties<Capillary>& p) {
    p.number("kn", &Capillary::kn, "N/m", "normal stiffness").at_least(0).mix(series);
    p.number("pull", &Capillary::pull, "N", "force of the bridge").at_least(0);
    p.number("range", &Capillary::range, "m", "gap at which the bridge breaks").at_least(0);
  }
  double reach(const Pair&) const { return range; }
  void law(const Contact& c, Response& r) const {
    r.force = (max(0.0, -kn * c.gap) - (c.gap < range ? pull : 0.0)) * c.normal;
  }
  Stiffness stiffness(const Contact&) const { return {.normal = kn}; }
};

}  // namespace

SCREE_CONTACT_MODEL(Capillary, "capillary", "0.1.0")
