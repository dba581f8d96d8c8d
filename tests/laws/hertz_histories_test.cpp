// PFC's own histories of one contact under Hertz's law, met to their printed digits: hertz_histories.csv says whence.
#include "support/hertz_histories.hpp"
#include "laws/hertz_contact.hpp"

namespace {
using namespace scree::test;
using scree::Vec3;
using Instant = std::vector<double>;

/// The contact under the program of PFC's example: 0.1 s together, 0.05 s of shear along x and along z, 0.05 s of twist
/// of one piece, 0.1 s apart, in steps of a millisecond.
struct Replay {
  explicit Replay(const std::string& name) : balls(name.substr(0, 2) == "bb"), setting(name[2]) {}
  Settings settings() const {
    Settings all = {{"shear", 1e9}, {"poiss", 0.3}, {"fric", 0.5}, {"hz_mode", setting == '1' ? 0.0 : 1.0}};
    if (setting == '3')
      for (const auto& more : Settings{{"dp_nratio", 0.5}, {"dp_sratio", 0.5}, {"dp_mode", 3}}) all.push_back(more);
    return all;
  }
  double mass() const { return 4.0 / 3.0 * std::acos(-1.0) * std::pow(radius, 3) * 2500 * (balls ? 0.5 : 1); }

  void step(HertzContact& c, int n) {
    const double depth = 1e-5 * (std::min(n, 100) - std::max(0, n - 250));
    const double slip = 0.00628 * (radius - depth / 2) * dt;
    // The frame of the file is turned: its y is the normal here, its z is -y.
    const Vec3 way = n > 100 && n <= 150 ? Vec3{-slip, 0, 0} : n > 150 && n <= 200 ? Vec3{0, -slip, 0} : Vec3{};
    const bool twist = n > 200 && n <= 250;  // the contact turns by the mean of both spins
    const double stiffness = c.depth() > 0 ? c.ks() : 0;
    const double held = stiffness > 0 ? c.shear_spring().squaredNorm() / (2 * stiffness) : 0;
    c.move(depth, way, dt, twist ? 0.5 * 6.28 * dt : 0);
    // PFC does not count what the shear spring loses as its stiffness changes.
    const double change = stiffness > 0 ? c.ks() / stiffness : 1;
    if (change < 1 && (setting != '1' || change == 0)) uncounted += held * (1 - change);
    if (change > 1) uncounted += held * (1 - 1 / change);
  }

  static constexpr double radius = 0.5, dt = 1e-3;
  bool balls;
  char setting;
  double uncounted = 0;
};

}  // namespace

TEST_CASE("hertz_mindlin: forces and energies of PFC's histories of one contact") {
  const auto all = support::hertz_histories();
  REQUIRE(all.size() == 6);
  for (const auto& [name, instants] : all) {
    REQUIRE(instants.size() == 12);
    Replay replay(name);
    HertzContact c(replay.settings(), Replay::radius, replay.balls ? Replay::radius : 0, replay.mass());
    int n = 0;
    for (const Instant& now : instants) {
      while (n * Replay::dt < now[0] - 1e-9) replay.step(c, ++n);
      INFO(name << " at " << now[0] << " s");
      CHECK(c.depth() == Approx(now[1]).margin(1e-15));
      const Vec3 shear = c.shear_spring();
      // The file has seven digits; its shear components were turned by a formula of second order.
      CHECK(c.force().z == Approx(now[2] + now[3]).margin(5e-7 * (now[2] + std::abs(now[3]))));
      CHECK(shear.x == Approx(now[4]).epsilon(1e-6).margin(1e-9));
      CHECK(shear.y == Approx(-now[5]).epsilon(1e-6).margin(1e-9));
      CHECK(shear.x + now[6] == Approx(c.force().x).epsilon(1e-6).margin(1e-9));
      CHECK(c.strain() == Approx(now[7]).epsilon(5e-7));
      CHECK(c.friction - replay.uncounted == Approx(now[8]).epsilon(5e-7).margin(1e-12));
      CHECK(c.dashpot == Approx(now[9]).epsilon(5e-7).margin(1e-12));
    }
  }
}
