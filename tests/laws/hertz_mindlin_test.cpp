// The law hertz_mindlin against its equations: contact_models/hertz_mindlin/hertz_mindlin.md.
#include <algorithm>
#include <limits>

#include "laws/hertz_contact.hpp"

namespace {
using namespace scree::test;
using scree::Vec3;

const Settings glass = {{"shear", 30e9}, {"poiss", 0.25}, {"fric", 0.5}};
Settings with(Settings settings, const Settings& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}
std::string refusal_of(const Settings& settings, uint32_t form = 0) {
  std::vector<double> words = rule_of(hertz(), settings);
  char why[512] = "";
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  return hertz().prepare(words.data(), form, &refusal) == 0 ? "" : why;
}
double restitution_of(const Settings& settings, double speed) {
  HertzContact c(settings, 0.01, 0.01);
  const double mass = c.contact.mass, h = 4.0 / 3.0 * 30e9 / 0.75 * std::sqrt(0.005);
  const double deepest = std::pow(1.25 * mass * speed * speed / h, 0.4), dt = deepest / speed / 4000;
  double v = -speed, depth = 0;
  do {
    depth -= v * dt;
    if (depth <= 0) break;
    c.move(depth, {}, dt);
    v += c.force().z / mass * dt;
  } while (true);
  return v / speed;
}

}  // namespace

TEST_CASE("hertz_mindlin: overlap and stiffnesses of a static contact") {
  // F = 1 N: d = (F/h)^(2/3); Hertz (1882), Mindlin (1949).
  HertzContact balls(glass, 1e-3, 1e-3);
  balls.move(8.892233e-7, {}, 0);
  CHECK(balls.force().z == Approx(1).epsilon(1e-6));
  CHECK(balls.kn() == Approx(1.686865e6).epsilon(1e-6));
  CHECK(balls.ks() == Approx(1.445885e6).epsilon(1e-6));
  // A rigid wall leaves the compliance of one side: twice the modulus of two equal ones.
  HertzContact wall({{"shear", 60e9}, {"poiss", 0.25}}, 1e-3, 0);
  wall.move(4.446117e-7, {}, 0);
  CHECK(wall.force().z == Approx(1).epsilon(1e-6));
}

TEST_CASE("hertz_mindlin: Mindlin's ratio of the stiffnesses, up to incompressible pieces") {
  for (const double nu : {-0.9, 0.0, 0.25, 0.3, 0.5}) {
    HertzContact c({{"shear", 1e9}, {"poiss", nu}, {"fric", 0.5}}, 0.01, 0.02);
    c.move(1e-5, {}, 0);
    CHECK(c.ks() / c.kn() == Approx(2 * (1 - nu) / (2 - nu)).epsilon(1e-14));
    // 8 G* sqrt(R d) with 1/G* = 2 (2 - nu)/G.
    CHECK(c.ks() == Approx(8 * 1e9 / (2 * (2 - nu)) * std::sqrt(0.01 * 0.02 / 0.03 * 1e-5)).epsilon(1e-13));
  }
}

TEST_CASE("hertz_mindlin: work of a shear cycle at two overlaps, by mode") {
  // Load to d1, shear by s, unload to d2, shear back: mode 0 makes (k1 - k2) s^2/2, mode 1 loses it, mode 2 too; the
  // other way round mode 2 makes it.
  for (const double mode : {0.0, 1.0, 2.0})
    for (const bool deep_first : {true, false}) {
      HertzContact c(with(glass, {{"fric", 1e3}, {"hz_mode", mode}}), 0.01, 0.01);
      const double deep = 1e-6, shallow = 0.25e-6, s = 1e-9;
      const double first = deep_first ? deep : shallow, second = deep_first ? shallow : deep;
      c.move(first, {}, 0);
      const double k1 = c.ks();
      c.move(first, {s, 0, 0}, 1e-3);
      const double across = c.work;
      c.move(second, {}, 1e-3);
      const double k2 = c.ks(), between = c.work;
      c.move(second, {-s, 0, 0}, 1e-3);
      const double cycle = across + c.work - between, most = std::abs(k1 - k2) * s * s / 2;
      const double lost = mode == 0 ? (deep_first ? -most : most) : mode == 1 ? most : deep_first ? most : -most;
      CHECK(cycle == Approx(lost).epsilon(1e-6));
      CHECK(!c.sliding());
      // In mode 1 the account closes: nothing but the loss and the strain that is left.
      if (mode == 1) CHECK(c.friction + c.shear_spring().squaredNorm() / (2 * k2) == Approx(cycle).epsilon(1e-9));
    }
}

