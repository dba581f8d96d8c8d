#include "core/cli/schema_parts.hpp"

namespace scree::core::schema {

namespace {

const char* const file_name_pattern = "^[A-Za-z0-9_][A-Za-z0-9_-]{0,99}$";

Json test() {
  Json out =
      mapping({{"below", told(number(), "holds below this value")},
               {"above", told(number(), "holds above this value")},
               {"falls_to", told(above_zero(), "holds at or below this share of the largest value so far")},
               {"rises_to", told(above_zero(), "holds at or above this multiple of the smallest value so far")}});
  out["type"] = "object";
  return with(std::move(out), {{"minProperties", 1}, {"maxProperties", 1}});
}

Json until() {
  return told(Json{{"type", "object"}, {"minProperties", 1}, {"additionalProperties", test()}},
              "tests by expression, as in {unbalanced: {below: 1e-3}}; any that holds ends the run");
}

/// A number, or a mapping that has one of the keys `ends`.
Json number_or_mapping(const Json& alone, const Json& properties, const std::vector<std::string>& ends) {
  Json any = Json::array();
  for (const std::string& key : ends) any.push_back(Json{{"required", Json::array({key})}});
  const Json full = with(mapping(properties), {{"type", "object"}, {"anyOf", std::move(any)}});
  return {{"anyOf", Json::array({alone, full})}};
}

Json run() {
  const Json length = with(number(), {{"minimum", 0}});
  return told(number_or_mapping(length, {{"until", until()}, {"at_most", told(length, "s, or as in 500 cycles")}},
                                {"until", "at_most"}),
              "a time (s), as in 500 cycles, or {until: {...}, at_most: 30 ms}");
}

Json solve() {
  const Json limit = told(above_zero(), "unbalanced force ratio below which it ends");
  return told(number_or_mapping(limit,
                                {{"unbalanced", limit},
                                 {"until", until()},
                                 {"at_most", told(with(number(), {{"minimum", 0}}), "s, or as in 200000 cycles")}},
                                {"unbalanced", "until"}),
              "run until the unbalanced force ratio is below a limit");
}

Json set(const Components& components) {
  const std::string name = "[A-Za-z_][A-Za-z0-9_]*";
  Json paths{{"^walls\\." + name + "\\.(velocity|spin|position)$", triple()},
             {"^balls\\." + name + "(\\.[^.]+)?\\.(velocity|spin)$", triple()}};
  const Json of_models = piece_properties(components, true);
  for (const auto& [key, schema] : of_models.items()) {
    paths["^contacts\\." + name + "\\." + key + "$"] = schema;
    paths["^walls\\." + name + "\\.contact\\." + key + "$"] = told(number(), schema.at("description"));
  }
  std::string keys;
  for (const Component* component : components) {
    if (component->kind != Kind::process) continue;
    const Json properties = properties_of(*component);
    for (const auto& [key, schema] : properties.items()) keys += (keys.empty() ? "" : "|") + key;
  }
  if (!keys.empty()) paths["^processes\\." + name + "\\.(" + keys + ")$"] = Json::object();
  return told(Json{{"type", Json::array({"object", "null"})},
                   {"properties", {{"timestep", told(above_zero(), "s, automatic, or accurate")}}},
                   {"patternProperties", std::move(paths)},
                   {"additionalProperties", false}},
              "path: value, as in {contacts.grains.fric: 0.5, walls.lid.velocity: [0, 0, 0]}");
}

Json add() {
  return told(mapping({{"walls", ref("walls")},
                       {"balls", ref("balls")},
                       {"contacts", with(ref("contacts"), {{"type", "array"}})},
                       {"processes", ref("processes")}}),
              "entries as at the top level");
}

const Json& where() {
  static const Json schema =
      told(text(), "an expression over columns of a ball, as in z > 0.1: only balls for which it holds");
  return schema;
}

Json remove() {
  const Json name = text();
  Json out =
      with(mapping({{"walls", name}, {"balls", name}, {"contacts", name}, {"processes", name}, {"where", where()}}),
           either({"walls", "balls", "contacts", "processes"}));
  out["type"] = "object";
  out["dependencies"] = {{"where", Json::array({"balls"})}};
  return told(std::move(out), "one wall, ball set, rule or process, as in {walls: sides}");
}

Json hold(const std::string& description) {
  return told(mapping({{"balls", told(text(), "a ball set, a sub-group, or balls")},
                       {"velocity", axes()},
                       {"spin", axes()},
                       {"where", where()}},
                      {"balls"}),
              description);
}

Json apply() {
  Json out = mapping({{"balls", told(text(), "a ball set, a sub-group, or balls")},
                      {"force", told(triple(), "on each ball, N")},
                      {"moment", told(triple(), "on each ball, N m")},
                      {"where", where()}},
                     {"balls"});
  out["anyOf"] = Json::array({Json{{"required", {"force"}}}, Json{{"required", {"moment"}}}});
  return told(std::move(out), "a force on each ball, until applied anew");
}

Json bond() {
  const Json names{{"anyOf", Json::array({text(), Json{{"type", "array"}, {"items", text()}}})}};
  return told(mapping({{"rule", told(text(), "a rule whose contact model can bond")},
                       {"gap", told(with(number(), {{"minimum", 0}}), "largest gap of a pair that is bonded, m")},
                       {"again", told(Json{{"type", "boolean"}}, "also pairs whose bond broke; true if absent")},
                       {"between", told(Json{{"type", "array"}, {"items", names}, {"minItems", 2}, {"maxItems", 2}},
                                        "only pairs between these two sides of ball groups and walls")}},
                      {"rule"}),
              "bonds the pairs of a rule that are near enough");
}

}  // namespace

Json actions(const Components& components) {
  Json words{{"run", run()},
             {"cycle", told(Json{{"type", Json::array({"integer", "string"})}, {"minimum", 0}}, "a number of cycles")},
             {"solve", solve()},
             {"set", set(components)},
             {"add", add()},
             {"delete", remove()},
             {"fix", hold("hold these components; without axes all of them")},
             {"free", hold("let go of these components; without axes of all")},
             {"apply", apply()},
             {"bond", bond()},
             {"save", told(Json{{"type", Json::array({"string", "integer"})}, {"pattern", file_name_pattern}},
                           "name of the state, which becomes a file")},
             {"include", told(Json{{"type", "string"}, {"minLength", 1}}, "a file with a list of actions")}};
  return {{"type", Json::array({"array", "null"})}, {"items", with(mapping(std::move(words)), {{"type", "object"}})}};
}

Json stages() {
  const Json stage{{"type", "object"},
                   {"patternProperties", {{file_name_pattern, ref("actions")}}},
                   {"additionalProperties", false},
                   {"minProperties", 1},
                   {"maxProperties", 1}};
  return told(Json{{"type", Json::array({"array", "null"})}, {"items", stage}},
              "what happens, in order, as in `- settle: [run: 0.1 s, save: packed]`");
}

}  // namespace scree::core::schema
