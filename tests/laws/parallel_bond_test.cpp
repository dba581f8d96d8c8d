// The parallel bond against its equations: contact_models/parallel_bond/parallel_bond.md.
#include <functional>
#include <limits>
#include <string>

#include "laws/bonded_pair.hpp"
#include "support/catch.hpp"

namespace {
using namespace scree::test;
using scree::Vec3;

constexpr double inf = std::numeric_limits<double>::infinity();
const double pi = std::acos(-1.0);
const scree_contact_model& model() {
  return built_plugins().open(scree::core::Kind::contact_model, "parallel_bond").contact_model();
}
/// What `prepare` says; "" when it accepts.
std::string prepared(std::vector<double>& rule, uint32_t form = 0) {
  char why[400] = "";
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  return model().prepare(rule.data(), form, &refusal) == 0 ? "" : why;
}
std::vector<double> rule(const Settings& more) {
  Settings settings = {{"pb_kn", 1e12}, {"pb_ks", 4e11}, {"pb_ten", inf}, {"pb_coh", inf}};
  settings.insert(settings.end(), more.begin(), more.end());
  std::vector<double> out = rule_of(model(), settings);
  REQUIRE(prepared(out).empty());
  return out;
}
BondedPair bonded(const Settings& more, double gap = 0) { return {model(), rule(more), gap}; }

// The section of a disc of 10 mm: A = pi R^2, I = pi R^4 / 4, J = 2 I.
const double area = pi * 1e-4, inertia = pi * 1e-8 / 4;

}  // namespace

TEST_CASE("parallel_bond breaks where the beam stress at its rim reaches the strength") {
  // Loads that make 1 MPa at the rim of a disc of 10 mm: F = 314.159 N, M_b = 0.785398 N m, M_t = 1.570796 N m
  // (sigma = F/A + M_b R/I, tau = |F_s|/A + M_t R/J; Potyondy and Cundall 2004, equations 15 and 16).
  struct Case {
    const char* strength;
    Vec3 displacement, rotation;  // that load to 1 MPa
    Vec3 force, moment;
    double event;
  };
  const double kn = 1e12, ks = 4e11;
  const Case cases[] = {{"pb_ten", {0, 0, 314.1592653589793 / (kn * area)}, {}, {0, 0, -314.159265}, {}, 1},
                        {"pb_ten", {}, {0, 0.7853981633974483 / (kn * inertia), 0}, {}, {0, -0.785398163, 0}, 1},
                        {"pb_coh", {314.1592653589793 / (ks * area), 0, 0}, {}, {-314.159265, 0, 0}, {}, 2},
                        {"pb_coh", {}, {0, 0, -1.5707963267948966 / (ks * 2 * inertia)}, {}, {0, 0, 1.57079633}, 2}};
  for (const Case& c : cases) {
    INFO(c.strength << " event " << c.event);
    BondedPair pair = bonded({{c.strength, 1e6}});
    pair.move(0.5 * c.displacement, 0.5 * c.rotation);
    pair.move((0.5 - 1e-7) * c.displacement, (0.5 - 1e-7) * c.rotation);
    CHECK(pair.breaks == 0);
    CHECK((pair.force() - c.force).norm() <= 1e-6 * c.force.norm());
    CHECK((pair.moment() - c.moment).norm() <= 1e-6 * c.moment.norm());
    pair.move(2e-7 * c.displacement, 2e-7 * c.rotation);
    CHECK(pair.breaks == 1);
    CHECK(pair.columns.event(0) == c.event);
    CHECK(pair.force().norm() == 0);
    CHECK(pair.moment().norm() == 0);
    pair.move(0.1 * c.displacement, 0.1 * c.rotation);
    CHECK(pair.breaks == 1);
    CHECK(pair.force().norm() + pair.moment().norm() == 0);
  }
}

