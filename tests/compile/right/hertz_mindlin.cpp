// Sketch: Hertz's normal force and Mindlin's initial shear stiffness, with properties computed by `prepare` and from
// the pair. F = h d^1.5 with h = 2 G sqrt(2 R) / (3 (1 - nu)), R = 2 r1 r2 / (r1 + r2).
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct HertzMindlin {
  double shear, poiss, fric, dp_nratio, modulus, ratio, h;

  static constexpr bool nonlinear = true;
  static void describe(Properties<HertzMindlin>& p) {
    p.number("shear", &HertzMindlin::shear, "Pa", "shear modulus").above(0).mix(mean);
    p.number("poiss", &HertzMindlin::poiss, "1", "Poisson's ratio").at_least(0).below(0.5).mix(mean);
    p.number("fric", &HertzMindlin::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
    p.number("dp_nratio", &HertzMindlin::dp_nratio, "1", "share of critical damping").at_least(0).fallback(0);
    p.number("modulus", &HertzMindlin::modulus, "Pa", "G / (1 - nu)").derived();
    p.number("ratio", &HertzMindlin::ratio, "1", "shear over normal stiffness").derived();
    p.number("h", &HertzMindlin::h, "Pa m^0.5", "force over overlap^1.5").derived();
    p.remembers("shear_force", &State::force, "N");
    p.remembers("normal_force", &State::normal, "N");
  }
  struct State {
    Vec3 force;
    double normal;
  };

  void prepare() {
    if (poiss >= 0.5) throw std::runtime_error("an incompressible ball has no Hertz contact");
    modulus = shear / (1 - poiss);
    ratio = 2 * (1 - poiss) / (2 - poiss);
  }
  void derive(const Pair& p) {
    const double r = p.wall() ? 2 * p.r1 : 2 * p.r1 * p.r2 / (p.r1 + p.r2);
    h = 2.0 / 3.0 * modulus * sqrt(2 * r);
  }
  void law(const Contact& c, State& s, Response& r) const {
    const double depth = max(0.0, -c.gap), root = sqrt(depth);
    const double normal = h * depth * root, kn = 1.5 * h * root, ks = ratio * kn;
    Vec3 before = c.turned(s.force);
    if (normal < s.normal) before *= sqrt(sqrt(normal / s.normal));
    const Vec3 trial = before - ks * c.slip();
    const double size = trial.norm(), limit = fric * normal;
    s.force = (size > limit ? limit / size : 1.0) * trial;
    s.normal = normal;
    r.force = (normal - c.dashpot(dp_nratio, kn) * c.opening()) * c.normal + s.force;
    r.sliding = size > limit;
  }
  Stiffness stiffness(const Contact& c, const State&) const {
    const double kn = 1.5 * h * sqrt(max(0.0, -c.gap));
    return {.normal = kn, .shear = ratio * kn, .dashpot = dp_nratio};
  }
};

}  // namespace

SCREE_CONTACT_MODEL(HertzMindlin, "hertz_mindlin", "0.1.0")
