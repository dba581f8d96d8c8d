#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/break.hpp"
#include "core/contact/contact_energy.hpp"
#include "core/contact/rule.hpp"
#include "core/contact/scratch.hpp"
#include "core/contact/stages.hpp"

namespace scree::core {

/// What a wall contact remembers. Balls touch few walls, so this is a record and not a set of columns.
struct WallSlot {
  uint32_t row = 0, patch = 0;
  std::array<double, 3> normal{};  ///< of the last pass: its tilt turns the state
  double dashpot = 0;              ///< J, what the dashpots took last, while energy is traced
};

/// Where a bonded ball meets the wall: the tangent plane of the patch where the wall last told of it, in the frame of
/// the wall's geometry, so that it goes along with the wall. The bond keeps to it where the wall tells of none.
struct WallBond {
  std::array<double, 3> foot{}, axis{};  ///< a point of the plane, m; unit normal, from the ball to the wall
  double distance = 0;                   ///< of the centre in the last pass, m
  uint8_t broke = 0;                     ///< how, within a pass; else 0
};

/// Contacts of the balls of one block with one wall under one rule. Candidates are found at list rebuilds; contacts are
/// born and end in the pass itself, in order of row and patch. Those that are bonded have lists of their own,
/// without candidates: their law runs at any gap, and those that break return within the pass.
struct WallList {
  uint32_t block = 0;
  uint16_t wall = 0, rule = 0;
  bool bonded = false;
  std::vector<uint32_t> candidates;         ///< rows near the wall, ascending
  std::vector<WallSlot> slots;              ///< active contacts, by row and patch
  std::vector<WallBond> bonds;              ///< one a slot, where bonded
  std::vector<double> state;                ///< slots x memory words of the rule
  std::vector<double> property;             ///< slots x varying words
  std::array<double, 3> force{}, moment{};  ///< on the wall, of the last pass
  /// Of the last pass when asked for: per slot force and moment on the wall, sliding, contact point.
  std::vector<double> report;
  static constexpr std::size_t report_words = 10;
};
/// The bonded lists of the block and wall of a list, which lie behind the others of that wall; none for one of them.
std::span<const WallList> bonds_beside(const std::vector<WallList>& lists, std::size_t index);

/// What the wall pass of a list reads and where it adds.
struct WallPass {
  const BallView* balls;
  const uint64_t* id;
  const Wall* wall;
  const BoundRule* rule;
  std::size_t first_row;
  double* slice;
  std::size_t stride;
  double dt, overlap_limit;
  bool sums, report;
  uint64_t cycle;
  ContactEnergy* energy;                     ///< where the energies are added; null: nobody asked
  std::span<const WallList> bonds{};         ///< the bonded lists beside this one
  const WallBreakHistory* breaks = nullptr;  ///< of all bonds with walls so far
  std::vector<Break>* broke = nullptr;       ///< where bonds that break are told
};
/// A wall contact that broke a guard: its overlap is beyond the limit, or what its law gave is useless (see Excess).
struct WallExcess {
  int64_t slot = -1;  ///< -1: none
  const char* useless = nullptr;
  std::array<double, 3> value{};
  double overlap = 0;  ///< m
};
/// Runs all contacts of the list; returns the first that broke a guard.
WallExcess run_wall_list(WallList& list, const WallPass& pass, Scratch& scratch);

/// Sum of the normal stiffness of the list's contacts at the present positions, N/m.
double wall_list_stiffness(const WallList& list, const WallPass& pass, Scratch& scratch);

/// The rule's properties changed: its contacts get them anew, their state stays where it still has the same words.
void renew_wall_list(WallList& list, const BoundRule& rule, const Balls& balls, const Wall& wall,
                     const WallBreakHistory& breaks);

/// Rows were removed: `now` gives the row of each row of before, or no_row. Candidates wait for the next rebuild.
void follow_rows(WallList& list, const std::vector<uint32_t>& now);

/// The rows among [first, last) whose surface is nearer to the wall than margin.
std::vector<uint32_t> wall_candidates(const BallView& balls, const Wall& wall, std::size_t first, std::size_t last,
                                      double margin);

}  // namespace scree::core