TEST_CASE("parallel_bond adds stresses, weighs moments and takes tension before shear") {
  const Vec3 half{0, 0, 0.5e6 / 1e12}, bend{0.5e6 * inertia / (0.01 * 1e12 * inertia), 0, 0};
  const auto breaks = [](const Settings& settings, const Vec3& displacement, const Vec3& rotation) {
    BondedPair pair = bonded(settings);
    pair.move(displacement, rotation);
    return pair.columns.event(0);
  };
  CHECK(breaks({{"pb_ten", 1.0001e6}}, half, bend) == 0);
  CHECK(breaks({{"pb_ten", 0.9999e6}}, half, bend) == 1);
  CHECK(breaks({{"pb_ten", 0.7501e6}, {"pb_mcf", 0.5}}, half, bend) == 0);
  CHECK(breaks({{"pb_ten", 0.7499e6}, {"pb_mcf", 0.5}}, half, bend) == 1);
  CHECK(breaks({{"pb_ten", 0.5001e6}, {"pb_mcf", 0}}, half, 100.0 * bend) == 0);
  CHECK(breaks({{"pb_ten", 1e5}, {"pb_coh", 1e5}}, {1e-6, 0, 1e-6}, {}) == 1);
  // Coulomb: c - sigma_n tan(phi), tension positive. 2 MPa of pressure and 30 degrees add 1.154701 MPa.
  const Settings coulomb = {{"pb_coh", 1e6}, {"pb_fa", pi / 6}};
  CHECK(breaks(coulomb, {2.1546 * 1e6 / 4e11, 0, -2e-6}, {}) == 0);
  CHECK(breaks(coulomb, {2.1548 * 1e6 / 4e11, 0, -2e-6}, {}) == 2);
  CHECK(breaks(coulomb, {0.4225 * 1e6 / 4e11, 0, 1e-6}, {}) == 0);  // 1 - 0.57735 under as much tension
  CHECK(breaks(coulomb, {0.4228 * 1e6 / 4e11, 0, 1e-6}, {}) == 2);
}

TEST_CASE("parallel_bond computes the tangent of its friction angle") {
  for (const double angle : {0.0, 1e-9, 0.1, 0.5, pi / 4, 1.0, 1.4, 1.569})
    CHECK(rule({{"pb_fa", angle}})[word_of(model(), "pb_slope")] == Approx(std::tan(angle)).epsilon(1e-12));
}

TEST_CASE("parallel_bond adds to a linear contact, which stays and slides when the bond is gone") {
  BondedPair pair = bonded({{"kn", 1e6}, {"ks", 1e6}, {"fric", 0.5}, {"pb_coh", 1e6}});
  pair.move({0, 0, -1e-6});
  CHECK(pair.force().z == Approx(1 + 1e12 * area * 1e-6).epsilon(1e-12));
  pair.move({2e-6, 0, 0});
  CHECK(pair.columns.sliding(0));  // the springs slip below a bond that holds
  CHECK(pair.force().x == Approx(-0.5 - 4e11 * area * 2e-6).epsilon(1e-12));
  pair.move({1e-6, 0, 0});
  CHECK(pair.columns.event(0) == 2);
  CHECK(pair.force().z == Approx(1).epsilon(1e-12));
  CHECK(pair.force().x == Approx(-0.5).epsilon(1e-12));
  pair.move({0, 1e-6, -1e-6}, {1e-3, 1e-3, 1e-3});
  CHECK(pair.force().z == Approx(2).epsilon(1e-12));
  CHECK(pair.moment().norm() == 0);
}

TEST_CASE("parallel_bond starts without load, across a gap too") {
  BondedPair pair = bonded({{"kn", 1e6}}, 1e-3);
  pair.columns.dt = 0;
  pair.columns.put(0, pair.contact);
  pair.columns.run();
  CHECK(pair.force().norm() == 0);
  pair.columns.dt = 1e-5;
  pair.move({0, 0, 1e-9});
  CHECK(pair.force().z == Approx(-1e12 * area * 1e-9).epsilon(1e-6));
}

