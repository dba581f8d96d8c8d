#include "core/scene/check.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>

#include "core/scene/numbers.hpp"
#include "core/scene/pairs.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

template <class Entry>
void insert_named(std::map<std::string, const Entry*>& map, const Entry& entry, const std::string& what,
                  Context& context) {
  const auto [there, fresh] = map.emplace(entry.name, &entry);
  if (!fresh)
    context.report.error(entry.place, what + " '" + entry.name + "' exists already, from " +
                                          there->second->place.text() + ": delete it first, or choose another name");
}

std::vector<std::string> names_of(const auto& map) {
  std::vector<std::string> names;
  for (const auto& [name, entry] : map) names.push_back(name);
  return names;
}

/// Follows the scene through its stages and looks at every name where it is used.
class Checker {
 public:
  Checker(Scene& scene, Context& context) : scene_(scene), context_(context), open_(scene.start_state.has_value()) {}

  void check() {
    for (const WallUse& wall : scene_.walls) add(wall);
    for (const BallSet& set : scene_.balls) add(set);
    for (const Rule& rule : scene_.contacts) add(rule);
    for (const ProcessUse& process : scene_.processes) insert_named(live_.processes, process, "process", context_);
    check_empty();
    rules_know_their_names();
    pairs_have_rules(live_, open_, context_);
    rules_in_use(live_, open_, used_rules_);
    for (Stage& stage : scene_.stages) visit(stage);
    warn_shadowed();
    check_quantities();
    duplicates(scene_.stages, "stage");
    duplicates(scene_.record, "record");
    pieces_meet_laws(scene_, open_, context_);
  }

 private:
  void error(const Place& place, const std::string& message) { context_.report.error(place, message); }

  void add(const WallUse& wall) {
    insert_named(live_.walls, wall, "wall", context_);
    ever_walls_.insert(wall.name);
    reserved(wall.name, wall.place);
    if (live_.balls.contains(wall.name))
      error(wall.place, "'" + wall.name + "' is a ball set too: rules could not tell them apart");
  }
  void add(const BallSet& set) {
    insert_named(live_.balls, set, "ball set", context_);
    ever_balls_.insert(set.name);
    reserved(set.name, set.place);
    if (live_.walls.contains(set.name))
      error(set.place, "'" + set.name + "' is a wall too: rules could not tell them apart");
  }
  void add(const Rule& rule) {
    const auto [there, fresh] = rule_places_.emplace(rule.name, rule.place);
    if (!fresh)
      error(rule.place,
            "rule '" + rule.name + "' exists already, from " + there->second.text() + ": choose another name");
    live_.rules.push_back(&rule);
    new_rules_.push_back(&rule);
  }

  void reserved(const std::string& name, const Place& place) {
    if (name == "balls" || name == "walls") error(place, "'" + name + "' means all of them: choose another name");
  }

  void check_empty() {
    const bool adds = std::any_of(scene_.stages.begin(), scene_.stages.end(), [](const Stage& stage) {
      return std::any_of(stage.actions.begin(), stage.actions.end(), [](const Action& action) {
        const auto* more = std::get_if<AddAction>(&action.what);
        return more && (!more->balls.empty() || !more->walls.empty());
      });
    });
    if (live_.walls.empty() && live_.balls.empty() && !open_ && !adds && context_.report.clean())
      error({scene_.file.empty() ? "scene" : scene_.file, 0, 0},
            "the scene has neither balls nor walls: add an entry under 'balls:' or 'walls:', or begin from a saved "
            "state with 'start: {state: ...}'");
  }

  /// Rules may be written before the pieces they name are added, so names of the whole scene count.
  void rules_know_their_names() {
    if (open_) return;
    std::set<std::string> walls = ever_walls_, balls = ever_balls_;
    for (const Stage& stage : scene_.stages)
      for (const Action& action : stage.actions)
        if (const auto* more = std::get_if<AddAction>(&action.what)) {
          for (const WallUse& wall : more->walls) walls.insert(wall.name);
          for (const BallSet& set : more->balls) balls.insert(set.name);
        }
    for (const Rule* rule : new_rules_) check_sides(*rule, walls, balls);
    new_rules_.clear();
  }

