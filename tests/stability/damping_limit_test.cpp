// Cases 12 to 14, 61, D16 to D19, D38: dashpots and local damping of any strength, and steps at the very limit.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/run/sanity.hpp"
#include "stability/lab.hpp"
#include "support/measure.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;
using scree::core::NumericalStop;
using scree::core::Refusal;

namespace {

constexpr double kn = 1e5;
const double mass = 2500 * 4.0 / 3 * std::numbers::pi * 1e-6, limit = 2 * std::sqrt(mass / kn);  // a ball on a wall

std::string on_floor(const std::string& law, const std::string& head, const std::string& processes = "") {
  return "scree: 1\n" + head +
         "walls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nballs:\n  ball: {generator: file, path: "
         "balls.csv, density: 2500}\ncontacts:\n  - {name: itself, between: [ball, ball], model: none}\n  - {name: "
         "ground, "
         "between: [ball, floor], model: linear, kn: 1e5, ks: 0" +
         law + "}\n" + (processes.empty() ? "" : "processes:\n" + processes);
}

const std::string pull = "  pull: {process: gravity, acceleration: [0, 0, -9.81]}\n";

/// Two balls joined by a spring that pulls and pushes, closing slowly. The critical step is 2 sqrt(m/(2 kn)).
std::unique_ptr<SceneRun> oscillator(double share, const std::string& head, double& critical) {
  critical = 2 * std::sqrt(mass / 2 / kn);
  auto run = std::make_unique<SceneRun>("scree: 1\ntimestep: " + digits(share * critical) + "\n" + head +
                                            "balls:\n  pair: {generator: file, path: balls.csv, density: "
                                            "2500}\ncontacts:\n  - {name: glue, between: [pair, "
                                            "pair], model: contact_bond, kn: 1e5, ks: 0, cb_tenf: .inf, cb_shearf: "
                                            ".inf}\nstages:\n  - glue: [bond: {rule: "
                                            "glue, gap: 1e-6}]\n",
                                        "x,y,z,radius,vx,vy,vz\n0,0,0,0.01,1e-3,0,0\n0.02,0,0,0.01,-1e-3,0,0\n");
  run->simulation().edit(run->simulation().scene.stages[0].actions[0]);
  run->engine().forces();
  return run;
}

double stretch(SceneRun& run) {
  const double* x = run.engine().balls[Column::x];
  return std::abs(x[1] - x[0] - 0.02);
}

double kinetic(SceneRun& run) {
  const auto& balls = run.engine().balls;
  double sum = 0;
  for (std::size_t row = 0; row < balls.size(); ++row) sum += balls[Column::vz][row] * balls[Column::vz][row];
  return sum;
}

}  // namespace

TEST_CASE(
    "12 13 OK: the step follows dashpots of 0 to 5 and local damping of 0 to 0.99, and a ball at rest stays there") {
  double worst = 0, least = 1, most = 0;
  for (const double xi : {0.0, 0.2, 1.0, 2.0, 5.0})
    for (const double alpha : {0.0, 0.3, 0.7, 0.9, 0.99}) {
      INFO("dashpot " << xi << ", local damping " << alpha);
      const std::string damping = alpha == 0 ? "" : "  slow: {process: local_damping, factor: " + digits(alpha) + "}\n";
      SceneRun run(on_floor(", dp_nratio: " + digits(xi), "", pull + damping),
                   "x,y,z,radius,vx,vy,vz\n0,0," + digits(0.01 - mass * 9.81 / kn) + ",0.01,0,0,1e-4\n");
      const double bound = run.engine().step.bound().step / limit;
      // Exact where only one of them acts; both at once allow less than the product.
      const double product = (std::sqrt(1 + xi * xi) - xi) / std::sqrt(1 + alpha);
      if (xi == 0 || alpha == 0) {
        if (run.engine().step.bound().term != "pair") worst = std::max(worst, std::abs(bound / product - 1));
        CHECK(bound <= product * 1.000001);
      } else {
        CHECK(bound <= product * 1.000001);
      }
      if (xi >= 1) CHECK(bound > 0.5 * product);
      least = std::min(least, bound / product);
      most = std::max(most, bound / product);
      run.step(10000);
      CHECK(std::abs(run.ball(1).velocity[2]) <= 1e-4 * (xi == 0 && alpha == 0 ? 1.5 : 1.0));
    }
  CHECK(worst < 0.05);
  lab::measured("12, 13", "limit over (sqrt(1 + xi^2) - xi)/sqrt(1 + alpha): " + lab::number(least) + " to " +
                              lab::number(most) + "; where one acts alone and sets the step, within " +
                              lab::number(worst) + "; 25 balls bounded for 1e4 cycles");
}

