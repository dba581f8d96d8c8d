// The linear law against its equations: contact_models/linear/linear.md.
#include <cmath>
#include <limits>
#include <string>

#include "laws/columns.hpp"
#include "support/catch.hpp"

namespace {
using namespace scree::test;
using scree::Vec3;

const scree_contact_model& linear() {
  return built_plugins().open(scree::core::Kind::contact_model, "linear").contact_model();
}
const Settings base = {{"kn", 1e6}, {"ks", 4e5}, {"fric", 0.4}};
Settings with(Settings settings, const Settings& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}
Columns one(const Settings& settings) { return Columns(linear(), rule_of(linear(), settings), 1); }
OneContact random_contact(Numbers& random) {
  OneContact c;
  c.normal = random.vector(1).normalized();
  c.gap = random.between(-1e-4, -1e-6);
  c.velocity = random.vector(1);
  c.turn = random.vector(1e-3);
  c.mass = random.between(1e-3, 1e-1);
  return c;
}
/// Rotation by t = 2 tan(angle/2) axis.
Vec3 rotated(const Vec3& t, const Vec3& a) {
  const double s = t.norm(), angle = 2 * std::atan(0.5 * s);
  if (s == 0) return a;
  const Vec3 k = t / s;  // Rodrigues
  return std::cos(angle) * a + std::sin(angle) * k.cross(a) + (1 - std::cos(angle)) * k.dot(a) * k;
}

}  // namespace

TEST_CASE("linear declares its inputs, units and mixing") {
  const scree_contact_model& m = linear();
  REQUIRE(m.form_count == 2);
  CHECK(std::string(m.forms[0]) == "kn ks");
  CHECK(std::string(m.forms[1]) == "emod kratio");
  CHECK(m.derived_from_pair == 2u);  // only the second form reads radii
  CHECK(m.state_words == 3);
  CHECK(m.bond_words == 0);
  for (uint32_t k = 0; k < m.property_count; ++k) {
    const scree_property& p = m.properties[k];
    const std::string name = p.name;
    CHECK(p.forms == (name == "kn" || name == "ks" ? 1u : name == "emod" || name == "kratio" ? 2u : 0u));
    if (name == "kn") CHECK((p.mix == SCREE_MIX_SERIES && std::string(p.unit) == "N/m" && p.low == 0));
    if (name == "fric") CHECK((p.mix == SCREE_MIX_LEAST && p.fallback == 0));
  }
}

TEST_CASE("linear: emod and kratio give PFC's deformability") {
  // kn = E pi r^2 / L: 1e9 Pa, balls of 10 mm: pi 1e5 / 2 ... = 1.570796e7 N/m; ks = kn / 2.5.
  std::vector<double> rule = rule_of(linear(), {{"emod", 1e9}, {"kratio", 2.5}});
  const auto derived = [&](double r1, double r2) {
    const scree_pair pair{sizeof(scree_pair), 0, r1, r2, 1.0};
    linear().derive(rule.data(), 1, &pair);
    return std::pair{rule[word_of(linear(), "kn")], rule[word_of(linear(), "ks")]};
  };
  const double pi = std::acos(-1.0);
  CHECK(derived(0.01, 0.01).first == Approx(1e9 * pi * 1e-4 / 0.02).epsilon(1e-14));
  CHECK(derived(0.01, 0.01).second == Approx(6.283185307e6).epsilon(1e-9));
  CHECK(derived(0.01, 0.02).first == Approx(1.047197551e7).epsilon(1e-9));
  CHECK(derived(0.01, 0.0).first == Approx(1e9 * pi * 1e-4 / 0.01).epsilon(1e-14));
  std::vector<double> given = rule_of(linear(), base);
  const std::vector<double> before = given;
  const scree_pair pair{sizeof(scree_pair), 0, 0.01, 0.01, 1.0};
  linear().derive(given.data(), 0, &pair);
  CHECK(given == before);
}

