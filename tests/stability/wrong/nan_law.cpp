// A law that goes wrong: beyond a given overlap its force is not a number.
#include <scree/contact_model.hpp>

#include <limits>

namespace {
using namespace scree;

struct NanLaw {
  double kn, until;

  static void describe(Properties<NanLaw>& p) {
    p.number("kn", &NanLaw::kn, "N/m", "normal stiffness").at_least(0);
    p.number("until", &NanLaw::until, "m", "overlap beyond which the force is not a number").at_least(0);
  }
  void law(const Contact& c, Response& r) const {
    r.force = (-c.gap > until ? std::numeric_limits<double>::quiet_NaN() : -kn * c.gap) * c.normal;
  }
  Stiffness stiffness(const Contact&) const { return {.normal = kn}; }
};

}  // namespace

SCREE_CONTACT_MODEL(NanLaw, "nan_law", "1.0.0", "a law that returns not a number")
