#include "core/run/quantities.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/nearest.hpp"
#include "core/run/ball_reduction.hpp"
#include "core/run/piece_quantities.hpp"

namespace scree::core {

namespace {

/// The base of `NAME.peak` or `NAME.least`, else "".
std::string extreme_base(const std::string& name, bool& peak) {
  peak = name.ends_with(".peak");
  if (!peak && !name.ends_with(".least")) return "";
  return name.substr(0, name.rfind('.'));
}

double further(double seen, double now, bool peak) {
  if (std::isnan(seen) || std::isnan(now)) return std::isnan(seen) ? now : seen;
  return (peak ? now > seen : now < seen) ? now : seen;
}

template <class Act>
void each_addition(const Scene& scene, Act act) {
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* more = std::get_if<AddAction>(&action.what)) act(*more);
}

}  // namespace

Quantities::Quantities(Simulation& simulation) : simulation_(simulation), instant_(simulation.engine) {
  for (const Quantity& quantity : simulation.scene.quantities) own_.emplace(quantity.name, Own{&quantity});
}

const Published* Quantities::published(const std::string& name) {
  const auto known = published_.find(name);
  if (known != published_.end()) return &known->second;
  auto found = find_published(name, simulation_, instant_);
  return found ? &published_.emplace(name, std::move(*found)).first->second : nullptr;
}

Quantities::Extreme* Quantities::extreme(const std::string& name) {
  const auto known = extremes_.find(name);
  if (known != extremes_.end()) return &known->second;
  bool peak = false;
  const std::string base = extreme_base(name, peak);
  if (base.empty() || !knows(base)) return nullptr;
  return &extremes_.emplace(name, Extreme{base, peak, std::nan("")}).first->second;
}

bool Quantities::knows(const std::string& name) {
  return own_.contains(name) || published(name) != nullptr || extreme(name) != nullptr;
}

double Quantities::own_value(Own& own) {
  const uint64_t stamp = instant_.stamp();
  if (own.stamp == stamp) return own.value;
  const Quantity& quantity = *own.quantity;
  if (own.open)
    throw Refusal(Exit::scene, quantity.place.text() + ": error: quantity '" + quantity.name + "' depends on itself");
  own.open = true;
  try {
    own.value = quantity.formula ? value(*quantity.formula) : reduced(quantity, simulation_, instant_);
  } catch (...) {
    own.open = false;
    throw;
  }
  own.open = false;
  own.stamp = stamp;
  return own.value;
}

double Quantities::value(const std::string& name) {
  const auto own = own_.find(name);
  if (own != own_.end()) return own_value(own->second);
  if (const Published* found = published(name)) return found->read();
  if (const Extreme* found = extreme(name)) return further(found->seen, value(found->of), found->peak);
  if (process_comes()) return std::nan("");
  throw Refusal(Exit::scene, "nothing publishes the quantity '" + name + "' at cycle " +
                                 std::to_string(simulation_.engine.clock.cycle) + ": check its name");
}

double Quantities::value(const Formula& formula) {
  std::vector<double> values;
  for (const std::string& name : formula.names()) values.push_back(value(name));
  return formula.evaluate(values);
}

std::string Quantities::unit(const std::string& name) {
  if (own_.contains(name)) return "";
  if (const Published* found = published(name)) return found->unit;
  const Extreme* found = extreme(name);
  return found != nullptr ? unit(found->of) : "";
}

std::string Quantities::unit(const Formula& formula) {
  const auto& names = formula.names();
  return names.size() == 1 && names[0] == formula.text() ? unit(names[0]) : "";
}

Needs Quantities::needs(const std::string& name) {
  const auto own = own_.find(name);
  if (own != own_.end()) {
    const Quantity& quantity = *own->second.quantity;
    return quantity.formula ? needs(*quantity.formula) : Needs{false, false, true};
  }
  if (const Published* found = published(name)) return found->needs;
  const Extreme* found = extreme(name);
  return found != nullptr ? needs(found->of) : Needs{};
}

Needs Quantities::needs(const Formula& formula) {
  Needs sum;
  for (const std::string& name : formula.names()) sum |= needs(name);
  return sum;
}

std::vector<std::string> Quantities::names(const std::string& like) const {
  std::vector<std::string> names = published_names(simulation_, like);
  for (const auto& [name, own] : own_) names.push_back(name);
  return names;
}

/// A wall or ball that an action adds in time is no mistake.
bool Quantities::piece_comes(const std::string& name) const {
  const std::string wall = wall_of_quantity(name);
  bool later = false;
  each_addition(simulation_.scene, [&](const AddAction& more) {
    for (const WallUse& use : more.walls) later = later || use.name == wall;
    later = later || (wall.empty() && !more.balls.empty());
  });
  return later;
}

/// What a process publishes is known once the process is there.
bool Quantities::process_comes() const {
  bool later = false;
  each_addition(simulation_.scene, [&](const AddAction& more) { later = later || !more.processes.empty(); });
  return later;
}

