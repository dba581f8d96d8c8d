#include <algorithm>

#include "core/run/rule_binding.hpp"
#include "core/run/simulation.hpp"

// The actions of a stage that change the scene between cycles. After each the scene is prepared again.

namespace scree::core {

namespace {

std::size_t find_rule(const std::vector<Rule>& rules, const std::vector<uint16_t>& precedence,
                      const std::string& name) {
  for (uint16_t index : precedence)
    if (rules[index].name == name) return index;
  throw Refusal(Exit::scene, "there is no rule '" + name + "' now");
}

template <class T>
void put_setting(std::vector<T>& settings, const T& setting) {
  const auto same = [&](const T& other) { return other.name == setting.name; };
  const auto at = std::find_if(settings.begin(), settings.end(), same);
  if (at == settings.end())
    settings.push_back(setting);
  else
    *at = setting;
}

/// Which pieces lie on each side of an action.
using Sides = std::array<std::vector<uint8_t>, 2>;

bool across(const Sides& of_a, uint16_t a, const Sides& of_b, uint16_t b) {
  return (of_a[0][a] != 0 && of_b[1][b] != 0) || (of_a[1][a] != 0 && of_b[0][b] != 0);
}

Triple triple(const Value& value) {
  Triple out{};
  for (std::size_t k = 0; k < 3 && k < value.numbers.size(); ++k) out[k] = value.numbers[k];
  return out;
}

}  // namespace

void Simulation::edit(const Action& action) {
  engine.before_edit();
  if (const auto* add = std::get_if<AddAction>(&action.what)) edit_add(*add);
  if (const auto* set = std::get_if<SetAction>(&action.what)) edit_set(*set);
  if (const auto* remove = std::get_if<DeleteAction>(&action.what)) edit_delete(*remove);
  if (const auto* fix = std::get_if<FixAction>(&action.what)) edit_fix(*fix);
  if (const auto* apply = std::get_if<ApplyAction>(&action.what)) edit_apply(*apply);
  if (const auto* bond = std::get_if<BondAction>(&action.what)) edit_bond(*bond);
  prepare();
}

void Simulation::edit_add(const AddAction& action) {
  engine.synchronize();
  for (const WallUse& use : action.walls) add_wall(use);
  for (const BallSet& set : action.balls) add_balls(set);
  // An added rule goes before the earlier ones: otherwise it could not change what a pair does.
  std::vector<uint16_t> first;
  for (const Rule& rule : action.contacts) {
    first.push_back(static_cast<uint16_t>(rules.size()));
    rules.push_back(rule);
  }
  precedence.insert(precedence.begin(), first.begin(), first.end());
  for (const ProcessUse& use : action.processes) add_process(use);
  engine.contacts.drop_lists();
}

void Simulation::edit_set(const SetAction& action) {
  switch (action.target) {
    case SetAction::Target::rule:
      return set_rule(action);
    case SetAction::Target::wall:
    case SetAction::Target::wall_contact:
      return set_wall(action);
    case SetAction::Target::balls:
      return set_balls(action);
    case SetAction::Target::process:
      for (std::size_t k = 0; k < engine.processes.size(); ++k) {
        Process& process = engine.processes[k];
        if (process.name != action.name) continue;
        set_object(process.table->object, process.object.get(), action.setting, "process '" + action.name + "'");
        return put_setting(process_uses[k].settings, action.setting);
      }
      throw Refusal(Exit::scene, "there is no process '" + action.name + "' now");
    case SetAction::Target::timestep: {
      const double step = action.setting.value.numbers.at(0);
      engine.step.fixed = step > 0 ? std::optional<double>(step) : std::nullopt;
      engine.step.accurate = step < 0;
      engine.step_place = action.setting.place.text();
      engine.clock.change_step(step > 0 ? step : engine.clock.dt);
    }
  }
}

void Simulation::set_rule(const SetAction& action) {
  const std::size_t index = find_rule(rules, precedence, action.name);
  put_setting(rules[index].model.settings, action.setting);
  const bool was_normal = engine.contacts.book.rules[index].normal_only();
  bind_rules();
  engine.forces_outdated();
  engine.contacts.renew(index, engine.balls, engine.walls);
  if (was_normal != engine.contacts.book.rules[index].normal_only()) engine.contacts.drop_lists();
}

void Simulation::set_wall(const SetAction& action) {
  Wall& target = wall(action.name);
  if (action.target == SetAction::Target::wall_contact) {
    target.contact[action.key] = action.setting.value.numbers.at(0);
    bind_rules();
    engine.forces_outdated();
    for (std::size_t rule = 0; rule < rules.size(); ++rule) engine.contacts.renew(rule, engine.balls, engine.walls);
    return;
  }
  const Triple value = triple(action.setting.value);
  if (action.key == "velocity") target.velocity = value;
  if (action.key == "spin") target.spin = value;
  if (action.key != "position") return;
  target.centre = value;
  engine.forces_outdated();
  engine.contacts.drop_lists();
}

void Simulation::set_balls(const SetAction& action) {
  engine.synchronize();
  const Triple value = triple(action.setting.value);
  const bool spin = action.key == "spin";
  const Column first = spin ? Column::wx : Column::vx;
  const auto chosen = select(action.name, nullptr);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto column = static_cast<Column>(static_cast<std::size_t>(first) + axis);
    engine.balls.require(column, "a spin was set");
    for (std::size_t row = 0; row < chosen.size(); ++row)
      if (chosen[row]) engine.balls[column][row] = value[axis];
  }
}