  void check_sides(const Rule& rule, const std::set<std::string>& walls, const std::set<std::string>& balls) {
    std::vector<std::string> candidates(balls.begin(), balls.end());
    candidates.insert(candidates.end(), walls.begin(), walls.end());
    candidates.insert(candidates.end(), {"balls", "walls"});
    bool known = true, any_ball = false;
    for (const auto& side : rule.between) {
      for (const std::string& name : side) {
        const bool ball = name == "balls" || balls.contains(set_of(name));
        const bool wall = name == "walls" || walls.contains(name);
        any_ball = any_ball || ball;
        if (ball || wall) continue;
        known = false;
        context_.rules_doubtful = true;
        error(rule.place, "rule '" + rule.name + "' names '" + name + "', which is neither a ball set nor a wall" +
                              suggestion(name, candidates));
      }
    }
    if (known && !any_ball && !rule.between[0].empty())
      error(rule.place,
            "rule '" + rule.name + "' is between walls only, which do not interact: name balls on one side");
  }

  void visit(Stage& stage) {
    for (Action& action : stage.actions) std::visit([&](auto& what) { apply(what, action.place); }, action.what);
  }

  void apply(const AddAction& more, const Place&) {
    for (const WallUse& wall : more.walls) add(wall);
    for (const BallSet& set : more.balls) add(set);
    const std::size_t before = live_.rules.size();
    for (const Rule& rule : more.contacts) add(rule);
    // An added rule goes before the earlier ones, as in the run.
    std::rotate(live_.rules.begin(), live_.rules.begin() + static_cast<std::ptrdiff_t>(before), live_.rules.end());
    for (const ProcessUse& process : more.processes) insert_named(live_.processes, process, "process", context_);
    rules_know_their_names();
    pairs_have_rules(live_, open_, context_);
    rules_in_use(live_, open_, used_rules_);
  }

  void apply(const DeleteAction& gone, const Place&) {
    const std::string& name = gone.name.text;
    if (gone.what == "walls") {
      if (wants_wall(gone.name)) live_.walls.erase(name);
    } else if (gone.what == "balls") {
      if (wants_balls(gone.name) && !gone.where) live_.balls.erase(name);
      if (name == "balls" && !gone.where) live_.balls.clear();
    } else if (gone.what == "processes") {
      if (live_.processes.erase(name) == 0) missing("process", gone.name, names_of(live_.processes));
    } else {
      const auto there =
          std::find_if(live_.rules.begin(), live_.rules.end(), [&](const Rule* rule) { return rule->name == name; });
      if (there == live_.rules.end()) return missing("rule", gone.name, rule_names());
      live_.rules.erase(there);
      rule_places_.erase(name);
      pairs_have_rules(live_, open_, context_);
      rules_in_use(live_, open_, used_rules_);
    }
  }

