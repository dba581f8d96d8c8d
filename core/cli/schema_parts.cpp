#include "core/cli/schema_parts.hpp"

namespace scree::core::schema {

Json with(Json base, const Json& extra) {
  base.update(extra);
  return base;
}

Json told(Json schema, const std::string& description) {
  schema["description"] = description;
  return schema;
}

// In draft-07 nothing beside a $ref counts, so that a description would be lost.
Json ref(const char* definition) {
  return {{"allOf", Json::array({Json{{"$ref", std::string("#/definitions/") + definition}}})}};
}

Json mapping(Json properties, const std::vector<std::string>& required) {
  Json out{{"type", Json::array({"object", "null"})},
           {"properties", properties.is_null() ? Json::object() : std::move(properties)},
           {"additionalProperties", false}};
  if (required.empty()) return out;
  out["type"] = "object";
  out["required"] = required;
  return out;
}

Json entries(const Json& entry) {
  return {{"type", Json::array({"object", "null"})},
          {"patternProperties", {{"^[A-Za-z_][A-Za-z0-9_]{0,99}$", entry}}},
          {"additionalProperties", false}};
}

Json number() { return {{"type", Json::array({"number", "string"})}, {"minLength", 1}}; }

Json above_zero() { return with(number(), {{"exclusiveMinimum", 0}}); }

Json triple() { return {{"type", "array"}, {"items", number()}, {"minItems", 3}, {"maxItems", 3}}; }

Json text() { return {{"type", Json::array({"string", "number", "boolean"})}, {"minLength", 1}}; }

Json words() { return {{"type", Json::array({"string", "number", "array"})}, {"minLength", 1}, {"items", text()}}; }

Json axes() {
  const Json axis{{"enum", Json::array({"x", "y", "z"})}};
  return {{"anyOf", Json::array({axis, Json{{"type", "array"}, {"items", axis}}})}};
}

Json either(const std::vector<std::string>& keys) {
  Json choices = Json::array();
  for (const std::string& key : keys) choices.push_back(Json{{"required", Json::array({key})}});
  return {{"oneOf", std::move(choices)}};
}

}  // namespace scree::core::schema
