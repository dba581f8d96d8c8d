#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/contact/bond_table.hpp"
#include "core/contact/break.hpp"
#include "core/contact/contact_energy.hpp"
#include "core/contact/rule.hpp"
#include "core/contact/run_law.hpp"
#include "core/contact/scratch.hpp"
#include "core/contact/slices.hpp"
#include "core/contact/stages.hpp"
#include "core/contact/touch_list.hpp"
#include "core/contact/wall_bonds.hpp"
#include "core/contact/wall_list.hpp"
#include "core/world/balls.hpp"
#include "core/world/cell.hpp"
#include "core/world/wall.hpp"

namespace scree::core {

/// A pair that broke a guard in the contact pass: its overlap is beyond the limit, or what its law gave is useless.
struct Excess {
  bool found = false;
  std::string rule, plugin;
  uint64_t id1 = 0, id2 = 0;  ///< id2 is 0 for a wall
  std::string wall;
  double overlap = 0, radius = 0;  ///< m; of the smaller ball
  const char* useless = nullptr;   ///< "force" or "moment"; null: it is the overlap
  std::array<double, 3> value{};   ///< of that force or moment on piece 2, N or N m
};

/// Which pairs an order to bond means.
struct BondOrder {
  /// Pieces that are placed to touch exactly are a rounding error apart: this share of their radii.
  static constexpr double touching = 1e-12;
  uint16_t rule = 0;
  double gap = 0;                                                ///< largest gap of a pair that is bonded, m
  bool again = true;                                             ///< also pairs whose bond broke
  std::function<bool(uint16_t group1, uint16_t group2)> chosen;  ///< empty: all pairs of the rule
  /// Also with these walls, by index. Empty: with none, except that a rule that holds between no two balls means its
  /// walls where `chosen` is empty too.
  std::function<bool(uint16_t group, uint16_t wall)> chosen_walls{};
};

/// What one evaluation of all contacts is asked to do beside forces.
struct PassOptions {
  double dt = 0;               ///< of the drift that led here, s
  double overlap_limit = 0.5;  ///< of the smaller radius
  /// Of the smaller radius; deeper overlaps of two balls are told by Contacts::deepest().
  double depth = std::numeric_limits<double>::infinity();
  bool sums = false;    ///< also the sum of contact force sizes per ball
  uint64_t cycle = 0;   ///< for the note of a crash
  bool report = false;  ///< also force, moment and sliding flag per contact
  bool energy = false;  ///< also the energies
};

/// All contacts of the scene: lists by rule, walls, force records, and the pass over them.
class Contacts {
 public:
  RuleBook book;
  int isa = 0;

  /// New row order, pair search, lists with everything contacts remember, wall candidates, halos.
  void rebuild(Balls& balls, std::vector<Wall>& walls, const PeriodicCell& cell, double skin, Team& team);
  /// One force pass over all blocks: records, wall resultants. Returns the first excess overlap in block order.
  Excess evaluate(const Balls& balls, std::vector<Wall>& walls, const PeriodicCell& cell, const PassOptions& options,
                  Team& team);