void Simulation::edit_delete(const DeleteAction& action) {
  engine.synchronize();
  const std::string& name = action.name.text;
  if (action.what == "walls") {
    const auto index = static_cast<std::size_t>(&wall(name) - engine.walls.data());
    engine.walls.erase(engine.walls.begin() + static_cast<std::ptrdiff_t>(index));
    wall_uses.erase(wall_uses.begin() + static_cast<std::ptrdiff_t>(index));
    engine.contacts.wall_gone(index);
  } else if (action.what == "processes") {
    for (std::size_t k = engine.processes.size(); k-- > 0;) {
      if (engine.processes[k].name != name) continue;
      engine.processes.erase(engine.processes.begin() + static_cast<std::ptrdiff_t>(k));
      process_uses.erase(process_uses.begin() + static_cast<std::ptrdiff_t>(k));
    }
  } else if (action.what == "contacts") {
    const std::size_t index = find_rule(rules, precedence, name);
    std::erase(precedence, static_cast<uint16_t>(index));
    engine.contacts.drop_bonds(index);
  } else {
    std::vector<uint8_t> keep = select(name, action.where.get());
    for (uint8_t& flag : keep) flag = !flag;
    engine.balls.keep(keep);
    engine.contacts.rows_kept(keep);
  }
}

void Simulation::edit_fix(const FixAction& action) {
  engine.synchronize();
  uint8_t bits = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (action.velocity[axis]) bits = static_cast<uint8_t>(bits | (1u << axis));
    if (action.spin[axis]) bits = static_cast<uint8_t>(bits | (8u << axis));
  }
  const auto chosen = select(action.balls.text, action.where.get());
  uint8_t* fixed = engine.balls.require_fixed();
  for (std::size_t row = 0; row < chosen.size(); ++row)
    if (chosen[row]) fixed[row] = static_cast<uint8_t>(action.fix ? fixed[row] | bits : fixed[row] & ~bits);
}

void Simulation::edit_bond(const BondAction& action) {
  BondOrder order{static_cast<uint16_t>(find_rule(rules, precedence, action.rule.text)), action.gap, action.again, {}};
  if (!action.between[0].empty()) {
    Sides group, wall;
    bool walls = false;
    for (std::size_t k = 0; k < 2; ++k) {
      group[k].assign(groups.size(), 0);
      wall[k].assign(engine.walls.size(), 0);
      for (const Name& name : action.between[k]) {
        const std::vector<uint8_t> covered = groups.cover(name.text);
        for (std::size_t leaf = 0; leaf < covered.size(); ++leaf) group[k][leaf] |= covered[leaf];
        for (std::size_t w = 0; w < engine.walls.size(); ++w)
          wall[k][w] |= name.text == "walls" || name.text == engine.walls[w].name;
        walls = walls || std::find(wall[k].begin(), wall[k].end(), 1) != wall[k].end();
      }
    }
    order.chosen = [group](uint16_t a, uint16_t b) { return across(group, a, group, b); };
    if (walls) order.chosen_walls = [group, wall](uint16_t a, uint16_t w) { return across(group, a, wall, w); };
  }
  const uint64_t made = engine.bond(order, true);
  tell("bonded " + std::to_string(made) + " pairs under rule '" + action.rule.text + "'");
  if (made == 0)
    warn(action.rule.place.text() + ": warning: no pair under rule '" + action.rule.text +
         "' is near enough to be bonded: check 'gap'");
}

void Simulation::edit_apply(const ApplyAction& action) {
  const auto chosen = select(action.balls.text, action.where.get());
  const auto put = [&](Column first, const Triple& value) {
    const bool any = value[0] != 0 || value[1] != 0 || value[2] != 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto column = static_cast<Column>(static_cast<std::size_t>(first) + axis);
      if (any) engine.balls.require(column, "an action applied it");
      for (std::size_t row = 0; engine.balls.has(column) && row < chosen.size(); ++row)
        if (chosen[row]) engine.balls[column][row] = value[axis];
    }
  };
  put(Column::force_x, action.force);
  put(Column::moment_x, action.moment);
}

}  // namespace scree::core
