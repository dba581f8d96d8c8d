#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/contact/rule.hpp"
#include "core/contact/scratch.hpp"
#include "core/contact/slices.hpp"
#include "core/contact/stages.hpp"
#include "core/contact/touch_list.hpp"
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

/// What one evaluation of all contacts is asked to do beside forces.
struct PassOptions {
  double dt = 0;               ///< of the drift that led here, s
  double overlap_limit = 0.5;  ///< of the smaller radius
  bool sums = false;           ///< also the sum of contact force sizes per ball
  uint64_t cycle = 0;          ///< for the note of a crash
  bool report = false;         ///< also force, moment and sliding flag per contact
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

  std::vector<TouchList>& lists() { return lists_; }
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
  std::size_t bytes() const;
  uint64_t active() const;  ///< ball-ball contacts whose law runs
  uint64_t listed() const;  ///< pairs in lists, touching or not

 private:
  Excess run_block(std::size_t block, const Balls& balls, const std::vector<Wall>& walls, const double (*shift)[3],
                   const PassOptions& options, Scratch& scratch);
  Excess run_list(std::size_t block, std::size_t rule, const Balls& balls, const double (*shift)[3],
                  const PassOptions& options, Scratch& scratch);
  void rebuild_wall_lists(const Balls& balls, const std::vector<Wall>& walls, const std::vector<uint32_t>& new_row,
                          double skin, Team& team);
  void give_wall_slots(const std::vector<WallList>& old, const std::vector<uint32_t>& new_row);
  std::vector<TouchList> lists_;         ///< one per rule
  std::vector<WallList> wall_lists_;     ///< by block, wall and rule
  std::vector<std::size_t> wall_first_;  ///< first wall list of each block; blocks + 1
  Slices slices_;
  std::vector<Scratch> scratch_;  ///< one per thread
  std::vector<uint32_t> before_;  ///< old row of each row, when rows were removed; else empty
  bool built_ = false;
};

}  // namespace scree::core
