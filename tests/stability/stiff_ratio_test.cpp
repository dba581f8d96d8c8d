// Cases 1 to 4, D1 to D3, D7: very unequal stiffnesses and masses side by side.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/philox.hpp"
#include "core/run/sanity.hpp"
#include "stability/bonded_scene.hpp"
#include "stability/lab.hpp"

using namespace bonded;
using namespace support;
using scree::core::Column;

namespace {

/// Sixteen balls of 10 mm in a periodic row, a a b b a a b b ..., bonded: a-a is `ratio` times as stiff as a-b.
struct Row {
  std::string balls = "x,y,z,radius,group,vx,vy,vz\n";
  std::string head =
      "scree: 1\ncell: {low: [0, -1, -1], high: [0.32, 1, 1], periodic: [x]}\n"
      "balls:\n  row: {generator: file, path: balls.csv, density: 2500}\n"
      "processes:\n  energy: {process: energy_ledger}\ncontacts:\n";
  std::string tail = "stages:\n  - glue: [bond: {rule: stiff, gap: 1e-6}, bond: {rule: soft, gap: 1e-6}]\n";
  Row() {
    const scree::core::Random random(1, "row");
    for (uint64_t k = 0; k < 16; ++k)
      balls += digits(0.01 + 0.02 * static_cast<double>(k)) + ",0,0,0.01," + (k / 2 % 2 == 0 ? "a" : "b") + "," +
               digits(1e-4 * (random.uniform(k, 0) - 0.5)) + ",0,0\n";
  }
  std::string rules(const std::string& model, const std::string& stiff, const std::string& soft) const {
    return "  - {name: stiff, between: [row.a, row.a], model: " + model + ", " + stiff +
           "}\n  - {name: soft, between: [row, row], model: " + model + ", " + soft + "}\n";
  }
};

struct Held {
  double share = 0, residual = 0;
};

/// Runs 1e5 cycles under the automatic step: its share of the critical step, and what the energy account leaves.
Held hold(SceneRun& run, double critical) {
  run.engine().sums_wanted = run.engine().report_wanted = false;
  run.step(100000);
  const double share = run.engine().clock.dt / critical;
  return {share, run.value("energy.residual_share")};
}

}  // namespace

TEST_CASE("1 3 OK: bonded neighbours whose stiffness differs 1e12 times stay bounded and keep their energy") {
  const Row row;
  const std::string unbroken = ", fric: 0, " + endless,
                    plain = "kn: 0, ks: 0, fric: 0, pb_ks: 0, pb_ten: .inf, pb_coh: .inf, pb_kn: ";
  std::string said;
  for (const auto& rules : {row.rules("contact_bond", "kn: " + digits(kn) + ", ks: 0" + unbroken,
                                      "kn: " + digits(kn * 1e-12) + ", ks: 0" + unbroken),
                            row.rules("parallel_bond", plain + digits(kn / area), plain + digits(kn * 1e-12 / area))}) {
    SceneRun run(row.head + rules + row.tail, row.balls);
    edit(run);
    CHECK(run.engine().contacts.bonded() == 16);
    const Held held = hold(run, 2 * std::sqrt(mass / (2 * kn)));
    INFO(rules << " share " << held.share);
    CHECK(held.share >= 0.6);
    CHECK(held.share <= 0.95);
    CHECK(held.residual < 1e-3);
    said += "step " + lab::number(held.share) + " of the critical one, residual " + lab::number(held.residual) + "; ";
  }
  lab::measured("1, 3", said);
}