TEST_CASE(
    "14 D38 OK, WARN: overdamped contacts that never pull part as they should, and those that pull are warned of") {
  std::string said;
  for (const double beta : {1.0, 2.0, 10.0}) {
    INFO("dp_nratio " << beta);
    // e of a contact that ends when its force falls to zero: Schwager and Poeschel, Granular Matter 9 (2007) 465.
    const double s = std::sqrt(beta * beta - 1),
                 expected = beta == 1 ? std::exp(-2.0) : std::exp(-beta / s * std::log((beta + s) / (beta - s)));
    const std::string ball = "x,y,z,radius,vx,vy,vz\n0,0,0.010001,0.01,0,0,-1\n";
    SceneRun run(on_floor(", dp_mode: 1, dp_nratio: " + digits(beta), "timestep: " + digits(limit / 2e4) + "\n"), ball);
    CHECK(doubts(run.simulation()).empty());
    double before = kinetic(run);
    uint64_t cycles = 0;
    while (run.engine().balls[Column::z][0] < 0.010002 && cycles < 2000000) {
      run.step(100);
      cycles += 100;
      const double now = kinetic(run);
      if (run.engine().balls[Column::vz][0] < 0) CHECK(now <= before * (1 + 1e-12));
      before = now;
      run.engine().forces();
      CHECK(run.value("walls.floor.force.z") <= 0);
    }
    const double e = run.engine().balls[Column::vz][0];
    CHECK(e == Approx(expected).epsilon(0.02));
    said += "dp_nratio " + lab::number(beta) + ": " + lab::number(e) + " (" + lab::number(expected) + "); ";

    // A dashpot that may pull holds the ball back for good.
    SceneRun sticks(on_floor(", dp_mode: 0, dp_nratio: " + digits(beta), ""), ball);
    const auto warned = doubts(sticks.simulation());
    REQUIRE(warned.size() == 1);
    CHECK_THAT(warned[0],
               Catch::Contains("rule 'ground'") && Catch::Contains("may pull") && Catch::Contains("dp_mode 1"));
    sticks.step(5000);
    CHECK(sticks.engine().balls[Column::vz][0] < 0.01);
  }
  lab::measured("14, D38", "dp_mode 1, speed after over before (closed form): " + said + "dp_mode 0: warning");
}

TEST_CASE("D16 OK: a spring at 0.999 of its critical step stays bounded for 1e5 cycles") {
  double critical = 0;
  const auto run = oscillator(0.999, "", critical);
  run->engine().sums_wanted = run->engine().report_wanted = false;
  double first = 0, most = 0;
  for (int k = 0; k < 100000; ++k) {
    run->step();
    const double now = stretch(*run);
    if (k < 2000) first = std::max(first, now);
    most = std::max(most, now);
  }
  CHECK(most <= first * 1.001);
  lab::measured("D16", "largest stretch after 1e5 cycles over that of the first 2000: " + lab::number(most / first));
}

