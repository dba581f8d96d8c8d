#pragma once
// One contact under hertz_mindlin, driven by hand.
#include <cmath>

#include "laws/columns.hpp"
#include "support/catch.hpp"

namespace scree::test {

inline const scree_contact_model& hertz() {
  return built_plugins().open(core::Kind::contact_model, "hertz_mindlin").contact_model();
}

/// Two balls, or a ball at a wall (r2 = 0), with inputs as a scene would give them.
class HertzContact {
 public:
  HertzContact(const Settings& settings, double r1, double r2, double mass = 0.01)
      : columns_(hertz(), rule(settings, r1, r2, mass), 1) {
    contact.r1 = r1;
    contact.r2 = r2;
    contact.mass = mass;
    columns_.energy = true;
  }

  /// Moves to an overlap while piece 2 slips by `slip` and the contact turns about its normal (z) by `spin`, in dt.
  void move(double depth, const Vec3& slip, double dt, double spin = 0) {
    columns_.dt = dt;
    contact.velocity = dt > 0 ? slip / dt + Vec3{0, 0, (depth_ - depth) / dt} : Vec3{};
    contact.turn = {0, 0, 2 * std::tan(0.5 * spin)};
    depth_ = depth;
    contact.gap = -depth;
    const Vec3 before = force();
    columns_.put(0, contact);
    REQUIRE(columns_.run() == 0);
    work -= 0.5 * (before + force()).dot(contact.velocity) * dt;
    friction += columns_.energies(1, 0);
    dashpot += columns_.energies(2, 0);
  }
  Vec3 force() const { return columns_.force(0); }
  Vec3 shear_spring() { return {columns_.state(0)[0], columns_.state(1)[0], columns_.state(2)[0]}; }
  double strain() const { return columns_.energies(0, 0); }
  bool sliding() const { return columns_.sliding(0); }
  double kn() { return tangent(true); }
  double ks() { return tangent(false); }
  double depth() const { return depth_; }

  OneContact contact;
  double work = 0, friction = 0, dashpot = 0;  ///< sums over all moves, J

  static std::vector<double> rule(const Settings& settings, double r1, double r2, double mass) {
    std::vector<double> words = rule_of(hertz(), settings);
    uint32_t form = 0;
    for (const auto& setting : settings)
      if (setting.first == "restitution") form = 1;
    char why[256] = "";
    const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
    INFO(why);
    REQUIRE(hertz().prepare(words.data(), form, &refusal) == 0);
    const scree_pair pair{sizeof(scree_pair), 0, r1, r2, mass};
    hertz().derive(words.data(), form, &pair);
    return words;
  }

 private:
  double tangent(bool normal) {
    double kn = 0, ks = 0;
    columns_.stiffness({sizeof(scree_stiffness), 1, &kn, &ks, nullptr, nullptr, nullptr, nullptr});
    return normal ? kn : ks;
  }
  Columns columns_;
  double depth_ = 0;
};

}  // namespace scree::test
