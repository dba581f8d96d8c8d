// Hertz's normal force and Mindlin's initial shear stiffness with Coulomb slip: R. D. Mindlin, "Compliance of elastic
// bodies in contact", J. Appl. Mech. 16 (1949) 259-268. Dashpots that keep the restitution independent of speed:
// T. Antypov and J. A. Elliott, "On an analytical solution for the damped Hertzian spring", EPL 94 (2011) 50004.
// Property names and modes follow PFC. Equations: hertz_mindlin.md.
#include <scree/contact_model.hpp>
#include <scree/plain_math.hpp>

namespace {
using namespace scree;

/// Restitution of a linear spring whose dashpot, `b` of critical, never pulls: T. Schwager and T. Poeschel, Granular
/// Matter 9 (2007) 465.
double unpulled_restitution(double b) {
  if (b < 1) {
    const double s = std::sqrt(1 - b * b);
    const double turn = 2 * plain_arctan(s / b);  // cos(turn/2) = b
    return plain_exp(-b / s * turn);
  }
  if (b == 1) return plain_exp(-2.0);
  const double s = std::sqrt((b - 1) * (b + 1));
  return plain_exp(-2 * b / s * plain_log(b + s));  // (b + s)/(b - s) = (b + s)^2
}

/// The share of critical damping of a linear spring that gives the restitution `e`, above 0 where it may not pull.
double linear_share(double e, bool pulls) {
  if (e >= 1) return 0;
  if (pulls) {
    constexpr double pi = 3.14159265358979323846;
    const double log = e > 0 ? plain_log(e) : 0;
    return e > 0 ? -log / std::sqrt(pi * pi + log * log) : 1;
  }
  double low = 0, high = 1;
  while (unpulled_restitution(high) > e) low = high, high *= 2;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (unpulled_restitution(middle) > e ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

struct HertzMindlin {
  double shear, poiss, fric, restitution, dp_nratio, dp_sratio, dp_mode, hz_mode, hz_mixing, shear_per_normal, h;

  static constexpr bool nonlinear = true;
  static void describe(Properties<HertzMindlin>& p) {
    p.number("shear", &HertzMindlin::shear, "Pa", "shear modulus").above(0).infinite().mix(mean);
    p.number("poiss", &HertzMindlin::poiss, "1", "Poisson's ratio").above(-1).at_most(0.5).mix(mean);
    p.number("fric", &HertzMindlin::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
    p.number("dp_nratio", &HertzMindlin::dp_nratio, "1", "normal dashpot, share of critical damping of the tangent")
        .at_least(0)
        .mix(mean);
    p.number("restitution", &HertzMindlin::restitution, "1", "speed after over speed before a head-on impact")
        .at_least(0)
        .at_most(1)
        .mix(mean);
    p.number("dp_sratio", &HertzMindlin::dp_sratio, "1", "shear dashpot, share of critical damping of the tangent")
        .at_least(0)
        .fallback(0)
        .mix(mean);
    p.integer("dp_mode", &HertzMindlin::dp_mode,
              "0 full dashpots, 1 normal force never pulls, 2 no shear dashpot while sliding, 3 both")
        .at_least(0)
        .at_most(3)
        .fallback(0);
    p.integer("hz_mode", &HertzMindlin::hz_mode,
              "shear force when the overlap changes: 0 stays, 1 falls with the stiffness, 2 goes with the stiffness")
        .at_least(0)
        .at_most(2)
        .fallback(1);
    p.integer("hz_mixing", &HertzMindlin::hz_mixing,
              "shear and poiss of two pieces: 0 compliances add up as in theory, 1 means of both as in PFC")
        .at_least(0)
        .at_most(1)
        .fallback(0);
    p.number("shear_per_normal", &HertzMindlin::shear_per_normal, "1", "shear over normal stiffness").derived();
    p.number("h", &HertzMindlin::h, "Pa m^0.5", "normal force over overlap^1.5").derived();
    p.either("dp_nratio", "restitution");
    p.remembers("shear_force", &State::force, "N");
    p.remembers("shear_stiffness", &State::stiffness, "N/m");
  }

  struct State {
    Vec3 force;        ///< of the shear spring
    double stiffness;  ///< of the shear spring at the overlap at which `force` was
  };

  bool pulls() const { return dp_mode == 0 || dp_mode == 2; }

  /// The modulus and ratio that two equal pieces would need to be as compliant, normal and in shear, as these two. A
  /// piece of infinite modulus and a wall without one are rigid.
  void mixed(const HertzMindlin& piece1, const HertzMindlin& piece2) {
    if (hz_mixing == 1) {
      if (piece1.rigid() || piece2.rigid())
        throw std::runtime_error(
            "one piece is rigid (its 'shear' is infinite or a wall's is not given), and hz_mixing 1 has no mean of "
            "that: take hz_mixing 0, or give 'shear' and 'poiss' on the rule");
      return;
    }
    if (piece1.shear == piece2.shear && piece1.poiss == piece2.poiss) return;
    const double normal = piece1.compliance() + piece2.compliance();
    if (normal == 0) return;  // both are rigid, which `prepare` refuses
    const double ratio = 4 * normal / (piece1.compliance_across() + piece2.compliance_across());
    poiss = (2 - 2 * ratio) / (2 - ratio);
    shear = (1 - poiss) / normal;
  }
  bool rigid() const { return !(shear <= std::numeric_limits<double>::max()); }
  double compliance() const { return rigid() ? 0 : (1 - with_poiss()) / (2 * shear); }  ///< (1 - nu^2)/E
  double compliance_across() const { return rigid() ? 0 : (2 - with_poiss()) / shear; }
  double with_poiss() const {
    if (poiss != poiss) throw std::runtime_error("the wall gives 'shear' and no 'poiss': give both, or neither");
    return poiss;
  }

  void prepare(uint32_t form) {
    if (rigid()) throw std::runtime_error("'shear' is infinite, but a contact of two rigid pieces has no stiffness");
    shear_per_normal = 2 * (1 - poiss) / (2 - poiss);
    if (form == 0) return;
    if (restitution == 0 && !pulls())
      throw std::runtime_error(
          "'restitution' is 0, but with dp_mode 1 and 3 the normal force never pulls and every finite dashpot gives "
          "something back: give a restitution above 0, or dp_mode 0 or 2");
    // With u = overlap^(5/4) the law is a linear spring in the plane of u and speed, its dashpot sqrt(6/5) of this one.
    dp_nratio = std::sqrt(5.0 / 6.0) * linear_share(restitution, pulls());
  }
  void derive(const Pair& p) {
    const double radius = p.wall() ? p.r1 : p.r1 * p.r2 / (p.r1 + p.r2);
    h = 4.0 / 3.0 * shear / (1 - poiss) * sqrt(radius);
  }

  struct Springs {
    double normal, kn, ks;  ///< normal force, N, and tangents, N/m
    Vec3 shear_before;      ///< remembered shear force, turned and carried over to the new overlap
  };
  double tangent(double root) const { return 1.5 * h * root; }
  Springs springs(const Contact& c, const State& s) const {
    const double depth = max(0.0, -c.gap), root = sqrt(depth), kn = tangent(root), ks = shear_per_normal * kn;
    const double change = s.stiffness > 0 ? ks / s.stiffness : 1.0;
    const double kept = hz_mode == 0 ? 1.0 : hz_mode == 1 ? min(1.0, change) : change;
    return {h * depth * root, kn, ks, kept * c.turned(s.force)};
  }
  double normal_force(const NormalContact& c, double spring, double kn) const {
    const double total = spring - c.dashpot(dp_nratio, kn) * c.opening();
    return pulls() ? total : max(0.0, total);
  }
  Vec3 shear_dashpot(const Contact& c, double ks, bool sliding) const {
    // Without an increment nobody can tell a sliding contact from a sticking one; modes 2 and 3 then leave it out.
    const bool off = dp_mode >= 2 && (sliding || c.dt == 0);
    return (off ? 0.0 : c.dashpot(dp_sratio, ks)) * c.slip_rate();
  }

  void law(const Contact& c, State& s, Response& r) const {
    const Springs now = springs(c, s);
    const Vec3 trial = now.shear_before - now.ks * c.slip();
    const double size = trial.norm(), limit = fric * now.normal;  // the dashpot does not add to friction
    const bool sliding = size > limit;
    s.force = (sliding ? limit / size : 1.0) * trial;
    s.stiffness = now.ks;
    r.force = normal_force(c, now.normal, now.kn) * c.normal + s.force - shear_dashpot(c, now.ks, sliding);
    r.sliding = sliding;
  }

  void energy(const Contact& c, const State& old, const State& s, const Response& r, Energies& e) const {
    const Springs now = springs(c, old);
    e.strain = normal_strain(c, now.normal) + stored(s.force, now.ks);
    // What the shear spring loses as its stiffness changes counts as friction: in a real contact it goes into slip at
    // the rim. Modes 0 and 2 gain in one sense; that is not taken back, so the account shows it.
    const double change = stored(old.force, old.stiffness) - stored(now.shear_before, now.ks);
    const Vec3 elastic = now.ks > 0 ? (now.shear_before - s.force) / now.ks : Vec3{};
    const double slid = r.sliding ? -0.5 * (now.shear_before + s.force).dot(c.slip() - elastic) : 0.0;
    e.friction = max(0.0, change) + (now.ks > 0 ? slid : 0.0);
    const double pull = now.normal - normal_force(c, now.normal, now.kn);
    e.dashpot = c.dt * (pull * c.opening() + shear_dashpot(c, now.ks, r.sliding).dot(c.slip_rate()));
  }
  static double stored(const Vec3& force, double k) { return k > 0 ? 0.5 * force.squaredNorm() / k : 0.0; }
  static double normal_strain(const NormalContact& c, double force) { return 0.4 * force * max(0.0, -c.gap); }

  bool normal_only() const { return fric == 0 && dp_sratio == 0; }
  void law_normal(const NormalContact& c, NormalResponse& r) const {
    const double depth = max(0.0, -c.gap), root = sqrt(depth);
    r.force = normal_force(c, h * depth * root, tangent(root));
  }
  void energy_normal(const NormalContact& c, const NormalResponse& r, Energies& e) const {
    const double depth = max(0.0, -c.gap), spring = h * depth * sqrt(depth);
    e.strain = normal_strain(c, spring);
    e.dashpot = c.dt * (spring - r.force) * c.opening();
  }

  Stiffness stiffness(const Contact& c) const {
    const double kn = tangent(sqrt(max(0.0, -c.gap)));
    const bool shears = fric > 0 || dp_sratio > 0;
    return {
        .normal = kn, .shear = shears ? shear_per_normal * kn : 0.0, .dashpot = dp_nratio, .dashpot_shear = dp_sratio};
  }
};

}  // namespace

SCREE_CONTACT_MODEL(HertzMindlin, "hertz_mindlin", "1.0.0", "Hertz-Mindlin contact, dashpots and Coulomb friction")