  /// The touch lists, one per rule, then as many bonded lists, those of rules without bonds empty.
  const std::vector<TouchList>& lists() const { return lists_; }
  std::vector<WallList>& wall_lists() { return wall_lists_; }
  const std::vector<WallList>& wall_lists() const { return wall_lists_; }
  Slices& slices() { return slices_; }
  const Slices& slices() const { return slices_; }
  bool built() const { return built_; }
  void drop_lists() { built_ = false; }
  /// Forgets all contacts, as when rules are replaced.
  void forget();
  /// Rows were removed since the lists were built: keep[row] tells which stayed. The next rebuild follows it.
  void rows_kept(const std::vector<uint8_t>& keep);
  /// The wall with this index is gone; later ones move down by one.
  void wall_gone(std::size_t wall);
  /// The properties of a rule changed: its contacts get them anew (their state stays).
  void renew(std::size_t rule, const Balls& balls, const std::vector<Wall>& walls);
  /// Sum of the normal stiffness of a wall's active contacts, N/m. [one thread, between passes]
  double wall_stiffness(std::size_t wall, const Balls& balls, const std::vector<Wall>& walls);
  /// For checkpoints: the row that each row had when the lists were built; empty when rows were not removed since.
  const std::vector<uint32_t>& rows_before() const { return before_; }
  /// Puts back lists that were saved; they must fit the book, the walls and `rows`. Lays out the records anew.
  void restore(std::vector<TouchList> lists, std::vector<WallList> wall_lists, std::vector<uint32_t> rows_before,
               bool built, std::size_t rows, Team& team);
  /// Bonds the pairs of a rule whose gap is at most that of the order and which are not bonded yet; they are in the
  /// bonded list from the next rebuild on, which must follow. The lists must be built and nothing moved since. How
  /// many.
  uint64_t bond(const BondOrder& order, const Balls& balls, const std::vector<Wall>& walls, const PeriodicCell& cell,
                Team& team);
  /// Takes all bonds of a rule away, as if they had never been.
  void drop_bonds(std::size_t rule);
  /// Bonds that broke in the last pass, by ids; counts them. Call once after every pass.
  std::vector<Break> take_breaks();
  uint64_t bonded() const;  ///< bonds that hold
  /// Sums of the last pass that was asked for them.
  const ContactEnergy& energy() const { return energy_; }
  void set_energy(const ContactEnergy& energy) { energy_ = energy; }
  BreakHistory breaks;                     ///< of all bonds between balls so far
  WallBreakHistory wall_breaks;            ///< of all bonds with walls so far
  std::array<uint64_t, 2> broken_bonds{};  ///< how many broke so far, in tension and in shear
  std::size_t bytes() const;
  uint64_t active() const;  ///< ball-ball contacts whose law runs
  uint64_t listed() const;  ///< pairs in lists, touching or not
  /// Overlap of the deepest pair of balls in the last pass over its smaller radius, where beyond the depth of the
  /// pass's options; else 0.
  double deepest() const { return deepest_; }

 private:
  Excess run_block(std::size_t block, const Balls& balls, const std::vector<Wall>& walls, const double (*shift)[3],
                   const PassOptions& options, Scratch& scratch);
  Excess run_list(std::size_t block, std::size_t rule, const Balls& balls, const double (*shift)[3],
                  const PassOptions& options, Scratch& scratch);
  void rebuild_wall_lists(const Balls& balls, const std::vector<Wall>& walls, const std::vector<uint32_t>& new_row,
                          double skin, Team& team);
  void lay_out_lists();
  void run_batch(TouchList& list, uint32_t n, const Balls& balls, const PassOptions& options, std::size_t block,
                 Scratch& scratch);
  void run_walls(std::size_t block, const Balls& balls, const std::vector<Wall>& walls, const PassOptions& options,
                 Excess& worst, Scratch& scratch);
  void give_wall_slots(const std::vector<WallList>& old, const std::vector<uint32_t>& new_row);
  bool bonded_with(uint32_t row, uint16_t wall, uint32_t patch) const;
  bool between_balls(uint16_t rule) const;
  void bond_walls(const BondOrder& order, const Balls& balls, const std::vector<Wall>& walls);
  std::vector<TouchList> lists_;             ///< see lists()
  std::vector<NewBond> fresh_;               ///< made at the next rebuild
  std::vector<NewWallBond> fresh_walls_;     ///< the same with walls
  std::vector<std::vector<Break>> broke_;    ///< in the last pass, by block
  std::vector<ContactEnergy> block_energy_;  ///< of the last pass
  ContactEnergy energy_;
  std::vector<double> block_deepest_;  ///< of the last pass
  double deepest_ = 0;
  std::vector<WallList> wall_lists_;     ///< by block, wall and rule, a bonded one behind that beside it
  std::vector<std::size_t> wall_first_;  ///< first wall list of each block; blocks + 1
  Slices slices_;
  std::vector<Scratch> scratch_;  ///< one per thread
  std::vector<uint32_t> before_;  ///< old row of each row, when rows were removed; else empty
  bool built_ = false;
};

}  // namespace scree::core
