#pragma once
#include <cstdint>
#include <vector>

#include "core/contact/wall_list.hpp"
#include "core/contact/wall_touches.hpp"

namespace scree::core {

/// A bond of a ball with a patch of a wall that is to be made. Rows are those of the lists as they are built now.
struct NewWallBond {
  uint16_t rule, wall;
  uint32_t row, patch;
  std::array<double, 3> normal;  ///< from the ball to the wall, in the scene's frame
  double distance;               ///< of the centre, m
};

/// Where the slots of a bonded list meet their wall now: entry k of the order belongs to slot k, and those from `seen`
/// on (the result) are such as the wall does not tell of, on the plane that the bond remembers.
uint32_t place_bonds(const WallList& list, const Wall& wall, const BallView& balls, WallTouches& out);
/// Keeps where the slots meet their wall, after place_bonds.
void keep_places(WallList& list, const Wall& wall, const BallView& balls, const WallTouches& touches, uint32_t seen);
/// Takes the touches whose ball (an index into rows) and patch are bonded out of the order.
void leave_out(WallTouches& touches, const std::vector<uint32_t>& rows, const WallList& bonds);

/// Bonds that broke in the pass leave their list: to the list beside it while they touch (null: there is none), with
/// State and properties, else for good.
void release_broken(WallList& bonds, WallList* touch, const BoundRule& rule, const BallView& balls,
                    ContactEnergy& energy);

/// What new bonded lists are made of.
struct WallBondCarry {
  const Balls* balls;
  const std::vector<Wall>* walls;
  const RuleBook* book;
  const std::vector<uint32_t>* new_row;  ///< of each row of the old lists; empty when rows did not move
  const WallBreakHistory* breaks;
};
/// The bonded lists of bonds that hold in the old lists and of those to be made, by block, wall and rule. A new bond
/// has the State of the contact that it was.
std::vector<WallList> rebuilt_wall_bonds(const std::vector<WallList>& old, const std::vector<NewWallBond>& fresh,
                                         const WallBondCarry& carry);

}  // namespace scree::core