  void apply(const SetAction& set, const Place& place) {
    const Name name{set.name, place};
    if (set.target == SetAction::Target::wall || set.target == SetAction::Target::wall_contact) wants_wall(name);
    if (set.target == SetAction::Target::balls) wants_balls(name);
    if (set.target == SetAction::Target::process && !live_.processes.contains(set.name))
      missing("process", name, names_of(live_.processes));
    if (set.target == SetAction::Target::rule) {
      const std::vector<std::string> names = rule_names();
      if (std::find(names.begin(), names.end(), set.name) == names.end()) missing("rule", name, names);
    }
  }
  void apply(const FixAction& fix, const Place&) { wants_balls(fix.balls); }
  void apply(const ApplyAction& force, const Place&) { wants_balls(force.balls); }
  void apply(const BondAction& bond, const Place&) {
    const auto rule = std::find_if(live_.rules.begin(), live_.rules.end(),
                                   [&](const Rule* one) { return one->name == bond.rule.text; });
    if (rule == live_.rules.end()) return missing("rule", bond.rule, rule_names());
    bool known = true;
    for (const auto& side : bond.between)
      for (const Name& name : side) known = wants_piece(name) && known;
    const Component* model = (*rule)->none ? nullptr : (*rule)->model.component;
    if (model == nullptr || (model->contact_model().flags & SCREE_CAN_BOND) == 0)
      error(bond.rule.place, "rule '" + bond.rule.text + "' has " +
                                 (model == nullptr ? "no contact model" : "contact model '" + model->name + "'") +
                                 ", which makes no bonds: use contact_bond or parallel_bond");
    else if (known && !bond.between[0].empty() && !sides_meet(**rule, bond.between))
      error(bond.rule.place,
            "the sides of 'between' never meet under rule '" + bond.rule.text + "': name pieces that it is between");
  }

  bool is_wall(const std::string& name) const { return name == "walls" || ever_walls_.contains(name); }

  /// Whether one of the pieces of a bond may lie on each side of the rule. Walls never meet each other.
  bool sides_meet(const Rule& rule, const std::array<std::vector<Name>, 2>& sides) const {
    const auto within = [&](const std::string& a, const std::string& b) {
      return a == b || (b == "balls" && !is_wall(a)) || (b == "walls" && is_wall(a)) || a.starts_with(b + ".");
    };
    const auto meets = [&](const Name& a, const Name& b, const std::string& one, const std::string& other) {
      return !(is_wall(a.text) && is_wall(b.text)) && (within(a.text, one) || within(one, a.text)) &&
             (within(b.text, other) || within(other, b.text));
    };
    for (const Name& a : sides[0])
      for (const Name& b : sides[1])
        for (const std::string& one : rule.between[0])
          for (const std::string& other : rule.between[1])
            if (meets(a, b, one, other) || meets(b, a, one, other)) return true;
    return false;
  }
  void apply(const SaveAction& save, const Place&) {
    if (!saved_.insert(save.name.text).second)
      error(save.name.place, "a state '" + save.name.text + "' is saved already: choose another name");
  }
  void apply(const RunAction& run, const Place&) {
    for (const Until& until : run.until) wall_quantities(*until.quantity, until.place);
  }

  std::vector<std::string> rule_names() const {
    std::vector<std::string> names;
    for (const Rule* rule : live_.rules) names.push_back(rule->name);
    return names;
  }

  void missing(const std::string& what, const Name& name, const std::vector<std::string>& candidates) {
    // A saved state brings balls; walls, rules and processes are this scene's own.
    if ((open_ && what.starts_with("ball set")) || name.text.empty()) return;
    const bool gone = ever_walls_.contains(name.text) || ever_balls_.contains(set_of(name.text));
    error(name.place, "no " + what + " '" + name.text + "' at this point of the scene" +
                          (gone ? "; it was deleted before" : "") + suggestion(name.text, candidates));
  }

  bool wants_wall(const Name& name) {
    const bool there = live_.walls.contains(name.text);
    if (!there) missing("wall", name, names_of(live_.walls));
    return there;
  }

  bool wants_balls(const Name& name) {
    const bool there = live_.balls.contains(set_of(name.text)) || name.text == "balls";
    if (!there) missing("ball set", name, names_of(live_.balls));
    return there;
  }

  bool wants_piece(const Name& name) {
    const std::string& text = name.text;
    if (live_.walls.contains(text) || live_.balls.contains(set_of(text)) || text == "balls" || text == "walls")
      return true;
    std::vector<std::string> names = names_of(live_.balls);
    for (const auto& [wall, use] : live_.walls) names.push_back(wall);
    missing("ball set or wall", name, names);
    return false;
  }

