// Cases 5, 6, D4, D5: small balls beside a very large one.
#include <array>
#include <cmath>
#include <vector>

#include "core/base/philox.hpp"
#include "core/contact/search_cost.hpp"
#include "stability/lab.hpp"
#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;

namespace {

using Spheres = std::vector<std::array<double, 4>>;  // centre, radius; m

uint64_t brute_force(const Spheres& all) {
  uint64_t touching = 0;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      touching +=
          std::hypot(all[a][0] - all[b][0], all[a][1] - all[b][1], all[a][2] - all[b][2]) < all[a][3] + all[b][3];
  return touching;
}

constexpr double small = 1e-3, large = 0.1;  // m, radii

/// Balls of 1 mm within 8 % on a shaken body-centred lattice so narrow that most neighbours touch: those of a cube, or
/// of a cap ten layers thick on a ball of 100 mm, itself the first. About `count` of them.
Spheres pack(std::size_t count, bool on_large) {
  const double edge = 1.145 * 2 * small;
  const auto sites = static_cast<int>(std::lround(std::cbrt(static_cast<double>(count) / 2)));
  // The cap: two balls in every edge^3.
  const double thick = 12 * edge, wide = std::sqrt(static_cast<double>(count) / 2 * edge * edge * edge / thick / 3.14);
  const auto reach = static_cast<int>(wide / edge) + 1;
  const scree::core::Random random(4, "pack");
  Spheres all;
  if (on_large) all.push_back({0, 0, 0, large});
  uint64_t drawn = 0;
  const auto site = [&](double x, double y, double z) {
    std::array<double, 4> one{x * edge, y * edge, z * edge, small * (1 + 0.08 * (2 * random.uniform(drawn, 3) - 1))};
    for (std::size_t c = 0; c < 3; ++c) one[c] += 0.06 * small * (2 * random.uniform(drawn, c) - 1);
    ++drawn;
    const double away = std::hypot(one[0], one[1], one[2]);
    const bool held = away > large + 0.9 * one[3] && away < large + thick && std::hypot(one[0], one[1]) < wide;
    if (!on_large || held) all.push_back(one);
  };
  const int low = on_large ? -reach : 0, high = on_large ? reach : sites;
  const int floor = on_large ? static_cast<int>((large - wide) / edge) : 0,
            top = on_large ? static_cast<int>((large + thick) / edge) + 1 : sites;
  for (int i = low; i < high; ++i)
    for (int j = low; j < high; ++j)
      for (int k = floor; k < top; ++k)
        for (const double half : {0.25, 0.75}) site(i + half, j + half, k + half);
  return all;
}

/// What a cycle and a rebuild of lists have to do for each contact.
struct Work {
  std::size_t balls = 0;
  double contacts = 0, listed = 0, looked_at = 0;  ///< the last two for each contact
};

Work work(const Spheres& all) {
  std::string balls = "x,y,z,radius\n";
  for (const auto& [x, y, z, r] : all) balls += digits(x) + "," + digits(y) + "," + digits(z) + "," + digits(r) + "\n";
  SceneRun run(
      "scree: 1\ntimestep: 1e-7\nballs:\n  all: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - "
      "{between: [all, all], model: linear, kn: 1e4, ks: 0}\n",
      balls);
  auto& engine = run.engine();
  Work out{all.size(), static_cast<double>(engine.contacts.active()), 0, 0};
  out.listed = static_cast<double>(engine.contacts.listed()) / out.contacts;
  out.looked_at = static_cast<double>(candidates(engine.balls, engine.cell, engine.skin())) / out.contacts;
  return out;
}

}  // namespace

TEST_CASE("D4 OK: beside a ball 100 times as large a contact costs what it costs among equals") {
  const Spheres few = pack(2000, true);
  CHECK(static_cast<double>(brute_force(few)) == work(few).contacts);
  const Work equal = work(pack(20000, false)), mixed = work(pack(20000, true));
  INFO(equal.balls << " equal balls, " << equal.contacts << " contacts; " << mixed.balls << ", " << mixed.contacts);
  CHECK(mixed.balls > 15000);
  CHECK(mixed.contacts == Approx(equal.contacts).epsilon(0.2));
  // With one grid of the large ball's size each ball would look at thousands.
  CHECK(mixed.looked_at < 1.5 * equal.looked_at);
  CHECK(mixed.listed < 1.5 * equal.listed);
  lab::measured("D4", std::to_string(mixed.balls) + " balls, for each contact " + lab::number(mixed.listed) +
                          " listed pairs and " + lab::number(mixed.looked_at) + " balls looked at; among equals " +
                          lab::number(equal.listed) + " and " + lab::number(equal.looked_at));
}

TEST_CASE("5 6 D5 OK: small balls on one 10, 1000 and 1e4 times as large: every contact is found") {
  std::string said;
  for (const double ratio : {10.0, 1000.0, 1e4}) {
    INFO("radius ratio " << ratio);
    const scree::core::Random random(5, "sizes");
    const double small = 1e-3, large = ratio * small;
    Spheres all{{0, 0, 0, large}};
    std::string balls = "x,y,z,radius\n0,0,0," + digits(large) + "\n";
    for (uint64_t k = 0; k < 400; ++k) {
      double at[3], size = 0;
      for (uint64_t c = 0; c < 3; ++c) size += std::pow(at[c] = random.normal(k, c), 2);
      // All on one side, so that small ones meet as well where the large one is not too large.
      at[2] = std::abs(at[2]) + 30 * std::sqrt(size) * (ratio > 10 ? 1 : 0);
      size = std::sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
      const double distance = large + small * (1 + 0.1 * (random.uniform(k, 3) - 0.5));
      all.push_back({at[0] / size * distance, at[1] / size * distance, at[2] / size * distance, small});
      balls += digits(all.back()[0]) + "," + digits(all.back()[1]) + "," + digits(all.back()[2]) + ",1e-3\n";
    }
    const uint64_t touching = brute_force(all);
    SceneRun run(
        "scree: 1\ntimestep: 1e-7\noverlap_limit: 300 %\nballs:\n  all: {generator: file, path: balls.csv, "
        "density: 2500}\n"
        "contacts:\n  - {between: [all, all], model: linear, kn: 1e4, ks: 0}\n",
        balls);
    CHECK(run.engine().contacts.active() == touching);
    CHECK(touching > 150);
    run.step(200);
    CHECK(run.engine().balls.size() == 401);
    said += "1:" + lab::number(ratio) + ": " + std::to_string(touching) + " contacts; ";
  }
  lab::measured("5, 6, D5", said + "as counted by brute force");
}
