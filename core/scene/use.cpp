#include "core/scene/use.hpp"

#include <bit>
#include <cmath>

#include "core/scene/numbers.hpp"
#include "core/scene/value.hpp"

namespace scree::core {
namespace {

bool is_input(const scree_property& property) { return !(property.flags & SCREE_DERIVED) || property.forms != 0; }

std::string kind_text(Kind kind) { return kind == Kind::contact_model ? "contact model" : kind_name(kind); }

std::string forms_text(const scree_contact_model& model) {
  std::string out;
  for (uint32_t k = 0; k < model.form_count; ++k) out += std::string(k == 0 ? "'" : " or '") + model.forms[k] + "'";
  return out;
}

void check_required(const Use& use, const Mapping& mapping, Context& context) {
  const scree_property* properties = use.component->properties();
  for (uint32_t i = 0; i < use.component->property_count(); ++i) {
    if (!(properties[i].flags & SCREE_REQUIRED) || mapping.has(properties[i].name)) continue;
    context.report.error(use.place, kind_text(use.component->kind) + " '" + use.component->name + "' in " +
                                        mapping.what() + " wants the key '" + properties[i].name +
                                        "': " + (properties[i].doc ? properties[i].doc : "required"));
  }
}

void check_forms(Use& use, const Mapping& mapping, Context& context) {
  std::vector<std::string> names;
  for (const Setting& setting : use.settings) names.push_back(setting.name);
  bool any = false;
  const uint32_t forms = allowed_forms(*use.component, names, &any);
  if (forms != 0) {
    use.form = any ? static_cast<uint32_t>(std::countr_zero(forms)) : 0;
    return;
  }
  context.report.error(use.place, mapping.what() + " mixes alternatives of contact model '" + use.component->name +
                                      "': give either " + forms_text(use.component->contact_model()));
}

}  // namespace

std::string unit_of(const scree_property& property) { return property.unit && *property.unit ? property.unit : "1"; }

const scree_property* find_property(const Component& component, const std::string& name, uint32_t* index) {
  const scree_property* properties = component.properties();
  for (uint32_t i = 0; i < component.property_count(); ++i) {
    if (name != properties[i].name || !is_input(properties[i])) continue;
    if (index) *index = i;
    return properties + i;
  }
  return nullptr;
}

std::vector<std::string> property_names(const Component& component) {
  std::vector<std::string> names;
  const scree_property* properties = component.properties();
  for (uint32_t i = 0; i < component.property_count(); ++i)
    if (is_input(properties[i])) names.emplace_back(properties[i].name);
  return names;
}

uint32_t allowed_forms(const Component& component, const std::vector<std::string>& names, bool* any) {
  uint32_t forms = ~0u;
  for (const std::string& name : names) {
    const scree_property* property = find_property(component, name);
    if (!property || property->forms == 0) continue;
    forms &= property->forms;
    if (any) *any = true;
  }
  return forms;
}

std::optional<std::string> range_error(const scree_property& property, double value) {
  const bool low_open = (property.flags & SCREE_LOW_OPEN) != 0, high_open = (property.flags & SCREE_HIGH_OPEN) != 0;
  const bool below =
      (property.flags & SCREE_HAS_LOW) && (low_open ? !(value > property.low) : !(value >= property.low));
  const bool above =
      (property.flags & SCREE_HAS_HIGH) && (high_open ? !(value < property.high) : !(value <= property.high));
  if (!below && !above) return std::nullopt;
  const double bound = below ? property.low : property.high;
  const char* const relation = below ? (low_open ? "above " : "at least ") : (high_open ? "below " : "at most ");
  const std::string unit = unit_of(property);
  return "'" + std::string(property.name) + "' must be " + relation + number_text(bound) +
         (unit == "1" ? "" : " " + unit) + ", not " + number_text(value);
}

std::optional<Setting> read_setting(const Component& component, const Key& key, const Node& node, Context& context) {
  Setting setting;
  setting.name = key.text;
  setting.place = node.place();
  const scree_property* property = find_property(component, key.text, &setting.property);
  if (!property) return std::nullopt;
  if (!read_value(*property, component.kind == Kind::contact_model, node, setting, context)) return std::nullopt;
  return setting;
}

Use read_use(Mapping& mapping, Kind kind, const std::string& key, Context& context) {
  Use use;
  use.place = mapping.place();
  const Node* name_node = mapping.need(key);
  const auto name = name_node ? read_word(*name_node, key, context) : std::nullopt;
  if (!name) {
    mapping.leave_rest();
    return use;
  }
  use.place = name_node->place();
  try {
    use.component = &context.open(kind, *name);
  } catch (const Refusal& refusal) {
    context.report.missing_plugin(use.place, refusal.what());
    mapping.leave_rest();
    return use;
  }
  const std::vector<std::string> own = mapping.asked();
  std::vector<std::string> names = property_names(*use.component);
  mapping.rest([&](const Key& entry, const Node& node) {
    if (find_property(*use.component, entry.text)) {
      auto setting = read_setting(*use.component, entry, node, context);
      // A wrong value is an error of its own; the property counts as given, so that no second error follows from it.
      use.settings.push_back(setting ? std::move(*setting) : Setting{entry.text, 0, {}, nullptr, node.place()});
      return;
    }
    Mapping about(mapping.node(), kind_text(kind) + " '" + *name + "'", context);
    std::vector<std::string> all = names;
    for (const std::string& other : own)
      if (other != key) all.push_back(other);
    about.unknown(entry, all);
  });
  if (kind == Kind::contact_model) check_forms(use, mapping, context);
  if (kind != Kind::contact_model) check_required(use, mapping, context);
  return use;
}

}  // namespace scree::core