TEST_CASE("parallel_bond of strength zero breaks at the first load, an endless one never") {
  for (const Vec3& way : {Vec3{0, 0, 1e-9}, Vec3{1e-9, 0, 0}}) {
    BondedPair weak = bonded({{"pb_ten", 0}, {"pb_coh", 0}});
    weak.move({});
    weak.move({0, 0, -1e-12});
    CHECK(weak.breaks == 0);
    weak.move(way);
    CHECK(weak.columns.event(0) == (way.z > 0 ? 1 : 2));
    BondedPair endless = bonded({});
    endless.move(1e9 * way, {1, 1, 1});
    CHECK(endless.breaks == 0);
  }
}

TEST_CASE("parallel_bond stays a number for discs far too small and too large") {
  for (const double rmul : {1e-170, 1e-80, 1e-6, 10.0, 1e60}) {
    BondedPair pair = bonded({{"pb_rmul", rmul}, {"pb_ten", 1e6}, {"pb_coh", 1e6}});
    pair.move({1e-9, 0, -1e-9}, {1e-9, 0, 1e-9});
    CHECK(std::isfinite(pair.force().norm()));
    CHECK(std::isfinite(pair.moment().norm()));
    CHECK(std::isfinite(pair.strain()));
    CHECK(std::isfinite(pair.columns.energies(3, 0)));
  }
}

TEST_CASE("parallel_bond takes its stiffness from moduli, of the springs, the bond or both") {
  const scree_contact_model& m = model();
  REQUIRE(m.form_count == 4);
  CHECK(m.derived_from_pair == 14u);
  const auto derived = [&](uint32_t form, double r1, double r2, const char* name) {
    std::vector<double> words = rule_of(m, {{"kn", 5},
                                            {"ks", 6},
                                            {"pb_kn", 7},
                                            {"pb_ks", 8},
                                            {"emod", 1e9},
                                            {"kratio", 2.5},
                                            {"pb_emod", 2e9},
                                            {"pb_kratio", 4}});
    REQUIRE(prepared(words, form).empty());
    const scree_pair pair{sizeof(scree_pair), 0, r1, r2, 1.0};
    m.derive(words.data(), form, &pair);
    return words[word_of(m, name)];
  };
  CHECK(std::string(m.forms[3]) == "emod kratio pb_emod pb_kratio");
  for (const uint32_t form : {0u, 1u, 2u, 3u}) {
    CHECK(derived(form, 0.01, 0.01, "kn") == Approx(form >= 2 ? 1.570796327e7 : 5).epsilon(1e-9));
    CHECK(derived(form, 0.01, 0.02, "pb_kn") == Approx(form % 2 ? 2e9 / 0.03 : 7).epsilon(1e-14));
    CHECK(derived(form, 0.01, 0.02, "pb_ks") == Approx(form % 2 ? 0.5e9 / 0.03 : 8).epsilon(1e-14));
  }
  CHECK(derived(1, 0.01, 0, "pb_kn") == Approx(2e11).epsilon(1e-14));  // at a wall
}

TEST_CASE("parallel_bond refuses what is no bond, and says why") {
  std::vector<double> none = rule_of(model(), {});
  CHECK(prepared(none, 0).find("'pb_kn' and 'pb_ks' 0") != std::string::npos);
  CHECK(prepared(none, 3).find("'pb_emod' 0") != std::string::npos);
  std::vector<double> half = rule_of(model(), {{"pb_kn", 1}, {"cb_tenf", 1}});
  CHECK(prepared(half).find("both above 0") != std::string::npos);
}

TEST_CASE("parallel_bond keeps forces and moments while the pair turns as a rigid body") {
  BondedPair pair = bonded({{"kn", 1e6}, {"ks", 1e6}, {"fric", 1}, {"lin_mode", 1}});
  pair.contact.r1 = pair.contact.r2 = 1e-3;
  pair.move({6e-5, 4e-5, 1e-4}, {0.01, 0.02, 0.03});
  const double coarse = change_in_turns(pair, 1, 1000, false), fine = change_in_turns(pair, 1, 2000, false);
  CHECK(coarse < 1e-3);
  CHECK(coarse / fine == Approx(4).epsilon(0.1));
  CHECK(change_in_turns(pair, 2, 100, true) < 1e-12);
}

