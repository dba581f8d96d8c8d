#include "core/scene/pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "core/scene/drawn.hpp"
#include "core/scene/numbers.hpp"
#include "core/scene/units.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

struct Piece {
  const std::string& name;
  bool wall;
};

enum class Fit { none, part, whole };

/// Does a side of a rule name the piece? A sub-group is a part of its set.
Fit fit(const std::vector<std::string>& side, const Piece& piece) {
  Fit best = Fit::none;
  for (const std::string& name : side) {
    if (name == piece.name || name == (piece.wall ? "walls" : "balls")) return Fit::whole;
    if (!piece.wall && set_of(name) == piece.name) best = Fit::part;
  }
  return best;
}

struct Cover {
  bool any = false, interacts = false;
};

/// What the rules say about a pair: is there one at all, and does one that can come to apply let it interact?
Cover cover(const Live& live, const Piece& first, const Piece& second) {
  Cover out;
  for (const Rule* rule : live.rules) {
    const auto& [one, other] = rule->between;
    const Fit straight = std::min(fit(one, first), fit(other, second));
    const Fit crossed = std::min(fit(one, second), fit(other, first));
    const Fit best = std::max(straight, crossed);
    if (best == Fit::none) continue;
    out.any = true;
    out.interacts = out.interacts || !rule->none;
    if (best == Fit::whole) break;
  }
  return out;
}

void no_rule(const Place& place, const std::string& one, const std::string& other, Context& context) {
  context.report.error(place, "no rule covers the pair '" + one + "' and '" + other +
                                  "': add one under 'contacts:' with 'between: [" + one + ", " + other +
                                  "]', or with 'model: none' if they are not to interact");
}

/// One contact property of a piece, seen from a rule.
struct Given {
  std::string piece;
  const std::vector<PieceProperty>* properties;
  bool wall = false;
};

const PieceProperty* find_in(const Given& given, const std::string& name) {
  for (const PieceProperty& property : *given.properties)
    if (property.name == name) return &property;
  return nullptr;
}

struct AllPieces {
  std::vector<const BallSet*> balls;
  std::vector<const WallUse*> walls;
};

std::vector<Given> pieces_of(const Rule& rule, const AllPieces& all) {
  std::vector<Given> out;
  for (const BallSet* set : all.balls)
    if (std::max(fit(rule.between[0], {set->name, false}), fit(rule.between[1], {set->name, false})) != Fit::none)
      out.push_back({set->name, &set->contact});
  for (const WallUse* wall : all.walls)
    if (std::max(fit(rule.between[0], {wall->name, true}), fit(rule.between[1], {wall->name, true})) != Fit::none)
      out.push_back({wall->name, &wall->contact, true});
  return out;
}

class LawCheck {
 public:
  LawCheck(Rule& rule, std::vector<Given> pieces, Context& context)
      : rule_(rule), component_(*rule.model.component), pieces_(std::move(pieces)), context_(context) {}

  void check() {
    for (const Setting& setting : rule_.model.settings) given_.push_back(setting.name);
    if (!choose_form()) return;
    const scree_property* properties = component_.properties();
    for (uint32_t i = 0; i < component_.property_count(); ++i) {
      const scree_property& property = properties[i];
      const bool input = !(property.flags & SCREE_DERIVED) || property.forms != 0;
      const bool in_form = property.forms == 0 || (property.forms >> rule_.model.form & 1u);
      if (input && in_form && !rule_gives(property.name)) from_pieces(property);
    }
  }

 private:
  bool rule_gives(const std::string& name) const {
    return std::find(given_.begin(), given_.end(), name) != given_.end();
  }

  bool choose_form() {
    const scree_contact_model& model = component_.contact_model();
    if (model.form_count == 0) return true;
    bool any = false;
    uint32_t forms = allowed_forms(component_, given_, &any);
    if (forms == 0) return false;  // reported where the rule was read
    if (!any) {
      std::vector<std::string> names;
      for (const Given& piece : pieces_)
        for (const PieceProperty& property : *piece.properties) names.push_back(property.name);
      forms = allowed_forms(component_, names, &any);
      if (!any || forms == 0) {
        context_.report.error(rule_.place, "rule '" + rule_.name + "' wants " + forms_text(model) +
                                               " of contact model '" + component_.name + "'" +
                                               (any ? "; its pieces mix them" : "") +
                                               ": give them in the rule, or in `contact:` of every piece it names");
        return false;
      }
    }
    rule_.model.form = static_cast<uint32_t>(std::countr_zero(forms));
    return true;
  }

  static std::string forms_text(const scree_contact_model& model) {
    std::string out;
    for (uint32_t k = 0; k < model.form_count; ++k) out += std::string(k == 0 ? "'" : " or '") + model.forms[k] + "'";
    return out;
  }

