#include "core/cli/component_text.hpp"

#include <nlohmann/json.hpp>

#include "core/base/log.hpp"
#include "core/cli/property_text.hpp"

namespace scree::core {

namespace {

using Json = nlohmann::ordered_json;

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::vector<std::string> forms_of(const Component& component, const scree_property& property) {
  std::vector<std::string> out;
  if (component.kind != Kind::contact_model) return out;
  const scree_contact_model& model = component.contact_model();
  for (uint32_t k = 0; k < model.form_count; ++k)
    if ((property.forms >> k & 1u) != 0) out.emplace_back(model.forms[k]);
  return out;
}

std::string property_lines(const Component& component, const scree_property& property, const std::string& indent) {
  const std::string unit = property.unit ? property.unit : "";
  std::string out = indent + property.name + ": " + type_text(property);
  if (!unit.empty() && unit != "1") out += ", " + unit;
  if (const std::string range = range_text(property); !range.empty()) out += ", " + range;
  if (const std::string fallback = fallback_text(property); !fallback.empty()) out += ", default " + fallback;
  if ((property.flags & SCREE_REQUIRED) != 0 && property.forms == 0) out += ", required";
  out += "\n";
  if (property.doc != nullptr && *property.doc != '\0') out += indent + "    " + property.doc + "\n";
  if (const std::string mix = mix_text(property.mix); !mix.empty()) out += indent + "    of two pieces " + mix + "\n";
  for (const std::string& form : forms_of(component, property)) out += indent + "    in the form '" + form + "'\n";
  for (uint32_t k = 0; k < property.column_count; ++k)
    out += property_lines(component, property.columns[k], indent + "    ");
  return out;
}

Json property_json(const Component& component, const scree_property& property) {
  Json out{{"name", property.name}, {"type", type_text(property)}};
  const auto put = [&](const char* key, const std::string& text) {
    if (!text.empty()) out[key] = text;
  };
  put("unit", property.unit ? property.unit : "");
  put("range", range_text(property));
  put("default", fallback_text(property));
  put("mixing", mix_text(property.mix));
  put("doc", property.doc ? property.doc : "");
  out["required"] = (property.flags & SCREE_REQUIRED) != 0;
  if (const auto forms = forms_of(component, property); !forms.empty()) out["forms"] = forms;
  for (uint32_t k = 0; k < property.column_count; ++k)
    out["columns"].push_back(property_json(component, property.columns[k]));
  return out;
}

void declared_by_law(const scree_contact_model& model, std::vector<std::string>& out) {
  for (uint32_t k = 0; k < model.state_count; ++k)
    out.push_back(fmt::format("remembers {}: {} number{}, {}", model.states[k].name, model.states[k].words,
                              model.states[k].words == 1 ? "" : "s", model.states[k].unit));
  if (model.state_words > 0)
    out.push_back(fmt::format("a contact remembers {} bytes", model.state_words * sizeof(double)));
  if ((model.flags & SCREE_NEEDS_SPIN) != 0) out.push_back("reads the spin of the balls");
  if ((model.flags & SCREE_NEEDS_TURN) != 0) out.push_back("what it remembers turns with the contact");
  if ((model.flags & SCREE_GIVES_MOMENT) != 0) out.push_back("gives a moment beside that of its force");
  if ((model.flags & SCREE_NONLINEAR) != 0) out.push_back("its stiffness changes with the gap");
  if ((model.flags & SCREE_CAN_BOND) != 0) out.push_back("can bond");
  if (model.reach != nullptr) out.push_back("acts across a gap");
  if (model.uniform_energy[0] != nullptr) out.push_back("accounts for its energy");
  if (model.normal_only[0] != nullptr) out.push_back("a rule without a tangential part runs a law of its own");
}

void declared_by_process(const scree_process& process, std::vector<std::string>& out) {
  constexpr const char* columns[SCREE_COLUMN_COUNT] = {"position", "velocity", "spin",    "force", "moment",
                                                       "radius",   "mass",     "inertia", "fixed"};
  if (process.rows[0] != nullptr) out.push_back("acts on balls between force and motion");
  if (process.step != nullptr)
    out.push_back(process.every > 1 ? fmt::format("acts between cycles, every {}", process.every)
                                    : "acts between cycles");
  if ((process.flags & SCREE_ADDS_FORCE) != 0) out.push_back("adds forces");
  if ((process.flags & SCREE_SCALES_FORCE) != 0) out.push_back("scales forces");
  for (uint32_t k = 0; k < process.need_count; ++k) {
    const scree_need& need = process.needs[k];
    if (need.column < SCREE_COLUMN_COUNT)
      out.push_back(std::string((need.access & SCREE_WRITE) != 0 ? "writes " : "reads ") + columns[need.column] +
                    ((need.access & SCREE_OPTIONAL) != 0 ? " where the scene keeps it" : ""));
  }
  if ((process.flags & SCREE_LOCAL_DAMPING) != 0) out.push_back("damps locally, which shortens the time step");
  if (process.state_words > 0) out.push_back(fmt::format("saves {} numbers", process.state_words));
}

void declared_by_writer(const scree_writer& writer, std::vector<std::string>& out) {
  if ((writer.wants & SCREE_WANTS_QUANTITIES) != 0) out.push_back("writes quantities");
  if ((writer.wants & SCREE_WANTS_BALLS) != 0) out.push_back("writes balls and their fields");
  if ((writer.wants & SCREE_WANTS_CONTACTS) != 0) out.push_back("writes contacts when their fields are asked for");
  if ((writer.wants & SCREE_WANTS_WALLS) != 0) out.push_back("writes walls");
  if (writer.save != nullptr) out.push_back("has a memory that checkpoints save");
}

/// Where in a scene a kind stands: the lines before its own keys, and the indent of those.
std::string head_of(const Component& component, std::string& indent) {
  indent = "    ";
  switch (component.kind) {
    case Kind::contact_model:
      return "contacts:\n  - name: grains\n    between: [balls, balls]\n    model: " + component.name + "\n";
    case Kind::wall:
      return "walls:\n  floor:\n    wall: " + component.name + "\n";
    case Kind::generator:
      return "balls:\n  sand:\n    generator: " + component.name + "\n    density: 2650 kg/m3\n";
    case Kind::process:
      return "processes:\n  " + component.name + ":\n    process: " + component.name + "\n";
    case Kind::writer: {
      const bool quantities = (component.writer().wants & SCREE_WANTS_QUANTITIES) != 0;
      return "record:\n  out:\n    writer: " + component.name + "\n    every: 1 ms\n    " +
             (quantities ? "quantities: [time]\n" : "fields: [velocity]\n");
    }
  }
  return "";
}

/// Given in the snippet: what must be, and of alternative forms the first.
bool is_given(const scree_property& property) {
  if (property.forms != 0) return (property.forms & 1u) != 0;
  return (property.flags & SCREE_REQUIRED) != 0 && (property.flags & SCREE_HAS_FALLBACK) == 0;
}

}  // namespace

std::vector<std::string> declared(const Component& component) {
  std::vector<std::string> out;
  if (component.kind == Kind::contact_model) declared_by_law(component.contact_model(), out);
  if (component.kind == Kind::process) declared_by_process(component.process(), out);
  if (component.kind == Kind::writer) declared_by_writer(component.writer(), out);
  if (component.kind == Kind::wall && (component.wall().flags & SCREE_WALL_FLAT) != 0)
    out.push_back("every face is flat");
  return out;
}

std::string snippet(const Component& component) {
  std::string indent, out = head_of(component, indent), rest;
  uint32_t corner = 0;
  for (uint32_t k = 0; k < component.property_count(); ++k) {
    const scree_property& property = component.properties()[k];
    if (!is_input(property)) continue;
    const std::string line = std::string(property.name) + ": " + sample_text(property, corner);
    if (property.type == SCREE_VECTOR) ++corner;
    const std::vector<std::string> forms = forms_of(component, property);
    if (is_given(property))
      out += indent + line + "\n";
    else
      rest += indent + "# " + line + (forms.empty() ? "" : "    (in the form '" + joined(forms) + "')") + "\n";
  }
  return out + rest;
}

std::string component_text(const Component& component) {
  std::string out = fmt::format("{} {} {}\n{}\n{}\n", kind_name(component.kind), component.name, component.version,
                                component.doc, component.file.string());
  out += "\nkeys\n";
  bool any = false;
  for (uint32_t k = 0; k < component.property_count(); ++k)
    if (is_input(component.properties()[k])) {
      out += property_lines(component, component.properties()[k], "  ");
      any = true;
    }
  if (!any) out += "  none\n";
  if (const auto lines = declared(component); !lines.empty()) {
    out += "\nstates and flags\n";
    for (const std::string& line : lines) out += "  " + line + "\n";
  }
  return out + "\nin a scene\n" + snippet(component);
}

std::string component_json(const Component& component) {
  Json out{{"kind", kind_name(component.kind)},  {"name", component.name},     {"version", component.version},
           {"library", component.file.string()}, {"sha256", component.sha256}, {"doc", component.doc},
           {"properties", Json::array()}};
  for (uint32_t k = 0; k < component.property_count(); ++k)
    if (is_input(component.properties()[k]))
      out["properties"].push_back(property_json(component, component.properties()[k]));
  out["declared"] = declared(component);
  out["snippet"] = snippet(component);
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace scree::core