TEST_CASE("linear: seen from the other piece, force and memory are opposite to the bit") {
  Numbers random(3);
  for (const double lin_mode : {0.0, 1.0}) {
    const Settings settings = with(base, {{"dp_nratio", 0.1}, {"dp_sratio", 0.1}, {"lin_mode", lin_mode}});
    Columns there = one(settings), back = one(settings);
    for (int cycle = 0; cycle < 200; ++cycle) {
      OneContact c = random_contact(random);
      there.put(0, c);
      c.normal = -c.normal;
      c.velocity = -c.velocity;
      back.put(0, c);
      there.run();
      back.run();
      CHECK((there.force(0) + back.force(0)).norm() == 0.0);
      for (std::size_t w = 0; w < 3; ++w) CHECK(there.state(w)[0] == -back.state(w)[0]);
    }
  }
}

TEST_CASE("linear: a turned frame gives the turned force") {
  Numbers random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 turn = random.vector(5);
    Columns plain = one(with(base, {{"dp_nratio", 0.1}, {"lin_mode", trial % 2 ? 1.0 : 0.0}}));
    Columns turned = one(with(base, {{"dp_nratio", 0.1}, {"lin_mode", trial % 2 ? 1.0 : 0.0}}));
    for (int cycle = 0; cycle < 5; ++cycle) {
      OneContact c = random_contact(random);
      plain.put(0, c);
      for (Vec3* v : {&c.normal, &c.velocity, &c.turn}) *v = rotated(turn, *v);
      turned.put(0, c);
      plain.run();
      turned.run();
      const Vec3 expected = rotated(turn, plain.force(0));
      CHECK((turned.force(0) - expected).norm() <= 1e-12 * (1 + expected.norm()));
    }
  }
}

TEST_CASE("linear: reported stiffness is the slope of the force") {
  Columns columns = one(base);
  double kn = 0, ks = 0, beta_n = 0;
  columns.put(0, OneContact{});
  columns.stiffness({sizeof(scree_stiffness), 1, &kn, &ks, nullptr, nullptr, &beta_n, nullptr});
  CHECK(kn == 1e6);
  CHECK(ks == 4e5);
  const auto force = [&](double gap, const Vec3& slip) {
    Columns fresh = one(base);
    OneContact c;
    c.gap = gap;
    c.velocity = slip / fresh.dt;
    fresh.put(0, c);
    fresh.run();
    return fresh.force(0);
  };
  const double h = 1e-9;
  CHECK((force(-1e-5 - h, {}).z - force(-1e-5 + h, {}).z) / (2 * h) == Approx(kn).epsilon(1e-9));
  CHECK((force(-1e-5, {h, 0, 0}).x - force(-1e-5, {-h, 0, 0}).x) / (2 * h) == Approx(-ks).epsilon(1e-9));
  // Without friction the shear spring carries nothing, and no step has to be paid for it.
  Columns smooth = one({{"kn", 1e6}, {"ks", 4e5}});
  smooth.stiffness({sizeof(scree_stiffness), 1, &kn, &ks, nullptr, nullptr, nullptr, nullptr});
  CHECK(ks == 0);
}

TEST_CASE("linear: shear stays inside the friction cone of the spring force") {
  Numbers random(5);
  Columns columns = one(with(base, {{"dp_nratio", 0.5}}));
  int slid = 0, stuck = 0;
  for (int cycle = 0; cycle < 2000; ++cycle) {
    OneContact c = random_contact(random);
    if (cycle % 3 == 0) c.velocity *= 1e-3;
    columns.put(0, c);
    columns.run();
    const double limit = 0.4 * 1e6 * -c.gap;
    const Vec3 shear{columns.state(0)[0], columns.state(1)[0], columns.state(2)[0]};
    CHECK(shear.norm() <= limit * (1 + 1e-15));
    CHECK(std::abs(shear.dot(c.normal)) <= 1e-12 * limit);
    if (columns.sliding(0)) CHECK(shear.norm() == Approx(limit).epsilon(1e-14));
    (columns.sliding(0) ? slid : stuck) += 1;
  }
  CHECK(slid > 100);
  CHECK(stuck > 100);
}