  void from_pieces(const scree_property& property) {
    const std::string name = property.name;
    std::string lacking;
    size_t giving = 0;
    for (const Given& piece : pieces_) {
      if (find_in(piece, name))
        ++giving;
      else if (!piece.wall ||
               component_.contact_model().mixed == nullptr)  // such a law takes a wall that gives nothing
        lacking += (lacking.empty() ? "'" : ", '") + piece.piece + "'";
    }
    const bool required = (property.flags & SCREE_REQUIRED) != 0;
    const std::string of = "'" + name + "' of contact model '" + component_.name + "'";
    if (giving == 0) {
      if (required)
        context_.report.error(rule_.place, "rule '" + rule_.name + "' wants " + of +
                                               ": give it in the rule, or in `contact:` of every piece it names");
      return;
    }
    if (property.mix == SCREE_MIX_NONE) {
      context_.report.error(rule_.place, "rule '" + rule_.name + "' must give " + of +
                                             " itself: there is no way to mix the values of two pieces");
    } else if (!lacking.empty() && required) {
      context_.report.error(rule_.place, "rule '" + rule_.name + "' mixes " + of + ", which " + lacking +
                                             " does not give: add it to its `contact:`, or give it in the rule");
    }
  }

  Rule& rule_;
  const Component& component_;
  std::vector<Given> pieces_;
  Context& context_;
  std::vector<std::string> given_;
};

std::vector<Rule*> all_rules(Scene& scene, AllPieces& pieces) {
  std::vector<Rule*> rules;
  for (const BallSet& set : scene.balls) pieces.balls.push_back(&set);
  for (const WallUse& wall : scene.walls) pieces.walls.push_back(&wall);
  for (Rule& rule : scene.contacts) rules.push_back(&rule);
  for (Stage& stage : scene.stages) {
    for (Action& action : stage.actions) {
      auto* more = std::get_if<AddAction>(&action.what);
      if (!more) continue;
      for (const BallSet& set : more->balls) pieces.balls.push_back(&set);
      for (const WallUse& wall : more->walls) pieces.walls.push_back(&wall);
      for (Rule& rule : more->contacts) rules.push_back(&rule);
    }
  }
  return rules;
}

/// The pieces that a side of a rule names, sub-groups as they stand.
std::vector<Piece> named_on(const std::vector<std::string>& side, const Live& live) {
  std::vector<Piece> out;
  for (const std::string& name : side) {
    if (name == "balls")
      for (const auto& [set, use] : live.balls) out.push_back({set, false});
    else if (name == "walls")
      for (const auto& [wall, use] : live.walls) out.push_back({wall, true});
    else if (live.walls.contains(name) || live.balls.contains(set_of(name)))
      out.push_back({name, live.walls.contains(name)});
  }
  return out;
}

/// Is the whole piece on this side? A set covers its sub-groups.
bool holds(const std::vector<std::string>& side, const Piece& piece) {
  return fit(side, piece) == Fit::whole ||
         (!piece.wall && std::find(side.begin(), side.end(), set_of(piece.name)) != side.end());
}

bool takes(const Rule& rule, const Piece& first, const Piece& second) {
  const auto& [one, other] = rule.between;
  return (holds(one, first) && holds(other, second)) || (holds(one, second) && holds(other, first));
}

/// Which rule takes each pair that rule number `index` names.
void look_at_use(const Live& live, std::size_t index, RuleUse& use) {
  const auto& [one, other] = live.rules[index]->between;
  const std::vector<Piece> firsts = named_on(one, live), seconds = named_on(other, live);
  constexpr size_t most_looks = 1000000;  // beyond this only a hostile scene goes
  if (firsts.size() * seconds.size() * (index + 1) > most_looks) {
    use.reached = true;
    return;
  }
  for (const Piece& first : firsts) {
    for (const Piece& second : seconds) {
      if (first.wall && second.wall) continue;
      const auto end = live.rules.begin() + static_cast<std::ptrdiff_t>(index);
      const auto earlier =
          std::find_if(live.rules.begin(), end, [&](const Rule* rule) { return takes(*rule, first, second); });
      use.reached = use.reached || earlier == end;
      if (earlier != end && std::find(use.before.begin(), use.before.end(), *earlier) == use.before.end())
        use.before.push_back(*earlier);
    }
  }
}

