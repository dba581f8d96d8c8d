#include "unit/scene_fakes.hpp"

#include <vector>

#include "core/base/nearest.hpp"

namespace scree::core {
namespace {

scree_property property(uint32_t type, const char* name, const char* unit, uint32_t flags = 0) {
  scree_property p{};
  p.struct_size = sizeof p;
  p.type = type;
  p.name = name;
  p.unit = unit;
  p.doc = "see its page";
  p.words = type == SCREE_VECTOR ? 3 : 1;
  p.flags = flags;
  return p;
}

scree_property number(const char* name, const char* unit, double low, uint32_t flags = 0) {
  scree_property p = property(SCREE_NUMBER, name, unit, flags | SCREE_HAS_LOW);
  p.low = low;
  return p;
}

scree_property law(const char* name, const char* unit, uint32_t forms, uint32_t mix, uint32_t flags = 0) {
  scree_property p = number(name, unit, 0, flags);
  p.forms = forms;
  p.mix = mix;
  return p;
}

scree_property share(const char* name, double high, uint32_t flags = 0) {
  scree_property p = number(name, "1", 0, flags | SCREE_HAS_HIGH);
  p.high = high;
  return p;
}

scree_property mode(const char* name, double high) {
  scree_property p = property(SCREE_INTEGER, name, "1", SCREE_HAS_LOW | SCREE_HAS_HIGH | SCREE_HAS_FALLBACK);
  p.high = high;
  return p;
}

scree_property words(uint32_t type, const char* name, const char* choices, uint32_t flags = 0) {
  scree_property p = property(type, name, "1", flags);
  p.choices = choices;
  return p;
}

scree_property column(const char* name, const char* unit, uint32_t word, uint32_t count) {
  scree_property p = number(name, unit, 0, SCREE_REQUIRED | SCREE_LOW_OPEN);
  p.word = word;
  p.words = count;
  return p;
}

const std::vector<scree_property>& linear() {
  static const std::vector<scree_property> table = {
      law("kn", "N/m", 1, SCREE_MIX_SERIES, SCREE_REQUIRED),
      law("ks", "N/m", 1, SCREE_MIX_SERIES, SCREE_REQUIRED),
      law("emod", "Pa", 2, SCREE_MIX_HARMONIC, SCREE_REQUIRED),
      law("kratio", "1", 2, SCREE_MIX_MEAN, SCREE_REQUIRED),
      law("fric", "1", 0, SCREE_MIX_LEAST, SCREE_HAS_FALLBACK | SCREE_POSITIVE_INFINITY),
      law("dp_nratio", "1", 0, SCREE_MIX_NONE, SCREE_HAS_FALLBACK),
      mode("dp_mode", 3)};
  return table;
}

const std::vector<scree_property>& grading_columns() {
  static const std::vector<scree_property> table = {column("diameter", "m", 0, 2), column("share", "1", 2, 1)};
  return table;
}

std::vector<scree_property> random_table() {
  scree_property grading = property(SCREE_TABLE, "grading", "1");
  grading.columns = grading_columns().data();
  grading.column_count = static_cast<uint32_t>(grading_columns().size());
  scree_property count = property(SCREE_INTEGER, "count", "1", SCREE_HAS_LOW);
  scree_property radius = number("radius", "m", 0, SCREE_LOW_OPEN);
  radius.type = SCREE_NUMBERS;
  return {property(SCREE_VECTORS, "box", "m", SCREE_REQUIRED),
          radius,
          share("porosity", 1, SCREE_HIGH_OPEN),
          count,
          grading,
          words(SCREE_TEXT, "by", "mass number")};
}

struct Tables {
  scree_contact_model linear_model{}, glue_model{};
  scree_wall plane{}, box{};
  scree_generator random{}, file{}, points{};
  scree_process gravity{}, damping{};
  scree_writer csv{}, vtk{};
  std::vector<std::vector<scree_property>> kept;
  std::vector<Component> components;

  void give(scree_object& object, std::vector<scree_property> table) {
    kept.push_back(std::move(table));
    object.properties = kept.back().data();
    object.property_count = static_cast<uint32_t>(kept.back().size());
  }

  void list(Kind kind, const char* name, const void* table) {
    Component component{};
    component.kind = kind;
    component.name = name;
    component.table = table;
    components.push_back(component);
  }

  Tables() {
    static const char* const forms[] = {"kn ks", "emod kratio"};
    linear_model.properties = linear().data();
    linear_model.property_count = static_cast<uint32_t>(linear().size());
    linear_model.forms = forms;
    linear_model.form_count = 2;
    glue_model = linear_model;
    glue_model.flags = SCREE_CAN_BOND;
    give(plane.object,
         {property(SCREE_VECTOR, "point", "m", SCREE_REQUIRED), property(SCREE_VECTOR, "normal", "1", SCREE_REQUIRED)});
    give(box.object,
         {property(SCREE_VECTOR, "low", "m", SCREE_REQUIRED), property(SCREE_VECTOR, "high", "m", SCREE_REQUIRED),
          words(SCREE_TEXTS, "open", "left right front back bottom top")});
    give(random.object, random_table());
    give(file.object, {property(SCREE_TEXT, "path", "1", SCREE_REQUIRED | SCREE_FILE)});
    give(points.object,
         {property(SCREE_VECTORS, "centres", "m", SCREE_REQUIRED),
          property(SCREE_NUMBERS, "radii", "m", SCREE_REQUIRED), property(SCREE_BOOLEAN, "overlap", "1")});
    give(gravity.object, {property(SCREE_VECTOR, "acceleration", "m/s2")});
    give(damping.object, {share("factor", 1, SCREE_HIGH_OPEN | SCREE_REQUIRED)});
    give(csv.object, {});
    give(vtk.object, {words(SCREE_TEXT, "encoding", "raw ascii")});
    list(Kind::contact_model, "linear", &linear_model);
    list(Kind::contact_model, "glue", &glue_model);
    list(Kind::wall, "plane", &plane);
    list(Kind::wall, "box", &box);
    list(Kind::generator, "random", &random);
    list(Kind::generator, "file", &file);
    list(Kind::generator, "points", &points);
    list(Kind::process, "gravity", &gravity);
    list(Kind::process, "local_damping", &damping);
    list(Kind::writer, "csv", &csv);
    list(Kind::writer, "vtk", &vtk);
  }
};

const Component& open_fake(Kind kind, const std::string& name) {
  static const Tables tables;
  std::vector<std::string> names;
  for (const Component& component : tables.components) {
    if (component.kind != kind) continue;
    if (component.name == name) return component;
    names.push_back(component.name);
  }
  const std::string near = nearest_name(name, names);
  throw Refusal(Exit::plugin, std::string("no ") + kind_name(kind) + " plug-in '" + name + "'" +
                                  (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

}  // namespace

const OpenComponent& fake_components() {
  static const OpenComponent open = open_fake;
  return open;
}

Scene read_text_scene(const std::string& text, std::vector<std::pair<std::string, std::string>> set) {
  ReadOptions options;
  options.text = text;
  options.set = std::move(set);
  return read_scene(options, fake_components());
}

std::string refusal_of(const std::string& text) {
  try {
    read_text_scene(text);
  } catch (const Refusal& refusal) {
    return refusal.what();
  }
  return "";
}

}  // namespace scree::core

// UDUNITS-2 2.2.28 loses the few bytes of a name that it does not know (strdup in its lexer); not ours to free.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libudunits2"; }
