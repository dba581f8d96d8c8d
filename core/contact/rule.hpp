#pragma once
#include <scree/abi.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/base/array.hpp"
#include "core/world/wall.hpp"

namespace scree::core {

constexpr uint32_t no_row = std::numeric_limits<uint32_t>::max();
constexpr uint16_t no_rule = std::numeric_limits<uint16_t>::max();

/// The pieces of a contact that is being born. Piece 1 has the lower id; against a wall it is the ball.
struct Birth {
  uint32_t row1 = no_row, row2 = no_row;  ///< row2 is no_row for a wall
  const Wall* wall = nullptr;
  double r1 = 0, r2 = 0, mass = 0;  ///< m, m (0: flat wall), effective kg
  double x = 0, y = 0, z = 0;       ///< contact point, m
  uint32_t patch = 0;               ///< of the wall
  uint64_t bonding = 0;             ///< how many bonds this pair had before the one it has, or had last
};

/// Which law, with which properties. Uniform properties are held once; those that vary have one value per contact.
struct BoundRule {
  std::string name;
  const scree_contact_model* model = nullptr;  ///< null: these pairs do not interact
  std::string model_name;
  std::vector<double> words;      ///< the law's struct; varying words hold a representative value
  std::vector<uint32_t> varying;  ///< words with a value per contact, ascending
  /// Fills all words of a new contact; empty when nothing varies. [any thread]
  std::function<void(const Birth&, double* words)> vary;
  /// They vary with more than the groups, radii and masses of the pieces: drawn, by place, or given ball by ball.
  bool drawn = false;
  double reach = 0;                ///< largest gap at which the law runs, m
  uint32_t needs = 0;              ///< flags of the law, or SCREE_NORMAL_ONLY
  scree_law law = nullptr;         ///< chosen for the instruction set and for uniform or varying properties
  scree_law energy_law = nullptr;  ///< the same that also fills the energies; null: the model has none
  scree_law bonded_law = nullptr;  ///< of bonded pairs, fills energies when asked; null: the model has no bond
  Array<double> constants;         ///< SCREE_BATCH copies of every word: what a law reads where a word does not vary

  bool normal_only() const { return (needs & SCREE_NORMAL_ONLY) != 0; }
  bool can_bond() const { return model != nullptr && (model->flags & SCREE_CAN_BOND) != 0; }
  uint32_t state_words() const { return model == nullptr || normal_only() ? 0 : model->state_words; }
  /// What a contact in one of the rule's two lists remembers: the words of State, then those of Bond.
  uint32_t memory_words(bool bonded) const { return state_words() + (bonded ? model->bond_words : 0); }
  /// Call after words, varying or needs changed.
  void refresh(int isa);
};

/// All rules and the tables that say which pair has which. The first rule that fits wins; tables are filled at set-up.
class RuleBook {
 public:
  std::vector<BoundRule> rules;

  void resize(std::size_t groups, std::size_t walls);
  void set_balls(uint16_t a, uint16_t b, uint16_t rule);
  void set_wall(uint16_t group, uint16_t wall, uint16_t rule);
  uint16_t balls(uint16_t a, uint16_t b) const { return balls_[static_cast<std::size_t>(a) * groups_ + b]; }
  uint16_t wall(uint16_t group, uint16_t wall) const {
    return walls_[static_cast<std::size_t>(group) * wall_count_ + wall];
  }
  std::size_t groups() const { return groups_; }
  std::size_t walls() const { return wall_count_; }

  double reach() const;  ///< largest over rules, m
  bool spins() const;    ///< some rule has a tangential part
 private:
  std::size_t groups_ = 0, wall_count_ = 0;
  std::vector<uint16_t> balls_, walls_;
};

}  // namespace scree::core
