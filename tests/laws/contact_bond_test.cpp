// The contact bond against its equations: contact_models/contact_bond/contact_bond.md.
#include <limits>

#include "laws/bonded_pair.hpp"
#include "support/catch.hpp"

namespace {
using namespace scree::test;
using scree::Vec3;

constexpr double inf = std::numeric_limits<double>::infinity();
const scree_contact_model& model(const char* name) {
  return built_plugins().open(scree::core::Kind::contact_model, name).contact_model();
}
std::vector<double> rule(const Settings& more, const char* name = "contact_bond") {
  Settings settings = {{"kn", 1e6}, {"ks", 4e5}};
  settings.insert(settings.end(), more.begin(), more.end());
  return rule_of(model(name), settings);
}
BondedPair bonded(const Settings& more, double gap = 0) { return {model("contact_bond"), rule(more), gap}; }

}  // namespace

TEST_CASE("contact_bond pulls up to its tensile strength and then lets go of everything") {
  BondedPair pair = bonded({{"cb_tenf", 10}, {"cb_shearf", inf}, {"fric", 0.5}});
  pair.move({0, 0, 9e-6});
  CHECK(pair.force().z == Approx(-9).epsilon(1e-13));
  pair.move({1e-6, 0, 0.999999e-6});
  CHECK(pair.force().z == Approx(-9.999999).epsilon(1e-13));
  CHECK(pair.force().x == Approx(-0.4).epsilon(1e-13));  // no friction cone holds a bond
  CHECK(pair.breaks == 0);
  pair.move({0, 0, 0.000002e-6});
  CHECK(pair.breaks == 1);
  CHECK(pair.columns.event(0) == 1);
  CHECK(pair.force().norm() == 0);
  // In the list of bonds for some cycles more, it is a contact without a bond.
  pair.move({0, 0, 1e-6});
  CHECK(pair.force().norm() == 0);
  pair.move({0, 0, -1.6e-5});
  CHECK(pair.force().z == Approx(4.999999).epsilon(1e-10));
  CHECK(pair.breaks == 1);
}

TEST_CASE("contact_bond sheared off under pressure keeps what friction holds, and goes on as linear does") {
  const Settings settings = {{"fric", 0.1}, {"dp_nratio", 0.1}, {"dp_sratio", 0.1}, {"dp_mode", 3}};
  Settings glued = settings;
  glued.insert(glued.end(), {{"cb_tenf", 1}, {"cb_shearf", 8}});
  BondedPair pair = bonded(glued);
  pair.columns.dt = 1e6;  // dashpots do nothing
  pair.move({0, 0, -2e-5});
  pair.move({1.99e-5, 0, 0});
  CHECK(pair.force().x == Approx(-7.96).epsilon(1e-6));  // four times the friction of 2 N
  CHECK_FALSE(pair.columns.sliding(0));
  pair.move({0.02e-5, 0, 0});
  CHECK(pair.columns.event(0) == 2);
  CHECK(pair.columns.sliding(0));
  CHECK(pair.force().z == Approx(20).epsilon(1e-6));
  CHECK(pair.force().x == Approx(-2).epsilon(1e-6));
  for (const double lin_mode : {0.0, 1.0}) {
    Columns linear(model("linear"), rule(settings, "linear"), 1);
    pair.columns.set_rule(word_of(model("contact_bond"), "lin_mode"), lin_mode);
    linear.set_rule(word_of(model("linear"), "lin_mode"), lin_mode);
    for (std::size_t w = 0; w < 3; ++w) linear.state(w)[0] = pair.columns.state(w)[0];
    linear.dt = pair.columns.dt = 1e-5;
    Numbers random(5);
    for (int cycle = 0; cycle < 50; ++cycle) {
      pair.move(random.between(0, 2e-6) * random.vector(1));
      linear.put(0, pair.contact);
      linear.run();
      CHECK((pair.force() - linear.force(0)).norm() <= 1e-9);
    }
  }
  CHECK(pair.breaks == 1);
}