TEST_CASE("2 4 OK: a floor 1e12 times as stiff as the balls on it, linear and Hertz") {
  // Two balls in a column at rest under their weight, the upper one with a push.
  const double weight = mass * 9.81;
  struct Law {
    std::string floor, balls;
    double lower, upper, tangent;  ///< overlaps at rest, stiffness of the floor's contact
  };
  // F = h d^1.5 with h = 4/3 G/(1 - nu) sqrt(R*); R* is R at the floor and R/2 between balls; nu = 0.
  const double hard = 1e15, soft = 1e3, d1 = std::pow(2 * weight / hard, 2.0 / 3),
               d2 = std::pow(weight / soft, 2.0 / 3);
  const auto shear = [](double h, double radius) { return digits(h * 3 / 4 / std::sqrt(radius)); };
  std::string said;
  for (const Law& law :
       {Law{"linear, kn: 1e14, ks: 0", "linear, kn: 100, ks: 0", 2 * weight / 1e14, weight / 100, 1e14},
        Law{"hertz_mindlin, poiss: 0, fric: 0, dp_nratio: 0, shear: " + shear(hard, 0.01),
            "hertz_mindlin, poiss: 0, fric: 0, dp_nratio: 0, shear: " + shear(soft, 0.005), d1, d2,
            1.5 * hard * std::sqrt(d1)}}) {
    INFO(law.floor);
    SceneRun run(
        "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nballs:\n  two: {generator: "
        "file, path: balls.csv, density: 2500}\nprocesses:\n  pull: {process: gravity, acceleration: [0, 0, "
        "-9.81]}\n  energy: {process: energy_ledger}\ncontacts:\n  - {name: ground, between: [two, floor], model: " +
            law.floor + "}\n  - {name: soft, between: [two, two], model: " + law.balls + "}\n",
        "x,y,z,radius,vx,vy,vz\n0,0," + digits(0.01 - law.lower) + ",0.01,0,0,0\n0,0," +
            digits(0.03 - law.lower - law.upper) + ",0.01,0,0,-1e-3\n");
    const Held held = hold(run, 2 * std::sqrt(mass / law.tangent));
    // A Hertz contact of 3e-11 m is taken at the stiffness that it would have 1e-7 m deeper, which 200 cycles of the
    // push may close.
    CHECK(held.share >= (law.tangent == 1e14 ? 0.6 : 0.05));
    CHECK(held.share <= 0.95);
    CHECK(held.residual < 1e-3);
    CHECK(run.ball(1).position[2] == Approx(0.01 - law.lower).margin(law.lower));
    said += "step " + lab::number(held.share) + " of the critical one, residual " + lab::number(held.residual) + "; ";
  }
  lab::measured("2, 4", said);
}

TEST_CASE("D1 OK: stiffnesses of 1e9 and 1e3 in series give 999.999000001 N/m") {
  SceneRun run(R"(scree: 1
balls:
  stiff: {generator: lattice, kind: sc, radius: 5 mm, box: [[0, 0, 0], [0.01, 0.01, 0.01]], density: 2500, contact: {kn: 1e9, ks: 1e9}}
  soft: {generator: lattice, kind: sc, radius: 5 mm, box: [[0.0099, 0, 0], [0.0199, 0.01, 0.01]], density: 2500, contact: {kn: 1e3, ks: 1e3}}
contacts:
  - {name: both, between: [stiff, soft], model: linear}
  - {between: [balls, balls], model: none}
)");
  const double overlap = 0.01 - (run.ball(2).position[0] - run.ball(1).position[0]);
  const double k = run.value("contacts.1.2.normal_force") / overlap;
  CHECK(k == Approx(999.999000001).epsilon(1e-12));
  // Without friction the pair allows 2 sqrt(m/2k); stiff balls never meet each other.
  const double m = 2500 * 4.0 / 3 * std::numbers::pi * 1.25e-7, soft = 2 * std::sqrt(m / 2 / k);
  const double step = run.engine().step.bound().step;
  CHECK(step <= soft * (1 + 1e-9));
  CHECK(step >= 0.999 * soft);
  lab::measured(
      "D1", digits(k) + " N/m; limit " + lab::number(step) + " s, the pair alone allows " + lab::number(soft) + " s");
}

