// Balls that attract each other before they touch: a pull that falls off linearly to zero at the gap `range`, as
// simple models of liquid bridges and van der Waals forces have it, beside a linear spring.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct Sticky {
  double kn, pull, range, dp_nratio;

  static void describe(Properties<Sticky>& p) {
    p.number("kn", &Sticky::kn, "N/m", "normal stiffness").at_least(0).mix(series);
    p.number("pull", &Sticky::pull, "N", "largest attraction, that at touch").at_least(0).mix(least);
    p.number("range", &Sticky::range, "m", "gap at which the attraction ends").at_least(1e-12).mix(least);
    p.number("dp_nratio", &Sticky::dp_nratio, "1", "dashpot while touching, share of critical")
        .at_least(0)
        .fallback(0)
        .mix(mean);
  }

  /// The kernel keeps pairs up to this gap in the list of the rule, and calls the law for them.
  double reach(const Pair&) const { return range; }

  double attraction(double gap) const { return pull * min(1.0, max(0.0, 1.0 - gap / range)); }

  /// No State: what happens depends on the present only.
  void law(const Contact& c, Response& r) const {
    const bool touching = c.gap < 0;
    const double spring = touching ? -kn * c.gap - c.dashpot(dp_nratio, kn) * c.opening() : 0.0;
    r.force = (spring - attraction(c.gap)) * c.normal;
  }

  /// The attraction weakens as the pair opens, a negative tangent; its size keeps the bound of the step on the safe
  /// side.
  Stiffness stiffness(const Contact&) const { return {.normal = max(kn, pull / range), .dashpot = dp_nratio}; }
};

}  // namespace

SCREE_CONTACT_MODEL(Sticky, "sticky", "1.0.0", "linear spring and an attraction across a gap")
