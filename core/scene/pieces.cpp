#include <algorithm>

#include "core/scene/drawn.hpp"
#include "core/scene/parts.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

void take_triple(Mapping& mapping, const std::string& key, const std::string& unit, Triple& out, Context& context) {
  if (const Node* node = mapping.take(key))
    if (const auto value = read_triple(*node, {key, unit}, context)) out = *value;
}

void take_triple(Mapping& mapping, const std::string& key, const std::string& unit, std::optional<Triple>& out,
                 Context& context) {
  if (const Node* node = mapping.take(key)) out = read_triple(*node, {key, unit}, context);
}

}  // namespace

Setting bare_setting(const std::string& name, const Place& place, std::vector<double> numbers) {
  Setting setting;
  setting.name = name;
  setting.place = place;
  setting.value.type = numbers.size() == 3 ? SCREE_VECTOR : SCREE_NUMBER;
  setting.value.rows = 1;
  setting.value.columns = static_cast<uint32_t>(numbers.size());
  setting.value.numbers = std::move(numbers);
  return setting;
}

std::vector<PieceProperty> read_piece_properties(const Node& node, const std::string& what, bool drawn,
                                                 Context& context) {
  std::vector<PieceProperty> out;
  Mapping mapping(node, "`contact` of " + what, context);
  mapping.rest([&](const Key& key, const Node& value) {
    Wanted wanted{key.text, ""};
    wanted.infinity = wanted.position = true;
    if (drawn && value.is_map()) {
      const auto read = read_drawn(value, wanted, context);
      if (read) out.push_back({key.text, 0, read->unit, nullptr, value.place(), read->distribution});
      return;
    }
    const auto number = read_number(value, wanted, context);
    if (number) out.push_back({key.text, number->value, number->unit, number->formula, value.place()});
  });
  return out;
}

WallUse read_wall(const Key& name, const Node& node, Context& context) {
  WallUse wall;
  wall.name = name.text;
  wall.place = name.spot.place();
  check_name(name, "wall", context);
  Mapping mapping(node, "wall '" + name.text + "'", context);
  take_triple(mapping, "velocity", "m/s", wall.velocity, context);
  take_triple(mapping, "spin", "rad/s", wall.spin, context);
  take_triple(mapping, "centre", "m", wall.centre, context);
  if (const Node* contact = mapping.take("contact"))
    wall.contact = read_piece_properties(*contact, mapping.what(), false, context);
  if (mapping.is_map() || node.is_null()) wall.wall = read_use(mapping, Kind::wall, "wall", context);
  mapping.finish();
  return wall;
}

BallSet read_ball_set(const Key& name, const Node& node, Context& context) {
  BallSet set;
  set.name = name.text;
  set.place = name.spot.place();
  check_name(name, "ball set", context);
  Mapping mapping(node, "ball set '" + name.text + "'", context);
  if (const Node* density = mapping.take("density")) {
    set.density = read_plain(*density, {"density", "kg/m3"}, context);
    if (set.density && !(*set.density > 0))
      context.report.error(density->place(), "'density' must be above 0 kg/m3, not " + describe(*density));
  }
  if (const Node* fixed = mapping.take("fixed")) set.fixed = read_bool(*fixed, "fixed", context).value_or(false);
  take_triple(mapping, "velocity", "m/s", set.velocity, context);
  take_triple(mapping, "spin", "rad/s", set.spin, context);
  if (const Node* contact = mapping.take("contact"))
    set.contact = read_piece_properties(*contact, mapping.what(), true, context);
  if (mapping.is_map() || node.is_null()) set.generator = read_use(mapping, Kind::generator, "generator", context);
  mapping.finish();
  return set;
}

ProcessUse read_process(const Key& name, const Node& node, Context& context) {
  ProcessUse process;
  process.name = name.text;
  process.place = name.spot.place();
  check_name(name, "process", context);
  Mapping mapping(node, "process '" + name.text + "'", context);
  if (mapping.is_map() || node.is_null()) process.process = read_use(mapping, Kind::process, "process", context);
  mapping.finish();
  if (process.process.component) context.processes[process.name] = {process.process.component, std::nullopt};
  return process;
}

Rule read_rule(const Node& node, size_t index, Context& context) {
  Rule rule;
  rule.place = node.place();
  const Node* name = node.find("name");
  const bool named = name && name->is_scalar() && !name->text.empty();
  Mapping mapping(node, named ? "rule '" + name->text + "'" : "rule " + std::to_string(index + 1), context);
  if (!mapping.is_map()) {
    context.rules_doubtful = true;
    return rule;
  }
  mapping.take("name");
  if (named) check_name({name->text, name->spot}, "rule", context);
  if (name && !named) read_word(*name, "name", context);
  rule.name = named ? name->text : "rule" + std::to_string(index + 1);
  if (const Node* between = mapping.need("between")) {
    if (!between->is_list() || between->items.size() != 2)
      context.report.error(between->place(),
                           "'between' wants two sides, as in [sand, floor] or [sand, [floor, sides]]");
    for (size_t side = 0; between->is_list() && side < 2 && side < between->items.size(); ++side)
      for (const Name& piece : read_words(between->items[side], "between", context))
        rule.between[side].push_back(piece.text);
  }
  if (rule.between[0].empty() || rule.between[1].empty()) context.rules_doubtful = true;
  const Node* model = node.find("model");
  if (model && model->is_scalar() && model->text == "none") {
    rule.none = true;
    mapping.take("model");
    mapping.finish();
  } else {
    rule.model = read_use(mapping, Kind::contact_model, "model", context);
    mapping.finish();
  }
  if (!rule.model.component) return rule;
  std::vector<std::string> names;
  for (const Setting& setting : rule.model.settings) names.push_back(setting.name);
  bool any = false;
  allowed_forms(*rule.model.component, names, &any);
  context.rules[rule.name] = {rule.model.component, any ? std::optional<uint32_t>(rule.model.form) : std::nullopt};
  return rule;
}

}  // namespace scree::core
