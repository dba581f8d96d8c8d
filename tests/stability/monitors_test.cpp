// What watches the step while a run goes on, and the limits that collisions set.
#include <cmath>

#include "core/base/error.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

constexpr double density = 2500, radius = 0.01;
const double mass = density * 4.0 / 3 * 3.14159265358979323846 * radius * radius * radius;

std::string scene(const std::string& law, const std::string& head = "", const std::string& more = "") {
  return "scree: 1\n" + head + "balls:\n  all: {generator: file, path: balls.csv, density: 2500}\n" +
         "contacts:\n  - {name: all, between: [balls, balls], " + law + "}\n" + more + "stages:\n  - go: [cycle: 1]\n";
}

/// A row of balls along (1,1,1) that overlap by a thousandth, pulled apart and pushed together by turns.
std::string row_of_balls(int count, double speed) {
  std::string text = "x,y,z,radius,vx,vy,vz\n";
  for (int k = 0; k < count; ++k) {
    const double at = k * 0.01998 / std::sqrt(3.0), v = (k % 2 == 0 ? speed : -speed) / std::sqrt(3.0);
    char line[200];
    std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,0.01,%.17g,%.17g,%.17g\n", at, at, at, v, v, v);
    text += line;
  }
  return text;
}

/// Two balls a hundredth of a radius apart that meet at this speed.
std::string meeting(double speed) {
  return "x,y,z,radius,vx,vy,vz\n0,0,0,0.01,0,0,0\n0.0201,0,0,0.01,-" + std::to_string(speed) + ",0,0\n";
}

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// The row between two walls, so that every contact stays pressed and the springs act both ways.
std::string clamped(int count, const std::string& head, const std::string& more = "") {
  const std::string low = digits(-0.00998 / std::sqrt(3.0)),
                    high = digits(((count - 1) * 0.01998 + 0.00998) / std::sqrt(3.0));
  return "scree: 1\n" + head + "walls:\n  low: {wall: plane, point: [" + low + ", " + low + ", " + low +
         "], normal: [1, 1, 1]}\n  high: {wall: plane, point: [" + high + ", " + high + ", " + high +
         "], normal: [-1, -1, -1]}\nballs:\n  all: {generator: file, path: balls.csv, density: 2500}\n" +
         "contacts:\n  - {name: all, between: [balls, [balls, walls]], model: linear, kn: 1e5, ks: 0}\n" + more +
         "stages:\n  - go: [cycle: 1]\n";
}

}  // namespace

TEST_CASE("step STOP: beyond the limit the apparent frequency stops a run, below it never") {
  lab::Lab here;
  const double limit = std::sqrt(mass / 1e5);  // of a long row
  for (const double share : {0.9, 0.99, 1.02, 1.1}) {
    INFO("step over the limit " << share);
    const auto simulation =
        here.make(clamped(200, "unsafe: true\noverlap_limit: 1e6\ntimestep: " + digits(share * limit) + "\n"),
                  row_of_balls(200, 1e-4));
    bool stopped = false;
    try {
      lab::run(*simulation, 3000);
    } catch (const NumericalStop& stop) {
      stopped = true;
      CHECK(stop.code() == Exit::numerical);
      CHECK(std::string(stop.what()).find("apparent frequency") != std::string::npos);
      CHECK(std::string(stop.what()).find("stable limit") != std::string::npos);
    }
    CHECK(stopped == (share > 1));
  }
}

TEST_CASE("54 STOP: a law that reports a tenth of its stiffness is found out and named") {
  lab::Lab here;
  for (const auto& [share, found] : {std::pair{1.0, 0}, {0.95, 0}, {0.7, 1}, {0.1, 2}}) {
    INFO("reported share " << share);
    const auto simulation =
        here.make(scene("model: soft_law, kn: 1e5, share: " + std::to_string(share)), row_of_balls(3, 0));
    int warnings = 0;
    simulation->warn = simulation->engine.warn = [&](const std::string& text) {
      warnings += text.find("soft_law") != std::string::npos;
    };
    const auto go = [&] { lab::run(*simulation, 2); };
    if (found < 2) {
      CHECK_NOTHROW(go());
      CHECK(warnings == found);
    } else {
      CHECK_THROWS_WITH(go(), Catch::Contains("soft_law") && Catch::Contains("reports"));
    }
  }
}

TEST_CASE("a step that still holds stays, whatever its bits") {
  for (int bits = 32; bits < 64; ++bits) {
    StepControl control;
    control.restore({}, std::ldexp(bits, -20), ~uint64_t{0});
    control.take({control.holding(), 0, 0, "", "network", true}, 1);
    CHECK(control.step() == std::ldexp(bits, -20));
  }
}