TEST_CASE("contact_bond of strength zero breaks at the first load, an endless one never") {
  for (const Vec3& way : {Vec3{0, 0, 1e-9}, Vec3{1e-9, 0, 0}}) {
    BondedPair weak = bonded({{"cb_tenf", 0}, {"cb_shearf", 0}});
    weak.move({});
    weak.move({0, 0, -1e-9});
    CHECK(weak.breaks == 0);
    weak.move(way.z > 0 ? 2.0 * way : way);
    CHECK(weak.columns.event(0) == (way.z > 0 ? 1 : 2));
    BondedPair endless = bonded({{"cb_tenf", inf}, {"cb_shearf", inf}});
    endless.move(1e9 * way);
    CHECK(endless.breaks == 0);
    CHECK(endless.force().norm() == Approx(way.z > 0 ? 1e6 : 4e5).epsilon(1e-12));
  }
}

TEST_CASE("contact_bond made across a gap pulls at once in lin_mode 0 and starts free of force in lin_mode 1") {
  for (const double lin_mode : {0.0, 1.0}) {
    BondedPair pair = bonded({{"cb_tenf", inf}, {"cb_shearf", inf}, {"lin_mode", lin_mode}}, 3e-6);
    pair.move({});
    CHECK(pair.force().z == Approx(lin_mode == 0 ? -3 : 0).epsilon(1e-12));
    pair.move({0, 0, -1e-6});
    CHECK(pair.force().z == Approx(lin_mode == 0 ? -2 : 1).epsilon(1e-12));
  }
}

TEST_CASE("contact_bond keeps its forces while the pair turns as a rigid body") {
  for (const double lin_mode : {0.0, 1.0}) {
    BondedPair pair = bonded({{"cb_tenf", inf}, {"cb_shearf", inf}, {"lin_mode", lin_mode}});
    pair.contact.r1 = pair.contact.r2 = 1e-3;
    pair.move({6e-5, 4e-5, 1e-4});
    // The velocity of a step is a chord, the normal that of its end: an error of second order in the step.
    const double coarse = change_in_turns(pair, 1, 1000, false), fine = change_in_turns(pair, 1, 2000, false);
    CHECK(coarse < 1e-3);
    CHECK(coarse / fine == Approx(4).epsilon(0.1));
    CHECK(change_in_turns(pair, 2, 100, true) < 1e-12);
  }
}

TEST_CASE("contact_bond accounts for its work, the break included") {
  for (const double lin_mode : {0.0, 1.0})
    for (const double pull : {1.0, -1.0}) {
      BondedPair pair = bonded({{"cb_tenf", 5}, {"cb_shearf", 3}, {"fric", 0.2}, {"lin_mode", lin_mode}});
      for (int k = 0; k < 400; ++k) {
        pair.move({0.03e-6, 0.01e-6, pull * 0.02e-6});
        CHECK(pair.work == Approx(pair.strain() + pair.lost).epsilon(1e-9));
      }
      CHECK(pair.breaks == 1);
      // Stored when it broke: N^2 / 2 kn + S^2 / 2 ks, of which under pressure friction keeps a part.
      CHECK(pair.broken > 0.5 * (pull > 0 ? 3.0 * 3.0 / 4e5 : 2.0 * 2.0 / 4e5));
    }
}

TEST_CASE("contact_bond reports the stiffness of the bonded contact") {
  BondedPair pair = bonded({{"cb_tenf", 1}, {"cb_shearf", 1}});
  double kn = 0, ks = 0;
  const scree_stiffness out{sizeof(scree_stiffness), 1, &kn, &ks, nullptr, nullptr, nullptr, nullptr};
  pair.move({});
  pair.columns.stiffness(out);
  CHECK(kn == 1e6);
  CHECK(ks == 4e5);  // without friction too
  pair.move({0, 0, 1e-5});
  REQUIRE(pair.breaks == 1);
  pair.columns.stiffness(out);
  CHECK(ks == 0);
}
