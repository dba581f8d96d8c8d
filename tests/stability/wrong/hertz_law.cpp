// Hertz's normal force without anything else: F = h d^1.5, for collisions with a known peak.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct HertzLaw {
  double h;

  static constexpr bool nonlinear = true;
  static void describe(Properties<HertzLaw>& p) {
    p.number("h", &HertzLaw::h, "Pa m^0.5", "force over overlap^1.5").above(0);
  }
  void law(const Contact& c, Response& r) const {
    const double depth = max(0.0, -c.gap);
    r.force = h * depth * sqrt(depth) * c.normal;
  }
  Stiffness stiffness(const Contact& c) const { return {.normal = 1.5 * h * sqrt(max(0.0, -c.gap))}; }
};

}  // namespace

SCREE_CONTACT_MODEL(HertzLaw, "hertz_law", "1.0.0", "Hertz's normal force")