  /// `walls.NAME...` can be checked here; what processes publish is known at set-up.
  void wall_quantities(const Formula& formula, const Place& place) {
    if (open_) return;
    for (const std::string& name : formula.names()) {
      if (name.rfind("walls.", 0) != 0) continue;
      const std::string wall = name.substr(6, name.find('.', 6) - 6);
      if (ever_walls_.contains(wall)) continue;
      error(place,
            "'" + name + "': no wall '" + wall + "'" + suggestion(wall, {ever_walls_.begin(), ever_walls_.end()}));
    }
  }

  void check_quantities() {
    std::map<std::string, const Quantity*> all;
    for (const Quantity& quantity : scene_.quantities) {
      insert_named(all, quantity, "quantity", context_);
      if (quantity.formula) wall_quantities(*quantity.formula, quantity.formula->place());
      const std::string set = set_of(quantity.over);
      if (!quantity.over.empty() && quantity.over != "balls" && !open_ && !ever_balls_.contains(set))
        error(quantity.place, "quantity '" + quantity.name + "': no ball set '" + set + "'" +
                                  suggestion(set, {ever_balls_.begin(), ever_balls_.end()}));
    }
    constexpr size_t most_quantities = 1000;
    if (all.size() > most_quantities) return error(scene_.quantities.back().place, "more than 1000 quantities");
    for (const auto& [name, quantity] : all) no_circle(*quantity, all);
    for (const Record& record : scene_.record)
      for (const auto& formula : record.quantities) wall_quantities(*formula, formula->place());
    for (const Expect& expect : scene_.expect)
      if (expect.quantity) wall_quantities(*expect.quantity, expect.quantity->place());
  }

  void no_circle(const Quantity& start, const std::map<std::string, const Quantity*>& all) {
    std::set<std::string> seen;
    std::vector<const Quantity*> open{&start};
    while (!open.empty()) {
      const Quantity* at = open.back();
      open.pop_back();
      if (!at->formula) continue;
      for (const std::string& name : at->formula->names()) {
        const auto next = all.find(name);
        if (next == all.end()) continue;
        if (next->second == &start) return error(start.place, "quantity '" + start.name + "' depends on itself");
        if (seen.insert(name).second) open.push_back(next->second);
      }
    }
  }

  /// A rule that waits for what a stage deletes or adds is in use; one that no pair ever reaches is a mistake.
  void warn_shadowed() {
    for (const auto& [rule, use] : used_rules_) {
      if (use.reached || use.before.empty() || context_.rules_doubtful) continue;
      std::string before;
      for (const Rule* earlier : use.before) before += (before.empty() ? "'" : ", '") + earlier->name + "'";
      context_.report.warn(rule->place, "rule '" + rule->name + "' is never used: " + before +
                                            (use.before.size() == 1 ? " comes first and fits" : " come first and fit") +
                                            " all its pairs; put it before " +
                                            (use.before.size() == 1 ? "it" : "them") + ", or delete it");
    }
  }

  template <class Entries>
  void duplicates(const Entries& entries, const std::string& what) {
    std::map<std::string, Place> seen;
    for (const auto& entry : entries) {
      if (entry.name.empty()) continue;
      const auto [there, fresh] = seen.emplace(entry.name, entry.place);
      if (!fresh)
        error(entry.place, "a " + what + " '" + entry.name + "' exists already, from " + there->second.text());
    }
  }

  Scene& scene_;
  Context& context_;
  const bool open_;  ///< begins from a saved state, whose names are not known here
  Live live_;
  std::vector<const Rule*> new_rules_;
  RuleUses used_rules_;
  std::map<std::string, Place> rule_places_;
  std::set<std::string> ever_walls_, ever_balls_, saved_;
};

}  // namespace

void check_scene(Scene& scene, Context& context) { Checker(scene, context).check(); }

}  // namespace scree::core
