// The impact of tests/peers against what three other codes give for it: the same scheme must leave the same error.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/measure.hpp"
#include "support/paths.hpp"
#include "support/scene_run.hpp"

using namespace support;

namespace {

constexpr std::array<double, 4> phases{0.13, 0.38, 0.63, 0.88};

struct Row {
  int per_contact;              ///< steps in one contact time
  std::array<double, 4> error;  ///< v_out/v_in - 1 at each start phase
  double worst;                 ///< the largest of their sizes
};

/// LAMMPS 20220106, LIGGGHTS 3.8 and YADE 2023.02, which agree to every digit that is not rounding
/// (tests/peers/impact.sh).
constexpr Row rows[] = {
    {10, {-2.221084e-3, -1.629318e-3, 1.231983e-3, 2.541245e-3}, 2.541e-3},
    {20, {-3.807247e-4, -2.514881e-4, 2.264567e-4, 4.009784e-4}, 4.010e-4},
    {50, {-3.749484e-5, -2.333681e-5, 2.334016e-5, 3.758463e-5}, 3.758e-5},
    {100, {-6.559792e-6, -4.002356e-6, 4.147158e-6, 6.465046e-6}, 6.560e-6},
    {200, {-1.153302e-6, -6.966200e-7, 7.348400e-7, 1.126942e-6}, 1.153e-6},
    {500, {-1.163096e-7, -6.982173e-8, 7.446060e-8, 1.130607e-7}, 1.163e-7},
};

std::string deck(int per_contact) {
  std::string text = read_text(source_dir() + "/tests/peers/scree/impact.yaml");
  const auto put = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  };
  put("per_contact: 100", "per_contact: " + std::to_string(per_contact));
  put("impact.csv", "balls.csv");
  return text;
}

}  // namespace

TEST_CASE("an elastic Hertz impact has the error that other codes of the same scheme have") {
  // scenes.md, S5: the balls start so that the contact begins a share of a step after a whole number of steps.
  constexpr double radius = 4e-3, density = 2500, effective = 1e7 / (2 * (1 - 0.3 * 0.3));
  const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius / 2;
  const double duration = 2.8682655 * std::pow(mass * mass / (radius / 2 * effective * effective), 0.2);
  Measure measure("S5", "restitution error in LAMMPS, LIGGGHTS and YADE with the same steps and start phases");
  for (const Row& row : rows) {
    std::string balls = "x,y,z,radius,vx,vy,vz\n";
    for (std::size_t k = 0; k < phases.size(); ++k)
      for (const int side : {-1, 1})
        balls += digits(side * (radius + 0.5 * (2 + phases[k]) * duration / row.per_contact)) + "," +
                 digits(0.02 * static_cast<double>(k)) + ",0,0.004," + digits(-0.5 * side) + ",0,0\n";
    SceneRun run(deck(row.per_contact), balls);
    const int cycles = 2 * row.per_contact + 10;
    run.step(static_cast<uint64_t>(cycles));
    CHECK(run.time() == Approx(cycles * duration / row.per_contact).epsilon(1e-9));
    REQUIRE(run.value("contacts.count") == 0);
    double worst = 0;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      const double error = run.ball(2 * k + 2).velocity[0] / 0.5 - 1;
      // A thousandth: at 500 steps they agree to five digits among themselves.
      CHECK(error == Approx(row.error[k]).epsilon(1e-3));
      worst = std::max(worst, std::abs(error));
    }
    measure.check("worst restitution error of 4 phases, " + std::to_string(row.per_contact) + " steps per contact",
                  worst, row.worst, 0.01 * row.worst);
  }
}
