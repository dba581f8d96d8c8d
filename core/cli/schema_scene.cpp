#include "core/cli/schema.hpp"
#include "core/cli/schema_parts.hpp"
#include "core/scene/formula.hpp"

namespace scree::core {

namespace {

using namespace schema;

Json motion() { return {{"velocity", told(triple(), "m/s")}, {"spin", told(triple(), "rad/s")}}; }

Json contact(const Components& components, bool drawn) {
  return told(mapping(piece_properties(components, drawn)), "contact properties of this piece, which rules mix");
}

Json wall(const Components& components) {
  Json own = motion();
  own["centre"] = told(triple(), "of rotation, m");
  own["contact"] = contact(components, false);
  return use(components, Kind::wall, "wall", own, {});
}

Json ball_set(const Components& components) {
  Json own = motion();
  own["density"] = told(above_zero(), "kg/m3");
  own["fixed"] = told(Json{{"type", "boolean"}, {"default", false}}, "true: the balls never move");
  own["contact"] = contact(components, true);
  return use(components, Kind::generator, "generator", own, {});
}

Json record(const Components& components) {
  const Json own{{"every", told(above_zero(), "a time (s), or as in 200 cycles")},
                 {"quantities", told(words(), "names or expressions")},
                 {"fields", told(words(), "columns of balls or contacts")}};
  return use(components, Kind::writer, "writer", own, {"every"});
}

Json quantity() {
  const Json each = told(text(), "an expression over columns of a ball");
  Json reduction =
      mapping({{"sum", each},
               {"min", each},
               {"max", each},
               {"mean", each},
               {"count", told(text(), "a ball set, a sub-group, or balls")},
               {"over", told(text(), "a ball set, a sub-group, or balls, which is the default")},
               {"where", told(text(), "an expression over columns of a ball: only balls for which it holds")}});
  reduction["type"] = "object";
  reduction.update(either({"sum", "min", "max", "mean", "count"}));
  reduction["not"] = {{"required", Json::array({"count", "over"})}};
  return told(Json{{"anyOf", Json::array({text(), std::move(reduction)})}},
              "an expression over published quantities, or a reduction over balls, as in {max: z, over: sand}");
}

Json expectation() {
  Json out =
      mapping({{"quantity", told(text(), "a name or an expression")},
               {"between", told(Json{{"type", "array"}, {"items", number()}, {"minItems", 2}, {"maxItems", 2}},
                                "the smaller bound, then the larger one")},
               {"at_least", number()},
               {"at_most", number()},
               {"equals", told(number(), "with `within` beside it")},
               {"within", told(number(), "a share of the expected value, as in 0.1 %, or an absolute tolerance")},
               {"source", told(text(), "where the expected value comes from")}},
              {"quantity"});
  Json bounds = Json::array();
  for (const char* key : {"between", "at_least", "at_most", "equals"})
    bounds.push_back(Json{{"required", Json::array({key})}});
  out["anyOf"] = std::move(bounds);
  Json both = Json::array();
  for (const char* key : {"at_least", "at_most"})
    both.push_back(Json{{"not", {{"required", Json::array({"between", key})}}}});
  out["allOf"] = std::move(both);
  out["dependencies"] = {{"equals", Json::array({"within"})}, {"within", Json::array({"equals"})}};
  return out;
}

Json cell() {
  return told(mapping({{"low", told(triple(), "lower corner, m")},
                       {"high", told(triple(), "upper corner, m")},
                       {"periodic", told(axes(), "axes along which it repeats")}},
                      {"low", "high"}),
              "orthogonal cell");
}

Json vars() {
  Json out = entries(number());
  Json taken = Json::array({"x", "y", "z", "pi", "time", "cycle", "unbalanced", "balls", "walls", "contacts"});
  for (const std::string& function : Formula::functions()) taken.push_back(function);
  out["propertyNames"] = {{"not", {{"enum", std::move(taken)}}}};
  out["maxProperties"] = 1000;
  return told(std::move(out), "named numbers, for use in expressions");
}

Json include() {
  const Json file{{"type", "string"}, {"minLength", 1}};
  return told(Json{{"anyOf", Json::array({file, Json{{"type", "array"}, {"items", file}}})}},
              "a file or a list of files with further entries");
}

Json list_of(const Json& item) { return {{"type", Json::array({"array", "null"})}, {"items", item}}; }

Json head() {
  return {
      {"scree", told(Json{{"enum", Json::array({1, "1"})}}, "version of the scene format")},
      {"title", told(text(), "for the report")},
      {"seed", told(Json{{"type", Json::array({"integer", "string"})}, {"minimum", 0}, {"default", 1}},
                    "of every random draw")},
      {"vars", vars()},
      {"cell", cell()},
      {"timestep", told(with(above_zero(), {{"default", "automatic"}}),
                        "s, automatic, or accurate: automatic with finer collisions")},
      {"unsafe", told(Json{{"type", "boolean"}, {"default", false}}, "allows a timestep above the certified limit")},
      {"skin", told(above_zero(), "margin of the contact lists, m; chosen from the radii when absent")},
      {"overlap_limit",
       told(with(above_zero(), {{"default", 0.5}}), "share of the smaller radius at which a run stops")},
      {"include", include()},
      {"start",
       told(mapping({{"state", text()}}, {"state"}), "begin from a saved state, as in {state: other.out/packed}")}};
}

Json definitions(const Components& components) {
  return {{"walls", told(entries(wall(components)), "surfaces by name, as in floor: {wall: ..., ...}")},
          {"balls", told(entries(ball_set(components)), "sets of balls by name, as in sand: {generator: ..., ...}")},
          {"contacts", told(list_of(rule(components)), "rules; the first one that fits a pair gives its law")},
          {"processes", told(entries(use(components, Kind::process, "process", Json::object(), {})),
                             "what acts on balls and walls, by name")},
          {"drawn", told(drawn(), "a value for each contact, or for each ball: a distribution")},
          {"actions", actions(components)}};
}

/// Records are files, whose names may hold more than those of pieces.
Json records(const Components& components) {
  return told(Json{{"type", Json::array({"object", "null"})},
                   {"patternProperties", {{"^[A-Za-z0-9_][A-Za-z0-9_-]{0,99}$", record(components)}}},
                   {"additionalProperties", false}},
              "files written during the run, by name");
}

}  // namespace

std::string schema_text(const std::vector<const Component*>& components) {
  Json properties = head();
  for (const char* part : {"walls", "balls", "contacts", "processes"}) properties[part] = ref(part);
  properties["quantities"] = told(entries(quantity()), "named numbers for tests, records and expectations");
  properties["stages"] = stages();
  properties["record"] = records(components);
  properties["expect"] = told(list_of(expectation()), "what must hold at the end; else the exit code is 7");
  Json out{{"$schema", "http://json-schema.org/draft-07/schema#"},
           {"title", "scree scene"},
           {"description", "a scene of scree " SCREE_VERSION " and the plug-ins that were found"},
           {"type", "object"},
           {"required", Json::array({"scree"})},
           {"anyOf", Json::array()},
           {"properties", std::move(properties)},
           {"additionalProperties", false},
           {"definitions", definitions(components)}};
  for (const char* key : {"balls", "walls", "start", "include"})
    out["anyOf"].push_back(Json{{"required", Json::array({key})}});
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace scree::core