TEST_CASE("hertz_mindlin: restitution is the one asked for, at any speed and in both dashpot modes") {
  for (const double e : {0.2, 0.5, 0.8, 0.9, 1.0})
    for (const double mode : {0.0, 1.0, 2.0, 3.0}) {
      const double found = restitution_of(with(glass, {{"restitution", e}, {"dp_mode", mode}}), 1);
      CHECK(found == Approx(e).margin(1e-3));
    }
  for (const double speed : {1e-3, 10.0})
    CHECK(restitution_of(with(glass, {{"restitution", 0.5}}), speed) == Approx(0.5).margin(1e-3));
  // Antypov and Elliott (2011) in terms of the tangent, and what clipping that dashpot would give instead.
  const auto share = [](const Settings& settings) {
    return HertzContact::rule(with(glass, settings), 1e-3, 1e-3, 1)[word_of(hertz(), "dp_nratio")];
  };
  CHECK(share({{"restitution", 0.5}}) == Approx(0.196681).margin(1e-6));
  CHECK(share({{"restitution", 0.1}}) == Approx(0.539648).margin(1e-6));
  CHECK(share({{"restitution", 0.5}, {"dp_mode", 1}}) == Approx(std::sqrt(5.0 / 6.0) * 0.255276).margin(1e-6));
  CHECK(share({{"restitution", 0.1}, {"dp_mode", 3}}) == Approx(std::sqrt(5.0 / 6.0) * 1.243188).margin(1e-6));
  CHECK(restitution_of(with(glass, {{"dp_nratio", 0.196681}, {"dp_mode", 1}}), 1) == Approx(0.5503).margin(1e-3));
}

TEST_CASE("hertz_mindlin: restitution without and with the whole range of damping") {
  CHECK(refusal_of(with(glass, {{"restitution", 0}}), 1).empty());
  for (const double mode : {1.0, 3.0})
    CHECK(refusal_of(with(glass, {{"restitution", 0}, {"dp_mode", mode}}), 1).find("never pulls") != std::string::npos);
  CHECK(refusal_of({{"shear", std::numeric_limits<double>::infinity()}, {"poiss", 0.2}}).find("infinite") !=
        std::string::npos);
}

TEST_CASE("hertz_mindlin: hardly any overlap gives no force and no trouble") {
  for (const double mode : {0.0, 1.0, 2.0})
    for (const double depth : {0.0, 5e-324, 1e-300, 1e-200, 1e-30}) {
      HertzContact c(with(glass, {{"dp_nratio", 0.5}, {"dp_sratio", 0.5}, {"hz_mode", mode}}), 0.01, 0.01);
      for (const double d : {depth, 1e-6, depth, 0.0, depth}) {
        c.move(d, {1e-9, 0, 0}, 1e-3);
        CHECK(std::isfinite(c.force().norm()));
        CHECK(std::isfinite(c.strain()));
        if (d < 1e-100) CHECK(c.force().norm() < 1e-20);
      }
    }
}

TEST_CASE("hertz_mindlin: work on a contact is stored, slid away or damped") {
  HertzContact c(with(glass, {{"fric", 0.3}, {"dp_nratio", 0.1}, {"dp_sratio", 0.1}}), 0.01, 0.01);
  const int cycles = 20000;
  const double dt = 1e-8;
  for (int cycle = 1; cycle <= cycles; ++cycle) {
    const double phase = 6.0 * cycle / cycles, depth = 1e-6 * (1 - std::cos(2 * phase));
    c.move(depth, (1e-6 / cycles) * Vec3{3 * std::cos(3 * phase), std::sin(phase), 0}, dt);
  }
  const double largest = std::max({c.work, c.friction, c.dashpot});
  CHECK(c.friction > 0.02 * largest);
  CHECK(c.dashpot > 0.02 * largest);
  CHECK(c.work - c.friction - c.dashpot - c.strain() == Approx(0).margin(2e-3 * largest));
}

TEST_CASE("hertz_mindlin: without friction and shear dashpot nothing tangential is kept") {
  CHECK((hertz().needs(rule_of(hertz(), {{"shear", 1e9}, {"poiss", 0.3}}).data()) & SCREE_NORMAL_ONLY) != 0);
  CHECK((hertz().needs(rule_of(hertz(), glass).data()) & SCREE_NORMAL_ONLY) == 0);
}

TEST_CASE("hertz_mindlin: two materials are as compliant together as theory says") {
  const auto words = [](double shear, double poiss) { return rule_of(hertz(), {{"shear", shear}, {"poiss", poiss}}); };
  const double g1 = 30e9, nu1 = 0.25, g2 = 10e9, nu2 = 0.4, rigid = std::numeric_limits<double>::infinity();
  const auto pair_of = [&](double g, double nu) {
    std::vector<double> pair = words(0.5 * (g1 + g), 0.5 * (nu1 + nu));
    REQUIRE(hertz().mixed(pair.data(), words(g1, nu1).data(), words(g, nu).data(), 0, nullptr) == 0);
    return std::pair{pair[word_of(hertz(), "shear")], pair[word_of(hertz(), "poiss")]};
  };
  const auto [g, nu] = pair_of(g2, nu2);
  CHECK(2 * (1 - nu) / (2 * g) == Approx((1 - nu1) / (2 * g1) + (1 - nu2) / (2 * g2)).epsilon(1e-13));  // 1/E*
  CHECK(2 * (2 - nu) / g == Approx((2 - nu1) / g1 + (2 - nu2) / g2).epsilon(1e-13));                    // 1/G*
  CHECK(pair_of(g1, nu1) == std::pair{g1, nu1});
  CHECK(pair_of(rigid, 0.1).first == Approx(2 * g1).epsilon(1e-14));
  CHECK(pair_of(rigid, 0.1).second == Approx(nu1).epsilon(1e-13));
}
