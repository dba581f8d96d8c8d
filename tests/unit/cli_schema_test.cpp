// The schema of scenes against the reader of scenes: the keys that the reader names when it meets an unknown one are
// the keys that the schema allows in that place, and scenes that the reader refuses for their structure are refused by
// an independent validator of the schema.
#include "core/cli/schema.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/cli/plugin_name.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/source_scan.hpp"
#include "support/temporary_folder.hpp"
#include "unit/scene_fakes.hpp"

using namespace scree::core;
using Json = nlohmann::json;
using Names = std::set<std::string>;

namespace {

std::vector<const Component*> all_fakes() {
  std::vector<const Component*> out;
  const auto add = [&](Kind kind, const char* name) { out.push_back(&fake_components()(kind, name)); };
  add(Kind::contact_model, "linear");
  for (const char* name : {"plane", "box"}) add(Kind::wall, name);
  for (const char* name : {"random", "file", "points"}) add(Kind::generator, name);
  for (const char* name : {"gravity", "local_damping"}) add(Kind::process, name);
  for (const char* name : {"csv", "vtk"}) add(Kind::writer, name);
  return out;
}

const Json& schema() {
  static const Json parsed = Json::parse(schema_text(all_fakes()));
  return parsed;
}

Names keys_of(const Json& object) {
  Names out;
  for (const auto& [key, value] : object.items()) out.insert(key);
  return out;
}

/// The part of `allOf` that holds for a component.
const Json& branch(const Json& use, const std::string& key, const std::string& name) {
  for (const Json& one : use.at("allOf"))
    if (one.at("if").at("properties").at(key).at("const") == name) return one.at("then");
  throw std::out_of_range("no branch for " + name);
}

const Json& entry_of(const std::string& part) {
  return schema().at("definitions").at(part).at("patternProperties").begin().value();
}
const Json& rule() { return schema().at("definitions").at("contacts").at("items"); }
const Json& action(const std::string& word) {
  return schema().at("definitions").at("actions").at("items").at("properties").at(word);
}

/// A scene that is accepted, with `part` in place of its stages, and other lines below.
std::string scene(const std::string& wall, const std::string& set, const std::string& rule_keys,
                  const std::string& rest) {
  return "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]" + wall +
         "}\nballs:\n  sand: {generator: points, centres: [[0, 0, 1]], radii: 1 cm, density: 2650 kg/m3" + set +
         "}\ncontacts:\n  - {between: [sand, [sand, floor]], model: linear, kn: 1, ks: 1" + rule_keys + "}\n" + rest;
}
std::string with_rest(const std::string& rest) { return scene("", "", "", rest); }
std::string with_action(const std::string& text) { return with_rest("stages: [settle: [" + text + "]]\n"); }

/// The names that the reader lists when it meets the key `qqq`.
Names listed(const std::string& text) {
  std::istringstream lines(refusal_of(text));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("'qqq'") == std::string::npos) continue;
    const std::size_t open = line.rfind("  (");
    if (open == std::string::npos || line.back() != ')') continue;
    Names out;
    std::istringstream words(line.substr(open + 3, line.size() - open - 4));
    for (std::string word; std::getline(words, word, ',');) out.insert(word.substr(word.find_first_not_of(' ')));
    return out;
  }
  return {};
}

Names plus(Names names, const std::string& more) {
  names.insert(more);
  return names;
}

/// What the validator says of scenes under the schema of the fakes: 0 when all are accepted, or all rejected.
int validated(const Json& json, const std::string& wanted, const std::vector<std::string>& scenes) {
  const TemporaryFolder folder;
  write_text(folder / "schema.json", json.dump());
  std::string command = std::string(SCREE_PYTHON) + " '" + support::source_dir() + "/tests/sdk/validate.py' '" +
                        (folder / "schema.json") + "' " + wanted;
  for (const std::string& one : scenes) command += " '" + one + "'";
  return std::system(command.c_str());
}