TEST_CASE("linear: increments of the normal force add up to the force of the overlap") {
  Columns absolute = one(base), incremental = one(with(base, {{"lin_mode", 1}}));
  double gap = 3.3e-6;  // the pair first comes into touch within a cycle
  for (int cycle = 0; cycle < 1000; ++cycle) {
    OneContact c;
    c.velocity = {0, 0, cycle < 700 ? -0.1 : 0.05};
    gap += absolute.dt * c.velocity.z;
    c.gap = gap;
    absolute.put(0, c);
    incremental.put(0, c);
    absolute.run();
    incremental.run();
    CHECK(incremental.force(0).z == Approx(absolute.force(0).z).epsilon(1e-11).margin(1e-11));
  }
  CHECK(absolute.force(0).z > 100);
  // Stiffness doubled in touch: the absolute force jumps, the other goes on from where it was.
  const double before = incremental.force(0).z;
  for (Columns* columns : {&absolute, &incremental}) {
    columns->set_rule(word_of(linear(), "kn"), 2e6);
    OneContact c;
    c.gap = gap;
    columns->put(0, c);
    columns->run();
  }
  CHECK(incremental.force(0).z == Approx(before).epsilon(1e-13));
  CHECK(absolute.force(0).z == Approx(2 * before).epsilon(1e-11));
}

TEST_CASE("linear: a contact born overlapping starts without force in the incremental mode") {
  Columns columns = one(with(base, {{"lin_mode", 1}}));
  columns.dt = 0;
  OneContact c;
  c.gap = -1e-4;
  columns.put(0, c);
  columns.run();
  CHECK(columns.force(0).norm() == 0);
}

TEST_CASE("linear: a pair that rotates as a whole keeps its normal and shear force") {
  for (const double lin_mode : {0.0, 1.0}) {
    Columns columns = one(with(base, {{"lin_mode", lin_mode}}));
    OneContact c;
    c.gap = -1e-5;
    c.velocity = Vec3{1e-6, 2e-6, -1e-5} / columns.dt;  // loads all springs in one cycle
    columns.put(0, c);
    columns.run();
    const Vec3 first = columns.force(0);
    const double normal = first.dot(c.normal);
    REQUIRE(normal == Approx(10).epsilon(1e-12));
    REQUIRE(!columns.sliding(0));
    const double shear = (first - normal * c.normal).norm();
    Numbers random(6);
    for (int cycle = 0; cycle < 1000; ++cycle) {
      const Vec3 before = c.normal;
      const Vec3 axis = before.cross(random.vector(1)).normalized();  // a tilt, then a spin about the new normal
      const Vec3 tilt = random.between(0, 0.1) * axis;
      c.normal = rotated(tilt, before).normalized();
      c.turn = tilt + random.between(-0.1, 0.1) * c.normal;
      c.velocity = {};
      columns.put(0, c);
      columns.run();
    }
    const Vec3 last = columns.force(0);
    CHECK(last.dot(c.normal) == Approx(normal).epsilon(1e-11));
    CHECK((last - last.dot(c.normal) * c.normal).norm() == Approx(shear).epsilon(1e-11));
  }
}

TEST_CASE("linear: dashpots and their four modes") {
  const double mass = 0.01, cn = 2 * 0.3 * std::sqrt(mass * 1e6), cs = 2 * 0.2 * std::sqrt(mass * 4e5);
  for (const double mode : {0.0, 1.0, 2.0, 3.0}) {
    const Settings settings = with(base, {{"dp_nratio", 0.3}, {"dp_sratio", 0.2}, {"dp_mode", mode}});
    const auto force = [&](const Vec3& velocity, double dt) {
      Columns columns = one(settings);
      columns.dt = dt;
      OneContact c;
      c.gap = -1e-5;
      c.velocity = velocity;
      columns.put(0, c);
      columns.run();
      return std::pair{columns.force(0), columns.sliding(0)};
    };
    // Separating fast: the dashpot outpulls the spring of 10 N.
    const double pulled = 10 - cn * 1.0;
    REQUIRE(pulled < 0);
    CHECK(force({0, 0, 1}, 0).first.z == Approx(mode == 1 || mode == 3 ? 0.0 : pulled).margin(1e-12));
    CHECK(force({0, 0, -1}, 0).first.z == Approx(10 + cn).epsilon(1e-14));
    // Sticking: spring and dashpot in shear.
    const auto [stuck, slid1] = force({0.1, 0, 0}, 1e-5);
    CHECK(!slid1);
    CHECK(stuck.x == Approx(-4e5 * 1e-6 - cs * 0.1).epsilon(1e-13));
    // Sliding: the spring holds 0.4 of 10 N; the dashpot acts in modes 0 and 1.
    const auto [moved, slid2] = force({10, 0, 0}, 1e-5);
    CHECK(slid2);
    CHECK(moved.x == Approx(-4 - (mode >= 2 ? 0.0 : cs * 10)).epsilon(1e-13));
  }
}

