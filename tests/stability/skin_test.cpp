// How far the lists reach: further where balls use it up quickly, which changes nothing but the order of sums.
#include <cmath>

#include "core/cycle/skin.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

// 216 elastic balls of 4 to 6 mm in a periodic cube of 0.12 m, at 2 m/s: in 2e-4 s each flies a tenth of its radius.
std::string gas() {
  std::string balls = "id,x,y,z,radius,vx,vy,vz\n";
  for (int k = 0; k < 216; ++k) {
    const double a = 2.4 * k, b = std::acos(1 - (2 * k + 1) / 216.0);
    balls += std::to_string(k + 1);
    for (const int place : {k % 6, k / 6 % 6, k / 36}) balls += "," + lab::number(0.01 + 0.02 * place);
    balls += "," + lab::number(0.004 + 0.002 * (k % 7) / 6.0);
    for (const double v : {std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)})
      balls += "," + lab::number(2 * v);
    balls += "\n";
  }
  return balls;
}

std::unique_ptr<Simulation> flying(lab::Lab& here, const std::string& skin) {
  write_text(here.folder() / "gas.csv", gas());
  return here.make("scree: 1\ntimestep: 2e-4\ncell: {low: [0, 0, 0], high: [0.12, 0.12, 0.12], periodic: [x, y, z]}\n" +
                   skin +
                   "balls:\n  gas: {generator: file, path: gas.csv, density: 2500}\n"
                   "contacts:\n  - {between: [gas, gas], model: linear, kn: 1e4, ks: 0}\n"
                   "stages:\n  - go: [cycle: 1]\n");
}

}  // namespace

TEST_CASE("the skin widens where it is used up soon, and narrows where it lasts") {
  Skin skin;
  skin.begin(0, {1.0, 0.5, 10});
  const double narrow = skin.width();
  CHECK(narrow == 0.2);  // of the mean radius
  uint64_t cycle = 0;
  for (int k = 0; k < 10; ++k) {
    skin.used_up(cycle += 5);
    skin.renewed(cycle);
  }
  CHECK(skin.width() == 4 * narrow);
  // Between 30 and 105 cycles they are as wide as they should be: 120 and 420 of narrow ones.
  for (const uint64_t lasted : {31u, 104u}) {
    skin.used_up(cycle += lasted);
    CHECK(skin.width() == 4 * narrow);
    skin.renewed(cycle);
  }
  for (int k = 0; k < 10; ++k) {
    skin.used_up(cycle += 600);
    skin.renewed(cycle);
  }
  CHECK(skin.width() == narrow);
  // A skin of the user stays, and no pair may meet through two edges of a periodic cell.
  Skin wanted, cramped;
  wanted.begin(0.3, {1, 1, 10});
  wanted.used_up(1);
  CHECK(wanted.width() == 0.3);
  cramped.begin(0, {1, 1, 0.25});
  cramped.used_up(1);
  CHECK(cramped.width() == 0.25);
}

TEST_CASE("lists of a fast gas are made less often, and the balls move as before") {
  lab::Lab here;
  const auto chosen = flying(here, ""), narrow = flying(here, "skin: 1 mm\n");
  for (int k = 0; k < 120; ++k) {
    chosen->engine.forces();
    chosen->engine.advance();
    narrow->engine.forces();
    narrow->engine.advance();
  }
  CHECK(chosen->engine.skin() > 3e-3);
  CHECK(chosen->engine.rebuilds() * 2 < narrow->engine.rebuilds());
  // Collisions part what rounding began, so only for so long.
  const Balls &a = chosen->engine.balls, &b = narrow->engine.balls;
  REQUIRE(a.size() == b.size());
  std::vector<std::array<double, 3>> at(a.size() + 1);
  for (std::size_t row = 0; row < a.size(); ++row)
    at[a.id()[row]] = {a[Column::x][row], a[Column::y][row], a[Column::z][row]};
  double most = 0;
  for (std::size_t row = 0; row < b.size(); ++row) {
    const auto& other = at[b.id()[row]];
    most = std::max({most, std::fabs(other[0] - b[Column::x][row]), std::fabs(other[1] - b[Column::y][row]),
                     std::fabs(other[2] - b[Column::z][row])});
  }
  CHECK(most < 1e-6 * 4e-3);
  lab::measured("skin", "216 balls, 120 cycles: lists made " + std::to_string(chosen->engine.rebuilds()) +
                            " instead of " + std::to_string(narrow->engine.rebuilds()) + " times, positions within " +
                            lab::number(most / 4e-3) + " R");
}
