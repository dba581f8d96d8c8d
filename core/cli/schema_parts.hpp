#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/plugin/catalogue.hpp"

namespace scree::core::schema {

using Json = nlohmann::ordered_json;
using Components = std::vector<const Component*>;

/// `extra` on top of `base`.
Json with(Json base, const Json& extra);
/// A value with a line for whoever reads or writes it.
Json told(Json schema, const std::string& description);
/// By its name, from the definitions of the schema.
Json ref(const char* definition);

/// A mapping with these keys and no other; `null`, which is what a key without value gives, counts as empty.
Json mapping(Json properties, const std::vector<std::string>& required = {});
/// The same of entries whose names are chosen freely.
Json entries(const Json& entry);

Json number();                                      ///< a number, a number with unit, or an expression
Json above_zero();                                  ///< the same, above 0
Json triple();                                      ///< three of them
Json text();                                        ///< a text; what looks like a number is one too
Json words();                                       ///< a text or a list of them
Json axes();                                        ///< x, y, z or a list of them
Json either(const std::vector<std::string>& keys);  ///< exactly one of the keys is given

/// The keys of one component, by name. schema_plugins.cpp
Json properties_of(const Component& component);
/// What `contact:` of a piece and `set` may give: each property of any of these models, by name. `drawn`: also as a
/// distribution.
Json piece_properties(const Components& components, bool drawn);
/// The distributions.
Json drawn();
/// A mapping that names a component by `key` and has the kernel's own keys besides: of the chosen component, its own
/// properties are allowed, and no other.
Json use(const Components& components, Kind kind, const std::string& key, const Json& own,
         const std::vector<std::string>& required);

/// A rule of `contacts`. schema_plugins.cpp
Json rule(const Components& components);
/// The list of stages, each a name with `actions` from the definitions. schema_stages.cpp
Json stages();
/// The actions of one stage.
Json actions(const Components& components);

}  // namespace scree::core::schema