TEST_CASE("D17 REJECT, STOP: at 1.001 of the critical step a run is refused, or stopped when that is allowed") {
  double critical = 0;
  const auto said = doubts(oscillator(0.999, "", critical)->simulation());
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("is 0.999 of the stable limit") && Catch::Contains("timestep"));
  CHECK(doubts(oscillator(0.94, "", critical)->simulation()).empty());
  const auto run = oscillator(1.001, "unsafe: true\noverlap_limit: 1e9\n", critical);
  CHECK_THAT(doubts(run->simulation()).at(0), Catch::Contains("is 1.001 of the stable limit"));
  uint64_t cycle = 0;
  std::string why;
  try {
    for (; cycle < 5000; ++cycle) run->step();
  } catch (const NumericalStop& stop) {
    why = stop.what();
  }
  CHECK(cycle < 500);
  CHECK_THAT(why, Catch::Contains("lower 'timestep'") || Catch::Contains("smaller 'timestep'"));
  lab::measured("D17", "refused; with unsafe stopped at cycle " + std::to_string(cycle));
}

TEST_CASE("D18 WARN: a step of exactly the critical one runs with a warning") {
  double critical = 0;
  const auto run = oscillator(1 - 1e-9, "overlap_limit: 1e9\n", critical);
  const auto said = doubts(run->simulation());
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("is 1 of the stable limit"));
  // Linear growth at most: in n cycles n times what one cycle gives.
  const double one = 2e-3 * critical;
  run->step(50);
  CHECK(stretch(*run) < 51 * one);
  lab::measured("D18",
                "grows by " + lab::number(stretch(*run) / one / 50) + " of one cycle's way in each of 50 cycles");
}

TEST_CASE("D19 REJECT, OK: a step that forgets dashpots is refused, the automatic one counts them") {
  // Critical damping: 0.414 of the undamped limit is left.
  const std::string ball = "x,y,z,radius\n0,0," + digits(0.01 - 1e-6) + ",0.01\n", law = ", dp_nratio: 1, dp_mode: 1";
  std::string said;
  try {
    SceneRun(on_floor(law, "timestep: " + digits(0.8 * limit) + "\n", pull), ball);
  } catch (const Refusal& refusal) {
    said = refusal.what();
  }
  CHECK_THAT(said, Catch::Contains("above the stable limit") && Catch::Contains("damping"));
  SceneRun run(on_floor(law, "", pull), ball);
  CHECK(run.engine().clock.dt <= 0.95 * (std::sqrt(2.0) - 1) * limit);
  run.step(10000);
  CHECK(std::abs(run.ball(1).velocity[2]) < 1e-9);
  // What the refusal is for: without the bound that step is unstable.
  SceneRun wild(on_floor(", dp_nratio: 1, dp_mode: 0",
                         "unsafe: true\noverlap_limit: 1e9\ntimestep: " + digits(0.8 * limit) + "\n", pull),
                ball);
  wild.engine().sums_wanted = wild.engine().report_wanted = false;
  double most = 0;
  try {
    for (int k = 0; k < 60; ++k) {
      wild.step();
      most = std::max(most, std::abs(wild.engine().balls[Column::vz][0]));
    }
  } catch (const NumericalStop&) {
    most = 1e9;
  }
  CHECK(most > 0.01);
  lab::measured("D19", "0.8 of the undamped limit refused, the automatic step is " +
                           lab::number(run.engine().clock.dt / limit) + " of it");
}

TEST_CASE("61 REJECT: a local damping below 0 or of 1 and more is refused with its place") {
  const TemporaryFolder folder;
  write_text(folder / "balls.csv", "x,y,z,radius\n0,0,0.02,0.01\n");
  for (const std::string factor : {"-0.1", "1", "1.5", ".nan"}) {
    INFO(factor);
    write_text(folder / "damped.yaml", on_floor("", "", "  slow: {process: local_damping, factor: " + factor + "}\n"));
    const ProgramEnd end = support::scree({"check", "damped.yaml"}, folder.path());
    CHECK(end.code == 3);
    CHECK_THAT(end.out + end.err, Catch::Contains("damped.yaml:10:") && Catch::Contains("factor"));
  }
  lab::measured("61", "-0.1, 1, 1.5, NaN: exit 3 with file:line:column");
}
