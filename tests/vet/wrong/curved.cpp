// A law whose shear spring stiffens with the overlap: one that scales its shear force down when it unloads, one that
// does not and so makes energy, and bonds that are wrong in one way each.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

template <bool scales>
struct Curved {
  double h, ratio, fric;

  static constexpr bool nonlinear = true;
  static void describe(Properties<Curved>& p) {
    p.number("h", &Curved::h, "Pa m^0.5", "force over overlap^1.5").above(1e8);
    p.number("ratio", &Curved::ratio, "1", "shear over normal stiffness").at_least(0.5).at_most(1);
    p.number("fric", &Curved::fric, "1", "friction coefficient").at_least(0.5);
  }
  struct State {
    Vec3 shear;
    double depth;
  };
  void law(const Contact& c, State& s, Response& r) const {
    const double depth = max(0.0, -c.gap), root = sqrt(depth), normal = h * depth * root;
    Vec3 before = c.turned(s.shear);
    if (scales && depth < s.depth) before *= sqrt(depth / s.depth);
    const Vec3 trial = before - (ratio * 1.5 * h * root) * c.slip();
    const double size = trial.norm(), limit = fric * normal;
    s.shear = (size > limit ? limit / size : 1.0) * trial;
    s.depth = depth;
    r.force = normal * c.normal + s.shear;
    r.sliding = size > limit;
  }
  Stiffness stiffness(const Contact& c) const {
    const double kn = 1.5 * h * sqrt(max(0.0, -c.gap));
    return {.normal = kn, .shear = ratio * kn};
  }
};

enum Defect { none, soft, never_lets_go };

/// A spring that glues the pieces together until it is pulled too far; it also bends.
template <Defect wrong>
struct Glue {
  double kn, strength;

  static void describe(Properties<Glue>& p) {
    p.number("kn", &Glue::kn, "N/m", "normal stiffness").above(0);
    p.number("strength", &Glue::strength, "N", "pull that breaks it").at_least(0).infinite();
  }
  struct State {};
  struct Bond {
    double mode, pull;
    Vec3 moment;
  };
  double bending(const Contact& c, double share) const { return share * kn * (c.r1 + c.r2) * (c.r1 + c.r2); }
  void law(const Contact& c, State&, Response& r) const { r.force = max(0.0, -kn * c.gap) * c.normal; }
  void law(const SpinContact& c, State& s, Bond& b, MomentResponse& r) const {
    law(c, s, r);
    if (b.mode != 0 && wrong != never_lets_go) return;
    b.pull += kn * c.opening() * c.dt;
    b.moment = c.turned(b.moment) - bending(c, 0.1) * c.bend();
    if (b.pull > strength) b.mode = 1;
    if (b.mode != 0 && wrong != never_lets_go) return;
    r.force -= b.pull * c.normal;
    r.moment += b.moment;
  }
  double broken(const Bond& b) const { return b.mode; }
  Stiffness stiffness(const Contact&) const { return {.normal = kn}; }
  Stiffness stiffness(const Contact& c, const State&, const Bond&) const {
    return {.normal = 2 * kn, .bending = bending(c, wrong == soft ? 0.01 : 0.1)};
  }
};

}  // namespace

SCREE_PLUGIN(scree::contact_model<Curved<true>>("sound", "1.0.0"),
             scree::contact_model<Curved<false>>("no_rescale", "1.0.0"),
             scree::contact_model<Glue<none>>("sound_glue", "1.0.0"),
             scree::contact_model<Glue<soft>>("soft_bond", "1.0.0"),
             scree::contact_model<Glue<never_lets_go>>("never_lets_go", "1.0.0"))