/// The type that a line begins to define, in PascalCase; "" for any other line.
std::string declared_type(const std::string& line) {
  for (const std::string word : {"struct ", "class ", "enum class ", "enum ", "concept "}) {
    if (!line.starts_with(word) || line.ends_with(";")) continue;
    const std::string rest = line.substr(word.size());
    const std::string name = rest.substr(0, rest.find_first_of(" :{<"));
    if (!name.empty() && name[0] >= 'A' && name[0] <= 'Z') return name;
  }
  return "";
}

}  // namespace

TEST_CASE("a scene of these tests is accepted without the key that they add", "[schema]") {
  REQUIRE(refusal_of(with_rest("")).empty());
  REQUIRE(refusal_of(with_action("run: 1 s")).empty());
}

TEST_CASE("the schema allows the keys that the reader names at the top", "[schema]") {
  // `include` is resolved before the reader looks.
  CHECK(plus(listed(with_rest("qqq: 1\n")), "include") == keys_of(schema().at("properties")));
  const Json& top = schema().at("properties");
  CHECK(listed(with_rest("cell: {qqq: 1}\n")) == keys_of(top.at("cell").at("properties")));
  CHECK(listed(with_rest("start: {qqq: 1}\n")) == keys_of(top.at("start").at("properties")));
  CHECK(listed(with_rest("quantities: {a: {max: z, qqq: 1}}\n")) ==
        keys_of(top.at("quantities").at("patternProperties").begin().value().at("anyOf").at(1).at("properties")));
  CHECK(listed(with_rest("expect: [{qqq: 1}]\n")) == keys_of(top.at("expect").at("items").at("properties")));
  CHECK(plus(listed(with_rest("record: {a: {writer: vtk, every: 1 s, qqq: 1}}\n")), "writer") ==
        keys_of(branch(top.at("record").at("patternProperties").begin().value(), "writer", "vtk").at("properties")));
}

TEST_CASE("the schema allows the keys that the reader names in pieces, rules and processes", "[schema]") {
  CHECK(plus(listed(scene(", qqq: 1", "", "", "")), "wall") ==
        keys_of(branch(entry_of("walls"), "wall", "plane").at("properties")));
  CHECK(plus(listed(scene("", ", qqq: 1", "", "")), "generator") ==
        keys_of(branch(entry_of("balls"), "generator", "points").at("properties")));
  CHECK(listed(scene("", ", contact: {qqq: 1}", "", "")) ==
        keys_of(entry_of("balls").at("properties").at("contact").at("properties")));
  const Json& drawn = schema().at("definitions").at("drawn").at("anyOf");
  for (const std::size_t law : {0u, 1u, 2u}) {
    const std::string name = drawn.at(law).at("required").at(0);
    const Json& keys = drawn.at(law).at("properties").at(name);
    CHECK(listed(scene("", "", ", fric: {" + name + ": {qqq: 1}}", "")) == keys_of(keys.at("properties")));
  }
  CHECK(plus(listed(scene("", "", ", qqq: 1", "")), "model") ==
        keys_of(branch(rule(), "model", "linear").at("properties")));
  CHECK(listed(with_rest("  - {name: a, between: [sand, floor], model: none, qqq: 1}\n")) ==
        keys_of(branch(rule(), "model", "none").at("properties")));
  CHECK(plus(listed(with_rest("processes: {a: {process: gravity, qqq: 1}}\n")), "process") ==
        plus(keys_of(branch(entry_of("processes"), "process", "gravity").at("properties")), "process"));
}

TEST_CASE("the schema allows the actions that the reader names, and their keys", "[schema]") {
  CHECK(listed(with_action("qqq: 1")) ==
        keys_of(schema().at("definitions").at("actions").at("items").at("properties")));
  for (const char* word : {"add", "delete", "fix", "free", "apply"}) {
    INFO(word);
    CHECK(listed(with_action(std::string(word) + ": {qqq: 1}")) == keys_of(action(word).at("properties")));
  }
  for (const char* word : {"run", "solve"}) {
    INFO(word);
    const Json& mapping = action(word).at("anyOf").at(1);
    CHECK(listed(with_action(std::string(word) + ": {qqq: 1}")) == keys_of(mapping.at("properties")));
    CHECK(listed(with_action(std::string(word) + ": {until: {unbalanced: {qqq: 1}}}")) ==
          keys_of(mapping.at("properties").at("until").at("additionalProperties").at("properties")));
  }
  for (const std::string& name : listed(with_action("set: {contacts.rule1.qqq: 1}")))
    CHECK(action("set").at("patternProperties").contains("^contacts\\.[A-Za-z_][A-Za-z0-9_]*\\." + name + "$"));
}