TEST_CASE("step OK: a collision sets the step by the pair's own frequency at its peak") {
  lab::Lab here;
  const auto used = [&](const std::string& law, double speed, const std::string& head = "") {
    const auto simulation = here.make(scene(law, head), meeting(speed));
    simulation->engine.forces();
    CHECK(simulation->engine.step.bound().term == "pair");
    return simulation->engine.step.bound().step;
  };
  // Two equal balls: effective mass m/2, limit 2 sqrt(m/2k).
  const double pair = 2 * std::sqrt(0.5 * mass / 1e5);
  CHECK(used("model: linear, kn: 1e5, ks: 0", 0.1) == Approx(0.276 * pair));
  CHECK(used("model: linear, kn: 1e5, ks: 0", 0.1, "timestep: accurate\n") == Approx(0.1 * pair));
  // Hertz: m* v^2/2 = 0.4 h d^2.5 at the peak, where the tangent is 1.5 h sqrt(d).
  for (const double speed : {1e-4, 1e-2, 1.0}) {
    const double h = 1e9, peak = std::pow(0.25 * mass * speed * speed / (0.4 * h), 0.4);
    CHECK(used("model: hertz_law, h: 1e9", speed) ==
          Approx(0.276 * 2 * std::sqrt(0.5 * mass / (1.5 * h * std::sqrt(peak)))).epsilon(0.02));
  }
  // At rest nothing collides.
  const auto still = here.make(scene("model: linear, kn: 1e5, ks: 0"), meeting(0));
  still->engine.forces();
  CHECK(still->engine.step.bound().step == Approx(pair));
}

TEST_CASE("15 OK: a Hertz collision under the automatic step keeps its energy, from 1e-4 to 1 m/s") {
  lab::Lab here;
  double worst = 0;
  for (const double speed : {1e-4, 1e-2, 1.0})
    for (const std::string head : {"", "timestep: accurate\n"}) {
      const auto simulation = here.make(scene("model: hertz_law, h: 1e9", head), meeting(speed));
      for (int k = 0; k < 60000 && lab::at(*simulation, Column::vx, 1) > -0.5 * speed; ++k)
        simulation->engine.advance();
      lab::run(*simulation, 100);
      const double gone = lab::at(*simulation, Column::vx, 1) - lab::at(*simulation, Column::vx, 2);
      INFO("speed " << speed << " " << head << " after " << gone);
      CHECK(std::fabs(std::fabs(gone) / speed - 1) < (head.empty() ? 0.02 : 0.002));
      worst = std::max(worst, std::fabs(std::fabs(gone) / speed - 1));
    }
  lab::measured("15", "Hertz collisions at 1e-4, 1e-2, 1 m/s, automatic and accurate: largest error of the speed " +
                          lab::number(worst));
}

TEST_CASE("step OK: no contact is born deeper than a twentieth of the radius") {
  lab::Lab here;
  // Soft and fast: the pair's own limit would let it in at once.
  const auto simulation = here.make(scene("model: linear, kn: 1, ks: 0"), meeting(5));
  simulation->engine.forces();
  CHECK(simulation->engine.step.bound().term == "kinematic");
  CHECK(simulation->engine.step.bound().step == Approx(0.05 * radius / 5));
  CHECK(simulation->engine.step.bound().text() == "kinematic of ball 1, contact with ball 2");
}

namespace {

void stay_bounded(int parts) {
  lab::Lab here;
  for (const int balls : {2, 30}) {
    const auto simulation =
        here.make(clamped(balls, "", "processes:\n  damping: {process: local_damping, factor: 0.7}\n"),
                  row_of_balls(balls, 1e-3));
    double first = 0, last = 0;
    for (int part = 0; part < parts; ++part) {
      lab::run(*simulation, 100);
      last = 0;
      for (std::size_t row = 0; row < simulation->engine.balls.size(); ++row)
        last = std::max(last, std::fabs(simulation->engine.balls[Column::vx][row]));
      if (part == 0) first = last;
    }
    INFO(balls << " balls");
    CHECK(last <= first);
    CHECK(last < 1e-4);
  }
}

}  // namespace

TEST_CASE("8 OK: a pair and a row along (1,1,1) with local damping 0.7 stay bounded") { stay_bounded(100); }

TEST_CASE("8 OK: the same for 1e6 cycles", "[.][verify]") { stay_bounded(10000); }

TEST_CASE("41 REJECT: a step of 0, no number, or far too long is refused with its place") {
  lab::Lab here;
  for (const std::string step : {"0", "-1e-6", ".nan", "nan", ".inf", "1e30"}) {
    INFO("timestep " << step);
    std::string said;
    try {
      const auto simulation =
          here.make(scene("model: linear, kn: 1e5, ks: 0", "timestep: " + step + "\n"), row_of_balls(2, 0));
      simulation->engine.forces();
    } catch (const std::exception& refusal) {
      said = refusal.what();
    }
    CHECK(said.find("scene.yaml:2:") != std::string::npos);
    CHECK(said.find("timestep") != std::string::npos);
  }
}
