#include "core/run/target_check.hpp"

#include <algorithm>

#include "core/base/nearest.hpp"
#include "core/scene/report.hpp"

namespace scree::core {

namespace {

/// What an action says of balls; empty when it names none.
Name balls_named(const Action& action) {
  if (const auto* set = std::get_if<SetAction>(&action.what))
    return set->target == SetAction::Target::balls ? Name{set->name, action.place} : Name{};
  if (const auto* gone = std::get_if<DeleteAction>(&action.what)) return gone->what == "balls" ? gone->name : Name{};
  if (const auto* fix = std::get_if<FixAction>(&action.what)) return fix->balls;
  if (const auto* apply = std::get_if<ApplyAction>(&action.what)) return apply->balls;
  return {};
}

bool added_later(const Scene& scene, const std::string& group) {
  const std::string set = group.substr(0, group.find('.'));
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* more = std::get_if<AddAction>(&action.what))
        if (std::any_of(more->balls.begin(), more->balls.end(), [&](const BallSet& one) { return one.name == set; }))
          return true;
  return false;
}

}  // namespace

void targets_exist(const Simulation& simulation) {
  Report report;
  for (const Stage& stage : simulation.scene.stages)
    for (const Action& action : stage.actions) {
      const Name name = balls_named(action);
      if (name.text.empty() || name.text == "balls" || simulation.groups.knows(name.text) ||
          added_later(simulation.scene, name.text))
        continue;
      const std::string near = nearest_name(name.text, simulation.groups.leaves());
      report.error(name.place,
                   "no balls belong to '" + name.text + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
  report.raise();
}

}  // namespace scree::core