TEST_CASE("D2 OK: a bond of 1e9 N/m beside a contact of 1e3 N/m on the same pair sets the step") {
  SceneRun run(chain("model: parallel_bond, kn: 1e3, ks: 0, fric: 0, pb_ks: 0, pb_ten: .inf, pb_coh: .inf, pb_kn: " +
                     digits(1e9 / area)) +
                   "processes:\n  energy: {process: energy_ledger}\n",
               "x,y,z,radius,vx,vy,vz\n0,0,0,0.01,0.1,0,0\n0.02,0,0,0.01,-0.1,0,0\n");
  edit(run);
  const double limit = 2 * std::sqrt(mass / 2 / (1e9 + 1e3));
  run.step(10);
  const double f = run.engine().clock.dt / limit;
  CHECK(f <= 0.95);
  CHECK(f > 0.9);
  run.step(100000);
  const double residual = run.value("energy.residual_share");
  CHECK(residual < 1e-3);
  // It swings about its length by v sqrt(m*/k)/sqrt(1 - f^2), as leapfrog at f of the limit does.
  CHECK(std::abs(run.ball(2).position[0] - run.ball(1).position[0] - 0.02) <
        1.1 * 0.2 * std::sqrt(mass / 2 / 1e9 / (1 - f * f)));
  lab::measured("D2", "step " + lab::number(f) + " of the limit of the bond; residual " + lab::number(residual) +
                          " after 1e5 cycles");
}

TEST_CASE("D3 WARN: one pair a million times as stiff as a thousand soft balls") {
  std::string balls = "x,y,z,radius,group\n1,0,0,0.01,hard\n1.0199,0,0,0.01,hard\n";
  for (int k = 0; k < 1000; ++k)
    balls += digits(0.0199 * (k % 10)) + "," + digits(0.0199 * (k / 10 % 10)) + "," + digits(0.0199 * (k / 100)) +
             ",0.01,soft\n";
  const auto said = [&](const std::string& stiff) {
    SceneRun run(
        "scree: 1\nballs:\n  all: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n"
        "  - {name: rock, between: [all.hard, all.hard], model: linear, kn: " +
            stiff +
            ", ks: 0}\n"
            "  - {name: gel, between: [all, all], model: linear, kn: 1e3, ks: 0}\n",
        balls);
    return doubts(run.simulation());
  };
  CHECK(said("1e5").empty());
  const auto warned = said("1e9");
  REQUIRE(warned.size() == 1);
  CHECK_THAT(warned[0], Catch::Contains("rule 'gel' swings 1e+03 times as slowly") &&
                            Catch::Contains("on rule 'rock'") && Catch::Contains("ball 2, contact with ball 1"));
  lab::measured("D3", "\"" + warned[0] + "\"");
}

TEST_CASE("D7 WARN: a lid a million times as heavy as the balls below") {
  std::string balls = "x,y,z,radius,density\n0.0495,0.0495,0.1095,0.01,2.5e9\n";
  for (int k = 0; k < 125; ++k)
    balls += digits(0.01 + 0.0199 * (k % 5)) + "," + digits(0.01 + 0.0199 * (k / 5 % 5)) + "," +
             digits(0.01 + 0.0199 * (k / 25)) + ",0.01,2500\n";
  SceneRun run(
      "scree: 1\nwalls:\n  box: {wall: box, low: [0, 0, 0], high: [0.0996, 0.0996, 0.3]}\nballs:\n  all: {generator: "
      "file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: all, between: [balls, [balls, walls]], model: "
      "linear, kn: 1e8, ks: 0, dp_nratio: 0.2}\nprocesses:\n  pull: {process: gravity, acceleration: [0, 0, -9.81]}\n",
      balls);
  const auto said = doubts(run.simulation());
  REQUIRE(said.size() >= 1);
  CHECK_THAT(said[0], Catch::Contains("ball 1 on rule 'all' swings 1e+03 times as slowly"));
  run.step(5000);
  CHECK(run.ball(1).position[2] > 0.08);
  lab::measured("D7", "\"" + said[0] + "\"");
}