TEST_CASE("names that the reader lists are found in its message", "[schema]") {
  CHECK(listed(with_rest("cell: {qqq: 1}\n")) == Names{"low", "high", "periodic"});
  CHECK(listed(with_rest("")).empty());
}

TEST_CASE("a validator rejects scenes whose structure is wrong", "[schema]") {
  std::vector<std::string> scenes;
  // The others break rules that no schema can tell: units, arithmetic, names of other entries, files.
  const std::string names =
      "action_is_a_word apply_nothing bad_name cell_upside_down contacts_is_a_mapping cycle_of_a_fraction "
      "damping_of_one delete_nothing empty_file empty_scene expect_equals_alone expect_nothing "
      "fix_unknown_axis fraction_for_integer many_errors merge_key missing_kind missing_plugin "
      "missing_property mixed_forms no_version none_with_property not_a_mapping piece_property_unknown "
      "quantity_of_two_kinds record_name_is_a_path record_without_every rule_with_one_side "
      "run_without_end save_as_path seed_is_negative set_out_of_range set_unknown_path "
      "set_unknown_property solve_negative solve_without_limit stage_of_two_names table_column "
      "table_not_a_list timestep_zero unknown_action unknown_choice unknown_property unknown_top_key "
      "unknown_wall_key until_two_tests until_unknown_test var_named_like_function vector_is_text "
      "vector_of_two wall_is_a_number walls_is_a_list wrong_version yes_for_true";
  std::istringstream stream(names);
  for (std::string name; stream >> name;)
    scenes.push_back(support::source_dir() + "/tests/scenes_broken/" + name + ".yaml");
  CHECK(validated(schema(), "rejects", scenes) == 0);
}

TEST_CASE("a validator accepts what these scenes are made from, and the check can fail", "[schema]") {
  const TemporaryFolder folder;
  write_text(folder / "right.yaml",
             with_action("set: {contacts.rule1.fric: 0.5, timestep: automatic}, cycle: 10 cycles"));
  CHECK(validated(schema(), "accepts", {folder / "right.yaml"}) == 0);
  CHECK(validated(schema(), "rejects", {folder / "right.yaml"}) != 0);
  Json wrong = schema();
  wrong["properties"]["title"]["type"] = "word";
  CHECK(validated(wrong, "accepts", {folder / "right.yaml"}) != 0);
}

TEST_CASE("units, ranges, defaults and docs of a property stand in the schema", "[schema]") {
  const Json& factor = branch(entry_of("processes"), "process", "local_damping").at("properties").at("factor");
  CHECK(factor.at("minimum") == 0);
  CHECK(factor.at("exclusiveMaximum") == 1);
  const Json& properties = branch(rule(), "model", "linear").at("properties");
  CHECK(properties.at("kn").at("description") ==
        "see its page (number, N/m, at least 0; of two pieces in series: a b / (a + b))");
  CHECK(properties.at("fric").at("default") == 0);
}

TEST_CASE("the struct of a new plug-in is no type of the SDK", "[new]") {
  CHECK(struct_name(Kind::wall, "rolling_disc") == "RollingDisc");
  CHECK(struct_name(Kind::wall, "a_1_b") == "A1B");
  std::size_t types = 0;
  for (const auto& file : scree::test::scan_folders(support::source_dir(), {"sdk/include"})) {
    std::istringstream lines(file.code);
    long depth = 0;
    bool own = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("namespace ")) own = line.starts_with("namespace scree {");
      // Inside `namespace scree` and no other.
      const std::string name = own && depth == 1 ? declared_type(line) : "";
      depth += std::count(line.begin(), line.end(), '{') - std::count(line.begin(), line.end(), '}');
      if (name.empty()) continue;
      ++types;
      INFO(file.path << ": " << name);
      CHECK(struct_name(Kind::wall, name) == name + "Wall");
    }
  }
  CHECK(types > 30);
}