/// A property of a piece must belong to a law that the piece meets, in its unit and range.
void check_piece(const std::string& name, const std::vector<PieceProperty>& properties,
                 const std::vector<const Component*>& laws, Context& context) {
  for (const PieceProperty& given : properties) {
    bool found = false;
    std::vector<std::string> names;
    for (const Component* law : laws) {
      const std::vector<std::string> of_law = property_names(*law);
      names.insert(names.end(), of_law.begin(), of_law.end());
      const scree_property* property = find_property(*law, given.name);
      if (!property) continue;
      found = true;
      if (!given.unit.empty() && !units::same_dimension(given.unit, unit_of(*property)))
        context.report.error(given.place, "'" + given.name + "' of contact model '" + law->name + "' wants " +
                                              units::dimension(unit_of(*property)) + ", not " +
                                              units::dimension(given.unit));
      else if (given.drawn != nullptr)
        cut_to_range(*given.drawn, *property, given.place, context);
      else if (std::isinf(given.value) && !(property->flags & SCREE_POSITIVE_INFINITY))
        context.report.error(given.place, "'" + given.name + "' cannot be infinite");
      else if (const auto why = given.formula ? std::nullopt : range_error(*property, given.value))
        context.report.error(given.place, *why);
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    if (!found)
      context.report.error(given.place, "no law that '" + name + "' meets has a property '" + given.name + "'" +
                                            suggestion(given.name, names) +
                                            (names.empty() ? "" : "  (" + list_of(names) + ")"));
  }
}

void warn_untouched(const Live& live, const std::set<std::string>& touching, Context& context) {
  if (live.rules.empty() || live.balls.empty()) return;
  const std::string why = "' touches nothing: every rule for it is 'model: none'";
  for (const auto& [name, set] : live.balls)
    if (!touching.contains(name)) context.report.warn(set->place, "ball set '" + name + why);
  for (const auto& [name, wall] : live.walls)
    if (!touching.contains(name)) context.report.warn(wall->place, "wall '" + name + why);
}

}  // namespace

std::string set_of(const std::string& group) { return group.substr(0, group.find('.')); }

void pairs_have_rules(const Live& live, bool open, Context& context) {
  // Beyond this only a hostile scene goes; set-up meets every pair again.
  constexpr size_t most_looks = 100000000;
  if (live.balls.size() * (live.balls.size() + live.walls.size()) * (live.rules.size() + 1) > most_looks) return;
  if (open || context.rules_doubtful) return;
  std::set<std::string> touching;
  for (const auto& [name, set] : live.balls) {
    for (const auto& [other_name, other] : live.balls) {
      if (other_name < name) continue;
      const Cover pair = cover(live, {name, false}, {other_name, false});
      if (pair.interacts) touching.insert({name, other_name});
      if (!pair.any) no_rule(other->place, name, other_name, context);
    }
  }
  for (const auto& [wall_name, wall] : live.walls) {
    std::vector<std::string> bare;
    for (const auto& [name, set] : live.balls) {
      const Cover pair = cover(live, {name, false}, {wall_name, true});
      if (pair.interacts) touching.insert({name, wall_name});
      if (!pair.any) bare.push_back(name);
    }
    if (!bare.empty() && bare.size() == live.balls.size())
      context.report.error(wall->place, "no rule mentions wall '" + wall_name +
                                            "' with balls: add one under 'contacts:' with 'between: [balls, " +
                                            wall_name + "]', or with 'model: none' if nothing is to touch it");
    else
      for (const std::string& name : bare) no_rule(wall->place, name, wall_name, context);
  }
  warn_untouched(live, touching, context);
}

void rules_in_use(const Live& live, bool open, RuleUses& uses) {
  if (open) return;
  for (std::size_t k = 0; k < live.rules.size(); ++k) {
    const Rule* rule = live.rules[k];
    auto there = std::find_if(uses.begin(), uses.end(), [&](const auto& entry) { return entry.first == rule; });
    if (there == uses.end()) there = uses.insert(uses.end(), {rule, {}});
    if (!there->second.reached) look_at_use(live, k, there->second);
  }
}

void pieces_meet_laws(Scene& scene, bool open, Context& context) {
  AllPieces pieces;
  const std::vector<Rule*> rules = all_rules(scene, pieces);
  std::map<const void*, std::vector<const Component*>> laws;
  for (Rule* rule : rules) {
    if (!rule->model.component) continue;
    if (!open) LawCheck(*rule, pieces_of(*rule, pieces), context).check();
    for (const Given& piece : pieces_of(*rule, pieces)) laws[piece.properties].push_back(rule->model.component);
  }
  const bool all_opened =
      std::all_of(rules.begin(), rules.end(), [](const Rule* rule) { return rule->none || rule->model.component; });
  if (open || !all_opened) return;
  for (const BallSet* set : pieces.balls) check_piece(set->name, set->contact, laws[&set->contact], context);
  for (const WallUse* wall : pieces.walls) check_piece(wall->name, wall->contact, laws[&wall->contact], context);
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions) {
      const auto* set = std::get_if<SetAction>(&action.what);
      if (set == nullptr || set->target != SetAction::Target::wall_contact) continue;
      std::vector<const Component*> met;
      for (const WallUse* wall : pieces.walls)
        if (wall->name == set->name) met.insert(met.end(), laws[&wall->contact].begin(), laws[&wall->contact].end());
      check_piece(set->name, {{set->key, set->setting.value.numbers.at(0), set->unit, nullptr, action.place}}, met,
                  context);
    }
}

}  // namespace scree::core