void Quantities::check_name(const std::string& name, const Place& place, Report& report) {
  bool peak = false;
  const std::string base = own_.contains(name) || published(name) != nullptr ? "" : extreme_base(name, peak);
  if (!base.empty()) {
    check_name(base, place, report);
    extreme(name);
    return;
  }
  if (own_.contains(name)) return;
  if (published(name) == nullptr) {
    if (process_comes()) return;
    const std::string near = nearest_name(name, names(name));
    return report.error(place,
                        "unknown quantity '" + name + "'" +
                            (near.empty() ? "; `quantities:` defines your own" : "; did you mean '" + near + "'?"));
  }
  if (piece_comes(name)) return;
  const std::string wall = wall_of_quantity(name);
  const auto& walls = simulation_.engine.walls;
  if (!wall.empty() && std::none_of(walls.begin(), walls.end(), [&](const Wall& w) { return w.name == wall; })) {
    std::vector<std::string> there;
    for (const Wall& one : walls) there.push_back(one.name);
    const std::string near = nearest_name(wall, there);
    report.error(place,
                 "'" + name + "': no wall '" + wall + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  for (const uint64_t id : balls_of_quantity(name))
    if (instant_.row_of(id) == no_row)
      report.error(place, "'" + name + "': no ball has the id " + std::to_string(id) + "; there are " +
                              std::to_string(simulation_.engine.balls.size()) + " balls, the largest id is " +
                              std::to_string(simulation_.engine.balls.next_id - 1));
}

void Quantities::check(const Formula& formula, Report& report) {
  for (const std::string& name : formula.names()) check_name(name, formula.place(), report);
}

void Quantities::check(const Quantity& quantity, Report& report) {
  if (quantity.formula) return check(*quantity.formula, report);
  bool later = false;
  each_addition(simulation_.scene, [&](const AddAction& more) { later = later || !more.balls.empty(); });
  if (later || quantity.over == "balls" || simulation_.groups.knows(quantity.over)) return;
  const std::string near = nearest_name(quantity.over, simulation_.groups.leaves());
  report.error(quantity.place, "quantity '" + quantity.name + "': no balls belong to '" + quantity.over + "'" +
                                   (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

void Quantities::check(const Formula& formula) {
  Report report;
  check(formula, report);
  report.raise();
}

void Quantities::check_scene() {
  const Scene& scene = simulation_.scene;
  Report report;
  for (const Quantity& quantity : scene.quantities) check(quantity, report);
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* run = std::get_if<RunAction>(&action.what))
        for (const Until& until : run->until) check(*until.quantity, report);
  for (const Record& record : scene.record)
    for (const auto& formula : record.quantities) check(*formula, report);
  for (const Expect& expect : scene.expect) check(*expect.quantity, report);
  report.raise();
  // Circles through an extreme are beyond what the reader of the scene sees.
  for (const Quantity& quantity : scene.quantities) {
    std::set<std::string> seen;
    std::vector<std::string> open{quantity.name};
    while (!open.empty()) {
      std::string name = open.back();
      open.pop_back();
      bool peak = false;
      const std::string base = own_.contains(name) ? "" : extreme_base(name, peak);
      const auto own = own_.find(base.empty() ? name : base);
      if (own == own_.end() || !own->second.quantity->formula) continue;
      for (const std::string& next : own->second.quantity->formula->names()) {
        const std::string reached = own_.contains(next) ? next : extreme_base(next, peak);
        if (reached == quantity.name)
          throw SceneErrors({quantity.place.text() + ": error: quantity '" + quantity.name + "' depends on itself"});
        if (seen.insert(next).second) open.push_back(next);
      }
    }
  }
}

Needs Quantities::following(uint64_t cycle) const {
  Needs sum;
  for (const auto& [name, extreme] : extremes_) {
    const Needs needs = const_cast<Quantities*>(this)->needs(extreme.of);
    if (!needs.pass || cycle % follow_every == 0) sum |= needs;
  }
  return sum;
}

void Quantities::follow() {
  const uint64_t cycle = simulation_.engine.clock.cycle;
  for (auto& [name, extreme] : extremes_)
    if (!needs(extreme.of).pass || cycle % follow_every == 0)
      extreme.seen = further(extreme.seen, value(extreme.of), extreme.peak);
}

void Quantities::save(ArchiveWriter& archive, const std::string& prefix) const {
  std::vector<std::string> names;
  std::vector<double> seen;
  for (const auto& [name, extreme] : extremes_) {
    names.push_back(name);
    seen.push_back(extreme.seen);
  }
  archive.put_texts(prefix + "/extremes", names);
  archive.put(prefix + "/extremes.seen", seen);
}

void Quantities::load(const ArchiveReader& archive, const std::string& prefix) {
  const std::vector<std::string> names = archive.get_texts(prefix + "/extremes");
  const std::vector<double> seen = archive.get<double>(prefix + "/extremes.seen", names.size());
  for (std::size_t k = 0; k < names.size(); ++k)
    if (Extreme* found = extreme(names[k])) found->seen = seen[k];
}

}  // namespace scree::core
