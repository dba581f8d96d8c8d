#pragma once
#include <array>
#include <memory>
#include <vector>

#include "core/vet/law_case.hpp"

namespace scree::core::vet {

/// A contact on a random path from birth to death, told in a frame that moves with it: the gap, two slips, two bends
/// and a twist go smoothly from one random point to the next, while the frame tilts and spins as a whole or stands
/// still. A bonded path returns to where it began; another one ends apart.
class Journey {
 public:
  Journey(const Case& c, Part part, uint64_t seed, bool turning);

  static constexpr uint32_t legs = 6;
  /// From birth again, with that many steps to a leg.
  void restart(uint32_t steps_per_leg);
  bool done() const { return step_ >= legs * steps_; }
  /// One step of length dt.
  Seen next(double dt);
  /// At rest where the last step ended.
  Seen still() const;

  const Vec3& normal() const { return frame_[0]; }
  const Vec3& across(std::size_t k) const { return frame_[1 + k]; }
  double gap() const { return at_[0]; }

 private:
  using Point = std::array<double, 6>;
  void go_round(double depth, Numbers& random);
  Point place(uint32_t step) const;
  void turn_frame(uint32_t leg, Vec3& turn);

  Seen piece_;
  std::array<Point, legs + 1> points_{};
  std::array<Vec3, legs> turns_{};  ///< of a whole leg in the frame: two tilts and a spin, rad
  std::array<Vec3, 3> start_{}, frame_{};
  uint32_t steps_ = 1, step_ = 0;
  Point at_{};
};

/// Contacts of one case, each on a journey of its own.
class Party {
 public:
  Party(const Case& c, Part part, std::size_t count, uint64_t seed, bool turning);
  void restart(uint32_t steps_per_leg);
  bool done() const { return journeys.front().done(); }
  /// The next step of all; then `seen` says what a law sees.
  void step(double dt);
  /// All at rest where they are.
  void rest();
  void put(LawBench& bench) const;
  /// A bench for these contacts.
  std::unique_ptr<LawBench> bench() const;

  Case model_case;
  Part part;
  std::vector<Journey> journeys;
  std::vector<Seen> seen;
};

/// Rotation by t = 2 tan(angle/2) along its axis.
Vec3 rotated(const Vec3& t, const Vec3& a);

}  // namespace scree::core::vet
