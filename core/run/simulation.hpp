#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/cycle/engine.hpp"
#include "core/plugin/catalogue.hpp"
#include "core/run/groups.hpp"
#include "core/scene/scene.hpp"

namespace scree::core {

/// How far the stages have come. An action that runs cycles keeps its own progress, so a resumed run goes on inside it.
struct Position {
  uint64_t stage = 0, action = 0;
  bool inside = false;       ///< a run, cycle or solve action has begun
  uint64_t start_cycle = 0;  ///< of that action
  double start_time = 0;
  std::vector<double> extreme;  ///< of each `until` with falls_to or rises_to: the largest or smallest seen
};

/// A scene brought to life: the engine and the names by which the scene speaks of it. Everything a checkpoint must hold
/// beside the scene itself is here or in the engine.
class Simulation {
 public:
  /// Sets up walls, balls, rules and processes; nothing has been computed yet. `restored`: leave out walls, balls and
  /// processes' state, a checkpoint brings them.
  Simulation(Scene scene, Catalogue& catalogue, unsigned threads, int isa);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  Scene scene;
  Catalogue& catalogue;
  Engine engine;
  Groups groups;
  Position position;
  std::vector<BallSet> ball_sets;  ///< the scene's and those added since
  std::vector<Use> wall_uses;      ///< what each of the engine's walls was made from, in the same order
  std::vector<Use> process_uses;   ///< the same of its processes, with what `set` changed
  std::vector<Rule>
      rules;  ///< the scene's rules as they are now: in order, with what `set` changed; index as in the book
  std::vector<uint16_t> precedence;  ///< indices into `rules`, first match first; a deleted rule is not in it
  std::function<void(const std::string&)> warn = [](const std::string&) {};
  std::function<void(const std::string&)> tell = [](const std::string&) {};

  /// Walls, balls, rules and processes of the scene, in that order.
  void set_up();
  /// Everything but running: add, set, delete, fix, free, apply, bond.
  void edit(const Action& action);
  /// Columns, step, tables: after set_up, edits, or a restore.
  void prepare();
  /// Every process looks up anew what it needs: the rest of `prepare`, also of a restore.
  void prepare_processes();

  // The steps of set_up, also used by `add` and by a restore.
  void add_wall(const WallUse& use);
  void add_balls(const BallSet& set);
  void add_process(const ProcessUse& use);
  void bind_rules();  ///< fills the engine's book from `rules`, groups and walls

  /// Rows of a group that fulfil a condition over x y z vx vy vz wx wy wz radius mass volume speed id; all of them
  /// without one.
  std::vector<uint8_t> select(const std::string& group, const Formula* where) const;
  /// One number of a ball by the name formulas use, as above.
  double ball_number(std::size_t row, const std::string& name) const;

 private:
  void fill_tables();
  void fill_pair(uint16_t a, uint16_t b, const std::vector<uint64_t>& count);
  void edit_add(const AddAction& action);
  void edit_set(const SetAction& action);
  void edit_delete(const DeleteAction& action);
  void edit_fix(const FixAction& action);
  void edit_apply(const ApplyAction& action);
  void edit_bond(const BondAction& action);
  void set_rule(const SetAction& action);
  void set_wall(const SetAction& action);
  void set_balls(const SetAction& action);
  Wall& wall(const std::string& name);
};

/// A plug-in's object made from a use: every setting handed over, then checked. Throws SceneErrors with the place.
std::shared_ptr<void> make_object(const scree_object& table, const Use& use, const std::string& what);
/// Hands one setting to an object. Throws SceneErrors with its place.
void set_object(const scree_object& table, void* object, const Setting& setting, const std::string& what);

}  // namespace scree::core
