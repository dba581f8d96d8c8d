#pragma once
#include <optional>
#include <string>

#include "core/scene/context.hpp"
#include "core/scene/mapping.hpp"

namespace scree::core {

/// Reads `key: name` (as in `wall: plane`) and takes the keys of the mapping that are left as the component's
/// properties. Take the kernel's own keys before. Missing required properties are reported, save those of a contact
/// model, which pieces may give.
Use read_use(Mapping& mapping, Kind kind, const std::string& key, Context& context);

/// One property of a component, from a value of the scene. Nothing when it is wrong (reported).
std::optional<Setting> read_setting(const Component& component, const Key& key, const Node& node, Context& context);

/// Names a scene may set.
std::vector<std::string> property_names(const Component& component);
const scree_property* find_property(const Component& component, const std::string& name, uint32_t* index = nullptr);

/// Is the value inside the property's range? Else why not: "'fric' must be at least 0, not -0.3".
std::optional<std::string> range_error(const scree_property& property, double value);

/// Bits of the input forms that the names of these properties allow together: all ones when none belongs to a form.
uint32_t allowed_forms(const Component& component, const std::vector<std::string>& names, bool* any);

std::string unit_of(const scree_property& property);

}  // namespace scree::core
