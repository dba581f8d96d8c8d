#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/threads.hpp"
#include "core/contact/links.hpp"
#include "core/contact/rule.hpp"
#include "core/contact/step_bound.hpp"
#include "core/world/balls.hpp"
#include "core/world/cell.hpp"

namespace scree::core {

/// What holds however balls are arranged: a ball has no more contacts than find room round it, as long as those that
/// touch it do not overlap each other by more than `depth`, and none of its contacts is stiffer than the stiffest that
/// its rules allow down to there. Costs nothing while balls move. Bonds and walls are not in it.
class Crowd {
 public:
  /// Looks at which balls may overlap others without a force. `take` must follow.
  Crowd(const RuleBook& book, const Balls& balls, const PeriodicCell& cell, Team& team);
  /// The same balls, in whatever order of rows. `depth`: share of the smaller radius that no two of them overlap by;
  /// `local_damping`: Cundall's factor.
  void take(const RuleBook& book, const Balls& balls, double depth, double local_damping);
  /// Why there is no such limit for these rules and balls; "" where there is one.
  const std::string& unknown() const { return unknown_; }
  double depth() const { return depth_; }
  double local_damping() const { return local_damping_; }
  /// Whether balls that may overlap others are where they were when it was made.
  bool still(const Balls& balls) const { return resting_ == at_rest(balls); }
  /// Of the step, for any arrangement.
  const StepBound& bound() const { return bound_; }
  /// What the contacts with balls take at most of a ball's mass and inertia at half a step `h` (s): the largest
  /// eigenvalue of h^2 stiffness + h damping over them.
  double share(uint16_t group, double radius, double h) const;
  /// Limit of the step of the stiffest pair that could collide, s, where no stiffness changes with the overlap; else 0.
  double pair_step() const { return pair_step_; }

 private:
  /// Balls of one group and nearly one size.
  struct Class {
    uint16_t group = 0;
    double low = 0, high = 0;                ///< radii, m
    double least_mass = 0, most_mass = 0;    ///< kg, of those that move
    uint32_t row = no_row, moving = no_row;  ///< one of all, and the lightest that moves
    uint64_t id = 0;                         ///< of the lightest that moves
    bool fixed = false;                      ///< some do not move
    /// The most that its contacts do, one by one, each as often as it counts: N/m, N m/rad, N s/m.
    double normal = 0, shear = 0, bending = 0, twist = 0, dashpot_normal = 0, dashpot_shear = 0;
    double cosine = 0;  ///< of half the least angle between two contacts
    double reach = 0;   ///< m, largest gap of a contact
  };
  void sort(const Balls& balls);
  void look_for_loose(const RuleBook& book, const Balls& balls, const PeriodicCell& cell, Team& team);
  void weigh(const RuleBook& book);
  void find_room(Class& c, double smallest);
  double share(const Class& c, double h) const;
  void find_bound();
  uint64_t at_rest(const Balls& balls) const;

  double depth_ = 0, loose_overlap_ = 0;  ///< of the smaller radius
  double local_damping_ = 0;
  StepBound bound_;
  bool loose_moves_ = false;
  std::string unknown_;
  std::vector<Class> classes_;
  std::vector<uint8_t> loose_;  ///< by group: its balls may overlap others without a force
  uint64_t resting_ = 0;
  double pair_step_ = 0;
};

/// The limit of the step where balls touch walls as the links tell, and other balls in any arrangement. One that is
/// seen to lie below `least` (s) is not looked for: the step is then 0.
StepBound crowd_at_walls(const Crowd& crowd, const std::vector<Link>& with_walls, const Balls& balls,
                         const std::vector<Wall>& walls, double least = 0);

}  // namespace scree::core
