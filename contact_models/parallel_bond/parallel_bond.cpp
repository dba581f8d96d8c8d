// Linear contact with a parallel bond: a disc of elastic cement that carries force and moment and breaks by the
// stresses of beam theory. D. O. Potyondy and P. A. Cundall, "A bonded-particle model for rock", Int. J. Rock Mech.
// Min. Sci. 41 (2004) 1329-1364. Property names follow PFC. Equations: parallel_bond.md.
#include <scree/glued_springs.hpp>

namespace {
using namespace scree;

struct ParallelBond : GluedSprings {
  double pb_rmul, pb_kn, pb_ks, pb_emod, pb_kratio, pb_ten, pb_coh, pb_fa, pb_mcf, pb_slope;

  static constexpr const char *kn_kn = "kn ks pb_kn pb_ks", *kn_emod = "kn ks pb_emod pb_kratio",
                              *emod_kn = "emod kratio pb_kn pb_ks", *emod_emod = "emod kratio pb_emod pb_kratio";

  static void describe(Properties<ParallelBond>& p) {
    using P = ParallelBond;
    describe_springs(p, {emod_kn, emod_emod});
    p.number("pb_kn", &P::pb_kn, "Pa/m", "normal stiffness of the bond per area")
        .at_least(0)
        .derived(kn_emod)
        .derived(emod_emod);
    p.number("pb_ks", &P::pb_ks, "Pa/m", "shear stiffness of the bond per area")
        .at_least(0)
        .derived(kn_emod)
        .derived(emod_emod);
    p.number("pb_emod", &P::pb_emod, "Pa", "modulus of the bond: pb_kn = pb_emod / length of the pair").at_least(0);
    p.number("pb_kratio", &P::pb_kratio, "1", "normal over shear stiffness of the bond; 0 means no shear stiffness")
        .at_least(0);
    p.number("pb_rmul", &P::pb_rmul, "1", "radius of the bond over the smaller radius").above(0).fallback(1);
    p.number("pb_ten", &P::pb_ten, "Pa", "tensile strength of the bond").at_least(0).infinite();
    p.number("pb_coh", &P::pb_coh, "Pa", "cohesion of the bond").at_least(0).infinite();
    p.number("pb_fa", &P::pb_fa, "rad", "friction angle of the bond; 0 is a shear strength of pb_coh at any pressure")
        .at_least(0)
        .below(1.57)
        .fallback(0);
    p.number("pb_mcf", &P::pb_mcf, "1", "share of the moments that counts in the stresses")
        .at_least(0)
        .at_most(1)
        .fallback(1);
    p.number("pb_slope", &P::pb_slope, "1", "tangent of pb_fa").derived();
    p.number("cb_tenf", &P::cb_tenf, "N", "tensile strength of a contact bond beside the parallel one")
        .at_least(0)
        .infinite()
        .fallback(0);
    p.number("cb_shearf", &P::cb_shearf, "N", "shear strength of a contact bond beside the parallel one")
        .at_least(0)
        .infinite()
        .fallback(0);
    p.either(kn_kn, kn_emod, emod_kn, emod_emod);
    p.remembers("pb_state", &Bond::mode, "1");
    p.remembers("cb_state", &Bond::glue, "1");
    p.remembers("pb_gap", &Bond::gap, "m");
    p.remembers("pb_force", &Bond::force, "N");
    p.remembers("pb_moment", &Bond::moment, "N m");
  }
  struct Bond {
    double mode, glue;  ///< of the parallel and of the contact bond
    double gap;         ///< at the end of the cycle before, m
    Vec3 force;         ///< of the cement on piece 2, N
    Vec3 moment;        ///< N m: twist along the normal, bending across it
  };

  /// The tangent, with the same bits on every machine: Lambert's continued fraction of an eighth of the angle, doubled
  /// three times.
  static double slope_of(double angle) {
    const double y = angle / 8, square = y * y;
    double fraction = 13;
    for (double odd = 11; odd > 0; odd -= 2) fraction = odd - square / fraction;
    double t = y / fraction;
    for (int k = 0; k < 3; ++k) t = 2 * t / (1 - t * t);
    return t;
  }
  void prepare(uint32_t form) {
    pb_slope = slope_of(pb_fa);
    if ((cb_tenf > 0) != (cb_shearf > 0))
      throw std::invalid_argument(
          "'cb_tenf' and 'cb_shearf' are the strengths of one contact bond: give both above 0, or neither");
    const bool by_modulus = form == 1 || form == 3;
    if (by_modulus ? !(pb_emod > 0) : !(pb_kn > 0 || pb_ks > 0))
      throw std::invalid_argument(by_modulus
                                      ? "a parallel bond with 'pb_emod' 0 has no stiffness and can carry nothing; "
                                        "give a modulus above 0, or take the model 'contact_bond' or 'linear'"
                                      : "a parallel bond with 'pb_kn' and 'pb_ks' 0 has no stiffness and can "
                                        "carry nothing; give one above 0, or take the model 'contact_bond' or "
                                        "'linear'");
  }
  void derive(const Pair& p) {
    if (p.form >= 2) stiffness_from_modulus(p);
    if (p.form == 0 || p.form == 2) return;
    pb_kn = pb_emod / (p.r1 + p.r2);
    pb_ks = pb_kratio > 0 ? pb_kn / pb_kratio : 0.0;
  }

  using LinearSprings::energy;
  using LinearSprings::law;
  using LinearSprings::stiffness;

