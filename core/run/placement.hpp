#pragma once
#include <scree/abi.h>

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/base/philox.hpp"
#include "core/run/simulation.hpp"

namespace scree::core {

/// Receives the balls of one set from a generator and puts them into the simulation. [one thread]
class Placement {
 public:
  Placement(Simulation& simulation, const BallSet& set);
  scree_sink sink();
  std::size_t placed() const { return placed_; }
  /// Why a ball was refused, "" if none was.
  const std::string& refusal() const { return refusal_; }

 private:
  static int ball(void* self, const scree_ball* ball);
  static int try_ball(void* self, const scree_ball* ball);
  static void warn(void* self, const char* message);
  std::string wrong(const scree_ball& ball);
  bool in_use(uint64_t id);
  bool free_of_others(const scree_ball& ball);
  bool free_of_walls(const scree_ball& ball) const;
  bool inside_cell(const scree_ball& ball) const;
  void add(const scree_ball& ball);
  void index(std::size_t row);
  void reindex(double edge);
  uint64_t key(const double position[3], const int64_t offset[3]) const;

  Simulation& simulation_;
  const BallSet& set_;
  Random random_;
  scree_random random_table_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
  std::unordered_set<uint64_t> ids_;  ///< in use; filled once an id comes that is not above all others
  std::unordered_map<std::string, uint16_t> leaves_;
  double edge_ = 0;
  std::size_t indexed_ = 0, placed_ = 0;
  std::string refusal_;
  uint8_t periodic_[3];
};

}  // namespace scree::core
