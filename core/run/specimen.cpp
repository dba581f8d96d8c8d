#include <algorithm>

#include "core/run/ball_state.hpp"
#include "core/run/contact_state.hpp"
#include "core/run/engine_state.hpp"
#include "core/run/section_check.hpp"
#include "core/run/state.hpp"
#include "core/run/wall_state.hpp"
#include "core/run/word_state.hpp"

namespace scree::core {

namespace {

constexpr std::size_t fresh = static_cast<std::size_t>(-1);

// For each saved list the rule that goes on with it.
std::vector<std::size_t> heirs(const SavedContacts& saved, const RuleBook& book) {
  std::vector<std::size_t> heir(saved.rules.size(), fresh);
  for (std::size_t k = 0; k < book.rules.size(); ++k) {
    const BoundRule& rule = book.rules[k];
    if (rule.model == nullptr) continue;
    for (std::size_t old = 0; old < heir.size(); ++old)
      if (heir[old] == fresh && saved.rules[old] == rule.name && saved.models[old] == rule.model_name &&
          saved.state_names[old] == state_names(rule) && saved.lists[old].state.size() == rule.state_words()) {
        heir[old] = k;
        break;
      }
  }
  return heir;
}

// Properties are those of the new scene, so every contact gets them anew.
std::vector<WallList> carried(SavedContacts& saved, const std::vector<std::size_t>& heir,
                              const std::vector<std::size_t>& wall_index, const Engine& engine) {
  std::vector<WallList> lists;
  for (WallList& list : saved.wall_lists) {
    const std::size_t wall = wall_index[list.wall], rule = heir[list.rule];
    if (wall == no_wall || rule == fresh) continue;
    const BoundRule& law = engine.contacts.book.rules[rule];
    if (list.state.size() != list.slots.size() * law.memory_words(list.bonded)) continue;
    list.wall = static_cast<uint16_t>(wall);
    list.rule = static_cast<uint16_t>(rule);
    list.property.clear();
    // Right after balls were deleted the rows are still those of before, and births cannot be looked up.
    if (!law.varying.empty() && !saved.rows_before.empty()) continue;
    renew_wall_list(list, law, engine.balls, engine.walls[wall], engine.contacts.wall_breaks);
    lists.push_back(std::move(list));
  }
  return lists;
}

void carry_contacts(Engine& engine, const ArchiveReader& in, const std::vector<std::size_t>& wall_index) {
  PeriodicCell any_cell = engine.cell;
  for (bool& periodic : any_cell.periodic)
    periodic = true;  // the state may come from another cell; images are found anew
  SavedContacts saved = read_contacts(in, engine.balls, any_cell, wall_index.size());
  const std::vector<std::size_t> heir = heirs(saved, engine.contacts.book);
  for (const auto& [spot, count] : saved.wall_breaks)
    if (const std::size_t wall = wall_index[spot.wall]; wall != no_wall)
      engine.contacts.wall_breaks[{spot.id, static_cast<uint16_t>(wall), spot.patch}] = count;
  std::vector<WallList> wall_lists = carried(saved, heir, wall_index, engine);
  const std::size_t rules = engine.contacts.book.rules.size();
  std::vector<TouchList> lists(2 * rules);
  for (std::size_t k = 0; k < lists.size(); ++k) {
    lists[k].rule = static_cast<uint16_t>(k % rules);
    lists[k].bonded = k >= rules;
  }
  for (TouchList& list : saved.lists) {
    if (heir[list.rule] == fresh) continue;
    TouchList& to = lists[heir[list.rule] + (list.bonded ? rules : 0)];
    list.rule = to.rule;
    to = std::move(list);
    to.property.clear();
    to.stale = true;
  }
  engine.contacts.breaks = std::move(saved.breaks);
  engine.contacts.broken_bonds = saved.broken_bonds;
  engine.contacts.restore(std::move(lists), std::move(wall_lists), std::move(saved.rows_before), false,
                          engine.balls.size(), engine.team);
}

}  // namespace

void load_specimen(Simulation& simulation, const ArchiveReader& in) {
  Engine& engine = simulation.engine;
  load_groups(simulation, in);
  load_ball_sets(simulation, in);
  for (const WallUse& use : simulation.scene.walls) simulation.add_wall(use);
  const std::vector<std::size_t> wall_index = load_walls_by_name(engine.walls, in);
  load_balls(engine.balls, in, simulation.groups.size());
  simulation.bind_rules();
  carry_contacts(engine, in, wall_index);
  for (const BallSet& set : simulation.scene.balls) simulation.add_balls(set);
  for (const ProcessUse& use : simulation.scene.processes) simulation.add_process(use);
  Clock& clock = engine.clock;
  load_clock(clock, in);
  clock.base_time = clock.time();
  clock.base_cycle = clock.cycle;
  clock.dt = 0;
  // What laws integrate over the last drift is in their state already if they were evaluated after it.
  if (in.has("forces")) clock.dt_law = 0;
  simulation.prepare();
}

}  // namespace scree::core