TEST_CASE("parallel_bond accounts for its work, the break included") {
  for (const double pull : {1.0, -1.0}) {
    BondedPair pair = bonded({{"kn", 1e6}, {"ks", 5e5}, {"fric", 0.3}, {"pb_ten", 1e6}, {"pb_coh", 1e6}});
    double stored = 0;
    for (int k = 0; k < 3000; ++k) {
      const double before = pair.strain();
      pair.move({0.5e-9, 0.3e-9, pull * 0.2e-9}, {1e-8, 2e-8, 3e-8});
      if (pair.columns.event(0) != 0) stored = before;
      CHECK(pair.work == Approx(pair.strain() + pair.lost).epsilon(1e-8));
    }
    CHECK(pair.breaks == 1);
    CHECK(pair.columns.event(0) == 0);
    CHECK(pair.broken == Approx(stored).epsilon(0.01));
  }
}

TEST_CASE("parallel_bond reports the tangent of force and moment, bonded and broken") {
  BondedPair pair = bonded({{"kn", 1e6}, {"ks", 5e5}, {"fric", 0.3}, {"pb_ten", 1e6}, {"dp_nratio", 0.2}});
  double kn = 0, ks = 0, bending = 0, twist = 0, dashpot = 0;
  const scree_stiffness out{sizeof(scree_stiffness), 1, &kn, &ks, &bending, &twist, &dashpot, nullptr};
  pair.columns.dt = 1e6;  // dashpots do nothing
  pair.move({0, 0, -1e-6});
  pair.columns.stiffness(out);
  CHECK(kn == Approx(1e6 + 1e12 * area).epsilon(1e-14));
  CHECK(ks == Approx(5e5 + 4e11 * area).epsilon(1e-14));
  CHECK(bending == Approx(1e12 * inertia).epsilon(1e-14));
  CHECK(twist == Approx(4e11 * 2 * inertia).epsilon(1e-14));
  CHECK(dashpot * std::sqrt(kn) == Approx(0.2 * std::sqrt(1e6)).epsilon(1e-14));
  const Vec3 force = pair.force(), moment = pair.moment();
  pair.move({1e-8, 0, 1e-8}, {1e-6, 0, 1e-6});
  CHECK((pair.force() - force).x == Approx(-1e-8 * ks).epsilon(1e-5));
  CHECK((pair.force() - force).z == Approx(-1e-8 * kn).epsilon(1e-5));
  CHECK((pair.moment() - moment).x == Approx(-1e-6 * bending).epsilon(1e-9));
  CHECK((pair.moment() - moment).z == Approx(-1e-6 * twist).epsilon(1e-9));
  pair.move({0, 0, 1e-5});
  REQUIRE(pair.breaks == 1);
  pair.columns.stiffness(out);
  CHECK(kn == 1e6);
  CHECK(ks == 5e5);
  CHECK(bending + twist == 0);
}

TEST_CASE("parallel_bond may have a contact bond beside it, and has broken when both have") {
  BondedPair pair = bonded({{"kn", 1e6}, {"ks", 1e6}, {"pb_ten", 1e6}, {"cb_tenf", 3}, {"cb_shearf", 3}});
  pair.move({0, 0, 0.9e-6});
  CHECK(pair.force().z == Approx(-0.9 - 1e12 * area * 0.9e-6).epsilon(1e-12));
  pair.move({0, 0, 0.2e-6});
  CHECK(pair.breaks == 0);
  CHECK(pair.force().z == Approx(-1.1).epsilon(1e-9));  // the glue alone
  CHECK(pair.broken == Approx(0.5 * 0.9e6 * 1.1e6 / 1e12 * area).epsilon(1e-9));
  pair.move({0, 0, 2e-6});
  CHECK(pair.breaks == 1);
  CHECK(pair.columns.event(0) == 1);
  CHECK(pair.force().norm() == 0);
}