  /// The disc: its radius and stiffnesses in N/m and N m/rad.
  struct Disc {
    double radius, area, normal, shear, bending, twist;
  };
  SCREE_INLINE Disc disc(const Contact& c) const {
    const double radius = pb_rmul * (c.r2 > 0 ? min(c.r1, c.r2) : c.r1 + 0.0);
    const double square = radius * radius, area = 3.14159265358979323846 * square, inertia = 0.25 * area * square;
    return {radius, area, pb_kn * area, pb_ks * area, pb_kn * inertia, pb_ks * (2 * inertia)};
  }
  bool glues() const { return cb_tenf > 0; }
  /// 0 where there is nothing to divide by: a disc too small for its area to be told from nothing.
  SCREE_INLINE static double over(double a, double b) { return b > 0 ? a / b : 0.0; }

  SCREE_INLINE static Vec3 force_after(const SpinContact& c, const Disc& d, const Bond& b, double opened) {
    return c.carried(b.force) - (d.normal * opened) * c.normal - d.shear * c.slip();
  }
  SCREE_INLINE static Vec3 moment_after(const SpinContact& c, const Disc& d, const Bond& b) {
    return c.carried(b.moment) - (d.twist * c.twist()) * c.normal - d.bending * c.bend();
  }
  /// Tension first, then shear; a strength of zero breaks at the first load, and not before there is one.
  SCREE_INLINE double mode_under(const SpinContact& c, const Disc& d, const Vec3& force, const Vec3& moment) const {
    const double push = force.dot(c.normal), twist = moment.dot(c.normal);
    const Vec3 across = force - push * c.normal, bend = moment - twist * c.normal;
    // |M_b| R / I and |M_t| R / J without the fourth power of a radius that may be tiny.
    const double section = d.area * d.radius, pressure = over(push, d.area);
    const double tension = pb_mcf * over(4 * bend.norm(), section) - pressure;
    const double shear = over(across.norm(), d.area) + pb_mcf * over(2 * abs(twist), section);
    const double strength = pb_coh + pressure * pb_slope;
    const bool torn = tension > 0 && !(tension < pb_ten);
    const bool sheared = (shear > 0 || strength < 0) && !(shear < strength);
    return torn ? 1.0 * bond_broke_in_tension : sheared ? 1.0 * bond_broke_in_shear : 1.0 * bond_holds;
  }

  void law(const SpinContact& c, State& s, Bond& b, MomentResponse& r) const {
    const double opened = opened_since(c, b.mode, b.gap);
    const double glue = glues() ? b.glue : 1.0 * bond_broke_in_tension;
    const double glue_after = glued_law(c, opened, s, glue, r);
    const Disc d = disc(c);
    const Vec3 force = force_after(c, d, b, opened), moment = moment_after(c, d, b);
    const bool held = bond_intact(b.mode);
    const double mode = mode_under(c, d, force, moment);
    const double holds = held && mode < 0 ? 1.0 : 0.0;
    b.mode = held ? mode : b.mode + 0.0;
    b.glue = glues() ? glue_after : 0.0;
    b.gap = c.gap;
    b.force = holds * force;
    b.moment = holds * moment;
    r.force += b.force;
    r.moment = b.moment;
  }
  /// Both bonds gone; of which kind the parallel one went.
  double broken(const Bond& b) const {
    const double alone = break_of(b.mode), beside = bond_intact(b.glue) ? 0.0 : +alone;
    return glues() ? +beside : +alone;
  }

  void energy(const SpinContact& c, const State& s0, const State& s, const Bond& b0, const Bond& b,
              const MomentResponse& r, Energies& e) const {
    const double opened = opened_since(c, b0.mode, b0.gap);
    const double gone = bond_broke_in_tension;
    glued_energy(c, opened, s0, glues() ? b0.glue : gone, s, glues() ? b.glue : gone, r, e);
    const Disc d = disc(c);
    const bool broke = bond_intact(b0.mode) && bond_broke(b.mode);
    e.strain += strain(c, d, b.force, b.force, b.moment, b.moment);
    // The mean force over the stretch given up, as in glued_energy; of the force after the break nothing is left.
    const double lost =
        strain(c, d, c.carried(b0.force), force_after(c, d, b0, opened), c.carried(b0.moment), moment_after(c, d, b0));
    e.broken += broke ? lost : 0.0;
  }
  /// Half of the product of two loads over the stiffnesses: of a load with itself it is what the disc stores.
  SCREE_INLINE static double strain(const SpinContact& c, const Disc& d, const Vec3& f, const Vec3& g, const Vec3& m,
                                    const Vec3& n) {
    const double fn = f.dot(c.normal), gn = g.dot(c.normal), mt = m.dot(c.normal), nt = n.dot(c.normal);
    return 0.5 * (over(fn * gn, d.normal) + over(f.dot(g) - fn * gn, d.shear) + over(mt * nt, d.twist) +
                  over(m.dot(n) - mt * nt, d.bending));
  }

  Stiffness stiffness(const Contact& c, const State&, const Bond& b) const {
    Stiffness k = stiffness(c);
    if (glues() && bond_intact(b.glue)) k.shear = ks;
    if (bond_broke(b.mode)) return k;
    const Disc d = disc(c);
    // The dashpots stay those of the springs: shares of what is critical beside the larger stiffness.
    const double normal = k.normal + d.normal, shear = k.shear + d.shear;
    return {.normal = normal,
            .shear = shear,
            .bending = d.bending,
            .twist = d.twist,
            .dashpot = k.dashpot * std::sqrt(over(k.normal, normal)),
            .dashpot_shear = k.dashpot_shear * std::sqrt(over(k.shear, shear))};
  }
};

}  // namespace

SCREE_CONTACT_MODEL(ParallelBond, "parallel_bond", "1.0.0", "linear contact with a disc of cement that carries moments")
