// Case 56: moments. A law answers with one force at the contact point and one moment; the kernel gives both to piece 2
// and their opposites, at that same point, to piece 1. So no law can make momentum or moment of momentum, and a law
// whose answer is not that of Newton's third law shows elsewhere: in energy, and in a result that depends on numbers.
#include <algorithm>
#include <array>
#include <cmath>

#include "stability/lab.hpp"
#include "support/catch.hpp"
#include "support/program.hpp"

using namespace scree::core;

namespace {

constexpr double momentum_share = 1e-13;  // a few hundred roundings of what each ball has

/// Momentum, moment of momentum about the origin and energy of motion, and the sizes that the sums are made of. With
/// x(n) and v(n - 1/2) both sums are kept exactly by leapfrog where forces and moments have opposites.
struct Sums {
  std::array<double, 3> momentum{}, turn{};
  double momentum_size = 0, turn_size = 0, energy = 0;
};

Sums sums(const Simulation& simulation) {
  const Balls& balls = simulation.engine.balls;
  Sums out;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    const auto at = [&](Column first, std::size_t c) {
      return balls[static_cast<Column>(static_cast<std::size_t>(first) + c)][row];
    };
    const double m = balls[Column::mass][row], r = balls[Column::radius][row], inertia = 0.4 * m * r * r;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3, e = (c + 2) % 3;
      const double p = m * at(Column::vx, c), spin = inertia * at(Column::wx, c),
                   left = m * at(Column::x, d) * at(Column::vx, e), right = m * at(Column::x, e) * at(Column::vx, d);
      out.momentum[c] += p;
      out.turn[c] += left - right + spin;
      out.momentum_size += std::fabs(p);
      out.turn_size += std::fabs(left) + std::fabs(right) + std::fabs(spin);
      out.energy += 0.5 * (p * p / m + spin * spin / inertia);
    }
  }
  return out;
}

/// Five unequal balls in a bent row, all away from the origin, that hold on to each other.
const char* const row =
    "x,y,z,radius,vx,vy,vz,wx,wy,wz\n"
    "0.5,0.2,0.1,0.01,0.01,0,0.02,1,0,0\n"
    "0.522,0.2,0.1,0.012,0,-0.01,0,0,2,0\n"
    "0.522,0.222,0.1,0.01,0,0.01,0.01,0,0,-3\n"
    "0.522,0.222,0.119,0.009,-0.02,0,0,0,1,0\n"
    "0.505,0.222,0.119,0.008,0,0,-0.02,2,0,1\n";

std::string scene(const std::string& lean, const std::string& moment) {
  return "scree: 1\nballs:\n  all: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: odd, "
         "between: [all, all], model: crooked_law, kn: 1e5, tear: 2 mm, lean: " +
         lean + ", moment: " + moment + "}\nstages:\n  - go: [cycle: 1]\n";
}

double apart(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("56 OK: whatever force and moment a law returns, momentum and moment of momentum are kept") {
  lab::Lab here;
  const auto simulation = here.make(scene("[0.3, -0.2, 0.1]", "[2e-3, -1e-3, 3e-3]"), std::string(row));
  const Sums before = sums(*simulation);
  double drift = 0, turn = 0, energy = 0;
  uint64_t touching = 0;
  for (int part = 0; part < 100; ++part) {
    lab::run(*simulation, 100);
    const Sums now = sums(*simulation);
    drift = std::max(drift, apart(now.momentum, before.momentum) / now.momentum_size);
    turn = std::max(turn, apart(now.turn, before.turn) / now.turn_size);
    energy = std::max(energy, now.energy);
    touching += simulation->engine.contacts.active();
  }
  CHECK(touching > 100);
  CHECK(drift <= momentum_share);
  CHECK(turn <= momentum_share);
  // What such a law does make is energy: these couples turn the balls ever faster.
  CHECK(energy > 10 * before.energy);
  lab::measured("56", "10 000 cycles: momentum within " + lab::number(drift) + ", moment of momentum within " +
                          lab::number(turn) + " of what the balls have, energy of motion " +
                          lab::number(energy / before.energy) + " times");
}

TEST_CASE("56 REJECT: `scree vet` finds that such a law depends on numbers and axes") {
  const std::string library = support::binary_dir() + "/tests/hostile/contact_model/crooked_law.so";
  for (const std::string check : {"exchange", "frame_turn", "turns_along"}) {
    INFO(check);
    CHECK(support::scree({"vet", library, "--check", check}).code == 4);
  }
}
