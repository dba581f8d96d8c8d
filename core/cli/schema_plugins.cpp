#include <cmath>
#include <sstream>

#include "core/cli/property_text.hpp"
#include "core/cli/schema_parts.hpp"

namespace scree::core::schema {

namespace {

/// Whole numbers without a point, as a scene would write them.
Json plain(double value) {
  constexpr double exact = 9007199254740992.0;
  if (value == std::floor(value) && std::abs(value) < exact) return static_cast<int64_t>(value);
  return value;
}

void put_range(const scree_property& property, Json& out) {
  if ((property.flags & SCREE_HAS_LOW) != 0)
    out[(property.flags & SCREE_LOW_OPEN) != 0 ? "exclusiveMinimum" : "minimum"] = plain(property.low);
  if ((property.flags & SCREE_HAS_HIGH) != 0)
    out[(property.flags & SCREE_HIGH_OPEN) != 0 ? "exclusiveMaximum" : "maximum"] = plain(property.high);
}

Json one_number(const scree_property& property) {
  Json out = number();
  put_range(property, out);
  return out;
}

Json one_word(const scree_property& property) {
  if (property.choices == nullptr || *property.choices == '\0') return text();
  Json words = Json::array();
  std::istringstream stream(property.choices);
  for (std::string word; stream >> word;) words.push_back(word);
  return {{"enum", std::move(words)}};
}

/// A number alone counts as a list of one.
Json number_or_list(const scree_property& property, uint32_t length, bool alone) {
  Json list{{"type", "array"}, {"items", one_number(property)}};
  if (length != 0) list = with(list, {{"minItems", length}, {"maxItems", length}});
  return alone ? Json{{"anyOf", Json::array({one_number(property), list})}} : list;
}

Json table(const scree_property& property);

Json shape(const scree_property& property) {
  switch (property.type) {
    case SCREE_INTEGER: {
      Json out{{"type", Json::array({"integer", "string"})}, {"minLength", 1}};
      put_range(property, out);
      return out;
    }
    case SCREE_BOOLEAN:
      return {{"type", "boolean"}};
    case SCREE_VECTOR:
      return number_or_list(property, 3, false);
    case SCREE_TEXT:
      return one_word(property);
    case SCREE_NUMBERS:
      return number_or_list(property, property.words < 2 ? 0 : property.words, property.words < 2);
    case SCREE_VECTORS: {
      Json out{{"type", "array"}, {"items", number_or_list(property, 3, false)}};
      const uint32_t length = property.words / 3;
      return length == 0 ? out : with(out, {{"minItems", length}, {"maxItems", length}});
    }
    case SCREE_TEXTS: {
      const Json word = one_word(property);
      return {{"anyOf", Json::array({word, Json{{"type", "array"}, {"items", word}}})}};
    }
    case SCREE_TABLE:
      return table(property);
    default:
      return one_number(property);
  }
}

/// Also a distribution, in place of a number of a contact model.
Json or_drawn(Json value) { return {{"anyOf", Json::array({std::move(value), ref("drawn")})}}; }

std::string description(const scree_property& property) {
  std::string out = property.doc != nullptr && *property.doc != '\0' ? property.doc : property.name;
  const std::string unit = property.unit != nullptr ? property.unit : "";
  out += " (" + type_text(property);
  if (!unit.empty() && unit != "1") out += ", " + unit;
  if (const std::string range = range_text(property); !range.empty()) out += ", " + range;
  if (const std::string fallback = fallback_text(property); !fallback.empty()) out += ", default " + fallback;
  if (const std::string mix = mix_text(property.mix); !mix.empty()) out += "; of two pieces " + mix;
  return out + ")";
}

Json property_schema(const scree_property& property, bool drawn) {
  Json value = shape(property);
  if (drawn && property.type == SCREE_NUMBER) value = or_drawn(std::move(value));
  Json out = told(std::move(value), description(property));
  if (fallback_text(property).empty()) return out;
  if (property.type == SCREE_BOOLEAN)
    out["default"] = property.fallback != 0;
  else if (std::isfinite(property.fallback))
    out["default"] = plain(property.fallback);
  return out;
}

Json table(const scree_property& property) {
  Json columns = Json::object();
  std::vector<std::string> required;
  for (uint32_t k = 0; k < property.column_count; ++k) {
    const scree_property& column = property.columns[k];
    Json cells = column.words > 1
                     ? Json{{"anyOf", Json::array({one_number(column), number_or_list(column, column.words, false)})}}
                     : one_number(column);
    columns[column.name] = told(std::move(cells), description(column));
    if ((column.flags & SCREE_REQUIRED) != 0) required.emplace_back(column.name);
  }
  return {{"type", "array"}, {"items", mapping(std::move(columns), required)}};
}

Json properties_of(const Component& component, bool drawn) {
  Json out = Json::object();
  for (uint32_t k = 0; k < component.property_count(); ++k)
    if (const scree_property& property = component.properties()[k]; is_input(property))
      out[property.name] = property_schema(property, drawn && component.kind == Kind::contact_model);
  return out;
}

/// Properties of different input forms exclude each other.
Json apart(const Component& component) {
  Json out = Json::array();
  const scree_property* all = component.properties();
  for (uint32_t i = 0; i < component.property_count(); ++i)
    for (uint32_t k = i + 1; k < component.property_count(); ++k)
      if (all[i].forms != 0 && all[k].forms != 0 && (all[i].forms & all[k].forms) == 0)
        out.push_back(Json{{"not", {{"required", Json::array({all[i].name, all[k].name})}}}});
  return out;
}

std::vector<std::string> required_of(const Component& component) {
  std::vector<std::string> out;
  // Pieces may give those of a contact model.
  if (component.kind == Kind::contact_model) return out;
  for (uint32_t k = 0; k < component.property_count(); ++k)
    if ((component.properties()[k].flags & SCREE_REQUIRED) != 0) out.emplace_back(component.properties()[k].name);
  return out;
}

/// The kernel's own keys are looked at beside the branches; a branch only lets them pass.
Json chosen(const Component& component, const std::string& key, const Json& own) {
  Json properties = properties_of(component, true);
  properties[key] = Json::object();
  for (const auto& [name, schema] : own.items()) properties[name] = Json::object();
  Json out = mapping(std::move(properties), required_of(component));
  if (Json pairs = apart(component); !pairs.empty()) out["allOf"] = std::move(pairs);
  return out;
}

Json when(const std::string& key, const std::string& name, Json then) {
  return {{"if", {{"properties", {{key, {{"const", name}}}}}, {"required", Json::array({key})}}},
          {"then", std::move(then)}};
}

}  // namespace

Json drawn() {
  const Json bounds{{"low", told(number(), "no value below it")}, {"high", told(number(), "no value above it")}};
  const auto law = [&](const char* name, Json keys, const std::vector<std::string>& required, bool cut) {
    if (cut) keys.update(bounds);
    return mapping({{name, mapping(std::move(keys), required)}}, {name});
  };
  return {
      {"anyOf",
       Json::array({law("normal", {{"mean", number()}, {"sd", with(number(), {{"minimum", 0}})}}, {"mean", "sd"}, true),
                    law("uniform", bounds, {"low", "high"}, false),
                    law("weibull", {{"shape", above_zero()}, {"scale", above_zero()}}, {"shape", "scale"}, true)})}};
}

Json properties_of(const Component& component) { return properties_of(component, true); }

Json piece_properties(const Components& components, bool drawn) {
  Json out = Json::object();
  for (const Component* component : components) {
    if (component->kind != Kind::contact_model) continue;
    const Json properties = properties_of(*component, drawn);
    for (const auto& [name, schema] : properties.items()) {
      // Which of the models of this name a piece meets is for the rules to say.
      if (!out.contains(name))
        out[name] = schema;
      else if (out[name] != schema)
        out[name] = told(drawn ? or_drawn(number()) : number(), schema.at("description").get<std::string>());
    }
  }
  return out;
}

Json use(const Components& components, Kind kind, const std::string& key, const Json& own,
         const std::vector<std::string>& required) {
  Json names = Json::array(), docs = Json::array(), branches = Json::array();
  for (const Component* component : components) {
    if (component->kind != kind) continue;
    names.push_back(component->name);
    docs.push_back(component->doc);
    branches.push_back(when(key, component->name, chosen(*component, key, own)));
  }
  // What is not known of a component that is not known either: its keys.
  Json properties{
      {key, told(Json{{"enum", names}, {"enumDescriptions", docs}}, "which " + std::string(kind_name(kind)))}};
  properties.update(own);
  std::vector<std::string> needed{key};
  needed.insert(needed.end(), required.begin(), required.end());
  return {
      {"type", "object"}, {"properties", std::move(properties)}, {"required", needed}, {"allOf", std::move(branches)}};
}

Json rule(const Components& components) {
  const Json sides{{"type", "array"}, {"items", words()}, {"minItems", 2}, {"maxItems", 2}};
  const Json own{
      {"name", told(Json{{"type", "string"}, {"pattern", "^[A-Za-z_][A-Za-z0-9_]{0,99}$"}}, "of the rule, for `set`")},
      {"between",
       told(sides, "two sides, each a name or a list of names: ball sets, sub-groups, walls, balls, walls")}};
  Json out = use(components, Kind::contact_model, "model", own, {"between"});
  Json& model = out["properties"]["model"];
  model["enum"].push_back("none");
  model["enumDescriptions"].push_back("these pieces do not interact");
  const Json none = mapping({{"name", Json::object()}, {"between", Json::object()}, {"model", Json::object()}});
  out["allOf"].push_back(when("model", "none", none));
  return out;
}

}  // namespace scree::core::schema
