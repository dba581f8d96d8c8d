// Linear contact with a contact bond: glue at the contact point that carries forces and no moment, as in PFC. D. O.
// Potyondy and P. A. Cundall, "A bonded-particle model for rock", Int. J. Rock Mech. Min. Sci. 41 (2004) 1329-1364.
// Equations: contact_bond.md.
#include <scree/glued_springs.hpp>

namespace {
using namespace scree;

struct ContactBond : GluedSprings {
  static void describe(Properties<ContactBond>& p) {
    describe_springs(p, {"emod kratio"});
    p.number("cb_tenf", &ContactBond::cb_tenf, "N", "tensile strength of the bond").at_least(0).infinite();
    p.number("cb_shearf", &ContactBond::cb_shearf, "N", "shear strength of the bond").at_least(0).infinite();
    p.either("kn ks", "emod kratio");
    p.remembers("cb_state", &Bond::mode, "1");
    p.remembers("cb_gap", &Bond::gap, "m");
  }
  struct Bond {
    double mode;  ///< bond_new, bond_holds, ...
    double gap;   ///< at the end of the cycle before, m
  };

  void derive(const Pair& p) {
    if (p.form == 1) stiffness_from_modulus(p);
  }

  using LinearSprings::energy;
  using LinearSprings::law;
  using LinearSprings::stiffness;

  void law(const Contact& c, State& s, Bond& b, Response& r) const {
    b.mode = glued_law(c, opened_since(c, b.mode, b.gap), s, b.mode, r);
    b.gap = c.gap;
  }
  void energy(const Contact& c, const State& s0, const State& s, const Bond& b0, const Bond& b, const Response& r,
              Energies& e) const {
    glued_energy(c, opened_since(c, b0.mode, b0.gap), s0, b0.mode, s, b.mode, r, e);
  }
  double broken(const Bond& b) const { return break_of(b.mode); }

  Stiffness stiffness(const Contact& c, const State&, const Bond& b) const {
    Stiffness k = stiffness(c);
    if (bond_intact(b.mode)) k.shear = ks;
    return k;
  }
};

}  // namespace

SCREE_CONTACT_MODEL(ContactBond, "contact_bond", "1.0.0", "linear contact with a bond that carries forces, no moment")
