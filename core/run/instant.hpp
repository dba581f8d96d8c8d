#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/cycle/engine.hpp"

namespace scree::core {

/// An active contact as it is read for output. Piece 1 has the lower id; against a wall it is the ball.
struct ActiveContact {
  uint64_t id1 = 0, id2 = 0;                ///< id2 is 0 for a wall
  uint32_t wall = 0, patch = 0;             ///< index of the wall and its patch; 0 between balls
  std::array<double, 3> normal{};           ///< from piece 1 to piece 2
  std::array<double, 3> point{};            ///< m
  double overlap = 0;                       ///< m, negative where the law runs across a gap
  std::array<double, 3> force{}, moment{};  ///< on piece 2, N, N m
  bool sliding = false, bonded = false;

  double normal_force() const;  ///< N, positive where the contact pushes
  double shear_force() const;   ///< N, at least 0
};

/// What can be read at time n beside plain columns: each part is computed once per cycle, and only when asked for. The
/// caller has run `engine.forces()`. Reading never changes the trajectory. [one thread]
class Instant {
 public:
  explicit Instant(Engine& engine) : engine_(engine) {}

  /// Call after an edit: what was read at this cycle no longer holds.
  void forget() { known_ = false; }
  /// Differs whenever what was read before no longer holds.
  uint64_t stamp();

  const Observation& observation();
  /// Active contacts of each row, with balls and walls.
  const std::vector<uint32_t>& contacts_of_balls();
  uint64_t between_balls();
  uint64_t with_walls();
  /// Largest overlap of all active contacts, as a share of the smaller radius.
  double overlap();
  /// All active contacts in the order of (id1, id2, wall, patch). Wants `engine.report_wanted` set before the forces.
  const std::vector<ActiveContact>& contacts();
  /// Rows in the order of ids.
  const std::vector<uint32_t>& order();
  /// no_row when no ball has this id.
  uint32_t row_of(uint64_t id);

 private:
  struct Moment {
    uint64_t cycle, updates, rebuilds, balls;
    double dt_back;
    bool operator==(const Moment&) const = default;
  };
  void refresh();
  void add_pairs(const TouchList& list);
  void add_walls(std::size_t list);

  Engine& engine_;
  Moment moment_{};
  bool known_ = false;
  uint64_t stamp_ = 0;
  bool observed_ = false, counted_ = false, sorted_ = false, listed_ = false, overlap_known_ = false;
  const Observation* seen_ = nullptr;
  double overlap_ = 0;
  std::vector<uint32_t> counts_, order_;
  std::vector<ActiveContact> contacts_;
  std::unordered_map<uint64_t, uint32_t> row_hint_;
};

}  // namespace scree::core