TEST_CASE("linear: restitution of a head-on impact") {
  // Closed forms: mode 0 exp(-pi b / sqrt(1 - b^2)); mode 1 Schwager and Poeschel (2007), values to six digits.
  struct Case {
    double beta, mode0, mode1;
  };
  for (const Case& c : {Case{0.02, 0.939090, 0.939841}, Case{0.1, 0.729248, 0.744079}, Case{0.5, 0.163034, 0.298436}})
    for (const double mode : {0.0, 1.0}) {
      Columns columns = one({{"kn", 1e6}, {"ks", 0}, {"dp_nratio", c.beta}, {"dp_mode", mode}});
      const double mass = 0.01, period = 2 * std::acos(-1.0) * std::sqrt(mass / 1e6);
      columns.dt = period / 20000;
      OneContact contact;
      contact.velocity = {0, 0, -1};
      contact.gap = -1e-12;
      do {
        columns.put(0, contact);
        columns.run();
        contact.velocity.z += columns.force(0).z / mass * columns.dt;
        contact.gap += contact.velocity.z * columns.dt;
      } while (contact.gap < 0);
      CHECK(contact.velocity.z == Approx(mode == 0 ? c.mode0 : c.mode1).epsilon(1e-3));
    }
}

TEST_CASE("linear: work done on a contact is stored, slid away or damped") {
  Columns columns = one(with(base, {{"dp_nratio", 0.1}, {"dp_sratio", 0.1}}));
  columns.energy = true;
  columns.dt = 1e-7;
  double work = 0, friction = 0, dashpot = 0, strain_before = 0, gap = 0;
  Vec3 force_before;
  const int cycles = 20000;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    const double phase = 6.0 * cycle / cycles;
    OneContact c;
    c.velocity = {0.02 * std::cos(3 * phase), 0.01 * std::sin(phase), -0.01 * std::cos(phase)};
    gap += c.velocity.z * columns.dt;
    c.gap = gap;
    columns.put(0, c);
    columns.run();
    work -= 0.5 * (columns.force(0) + force_before).dot(c.velocity) * columns.dt;
    force_before = columns.force(0);
    CHECK(columns.energies(1, 0) >= 0);
    CHECK(columns.energies(2, 0) >= 0);
    friction += columns.energies(1, 0);
    dashpot += columns.energies(2, 0);
    strain_before = columns.energies(0, 0);
  }
  const double largest = std::max({work, friction, dashpot});
  CHECK(friction > 0.05 * largest);
  CHECK(dashpot > 0.05 * largest);
  CHECK(work - friction - dashpot - strain_before == Approx(0).margin(2e-3 * largest));
}

TEST_CASE("linear: the reference gap moves the point of touch") {
  const auto force = [](double rgap, double gap) {
    Columns columns = one(with(base, {{"rgap", rgap}, {"dp_nratio", 0.5}}));
    OneContact c;
    c.gap = gap;
    columns.put(0, c);
    columns.run();
    return columns.force(0).z;
  };
  CHECK(force(1e-5, 0.4e-5) == Approx(6).epsilon(1e-13));
  CHECK(force(1e-5, 1.1e-5) == 0);
  CHECK(force(-1e-5, -0.9e-5) == 0);
  CHECK(force(-1e-5, -1.5e-5) == Approx(5).epsilon(1e-13));
  const std::vector<double> rule = rule_of(linear(), with(base, {{"rgap", 1e-5}}));
  const scree_pair pair{sizeof(scree_pair), 0, 0.01, 0.01, 1.0};
  CHECK(linear().reach(rule.data(), &pair) == 1e-5);
}

TEST_CASE("linear: what is not a number is passed on") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double lin_mode : {0.0, 1.0}) {
    Columns columns = one(with(base, {{"lin_mode", lin_mode}}));
    OneContact c;
    c.gap = nan;
    columns.put(0, c);
    columns.run();
    CHECK(std::isnan(columns.force(0).z));
    Columns moved = one(with(base, {{"lin_mode", lin_mode}}));
    c.gap = -1e-5;
    c.velocity = {nan, 0, 0};
    moved.put(0, c);
    moved.run();
    CHECK(std::isnan(moved.force(0).x));
  }
}
