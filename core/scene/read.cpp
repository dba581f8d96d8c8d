#include <algorithm>
#include <cctype>

#include "core/scene/check.hpp"
#include "core/scene/compose.hpp"
#include "core/scene/files.hpp"
#include "core/scene/load.hpp"
#include "core/scene/parts.hpp"
#include "core/scene/read.hpp"
#include "core/scene/units.hpp"

namespace scree::core {
namespace {

namespace fs = std::filesystem;

template <class Out, class Read>
void read_entries(Mapping& top, const std::string& key, std::vector<Out>& out, Context& context, Read read) {
  const Node* node = top.take(key);
  if (!node) return;
  Mapping entries(*node, "'" + key + "'", context);
  entries.rest([&](const Key& name, const Node& value) { out.push_back(read(name, value, context)); });
}

template <class Visit>
void each_item(Mapping& top, const std::string& key, const char* of, Context& context, Visit visit) {
  const Node* node = top.take(key);
  if (!node || node->is_null()) return;
  if (!node->is_list()) {
    context.report.error(node->place(), "'" + key + "' wants a list of " + of + ", not " + describe(*node));
    return;
  }
  for (size_t i = 0; i < node->items.size(); ++i) visit(node->items[i], i);
}

void check_var_name(const Key& key, Context& context) {
  if (!check_name(key, "var", context)) return;
  static const std::vector<std::string> taken = {"x",     "y",          "z",     "pi",    "time",
                                                 "cycle", "unbalanced", "balls", "walls", "contacts"};
  const auto& functions = Formula::functions();
  if (std::find(taken.begin(), taken.end(), key.text) != taken.end() ||
      std::find(functions.begin(), functions.end(), key.text) != functions.end())
    context.report.error(key.spot.place(),
                         "'" + key.text + "' means something else in expressions: choose another name for the var");
}

/// Vars may use one another in any order, so that fragments and the scene can define each other's parts.
class VarReader {
 public:
  VarReader(const Node& node, Context& context) : node_(node), context_(context), state_(node.keys.size(), 0) {}

  void read(size_t i) {
    if (state_[i] == 2) return;
    const Key& key = node_.keys[i];
    state_[i] = 1;
    check_var_name(key, context_);
    bool good = true;
    for (const size_t other : used_by(node_.items[i])) {
      if (state_[other] == 1) {
        context_.report.error(node_.items[i].place(), "the var '" + key.text + "' depends on itself");
        good = false;
      } else {
        read(other);
      }
    }
    const auto number = good ? read_number(node_.items[i], {key.text, ""}, context_) : std::nullopt;
    // A var that failed still has a name: uses of it are not errors of their own.
    context_.vars[key.text] = number ? number->value : 1.0;
    if (number && !number->unit.empty()) context_.var_units[key.text] = number->unit;
    state_[i] = 2;
  }

 private:
  std::vector<size_t> used_by(const Node& value) const {
    std::vector<size_t> out;
    const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
    for (size_t at = 0; value.is_scalar() && at < value.text.size();) {
      size_t end = at;
      while (end < value.text.size() && in_word(value.text[end])) ++end;
      const std::string word = value.text.substr(at, end - at);
      for (size_t i = 0; !word.empty() && i < node_.keys.size(); ++i)
        if (node_.keys[i].text == word) out.push_back(i);
      at = std::max(end, at + 1);
    }
    return out;
  }

  const Node& node_;
  Context& context_;
  std::vector<int> state_;  ///< 0 untouched, 1 being read, 2 read
};

void read_vars(Mapping& top, Context& context) {
  const Node* node = top.take("vars");
  if (!node) return;
  const Mapping vars(*node, "'vars'", context);
  constexpr size_t most_vars = 1000;
  if (node->keys.size() > most_vars) {
    context.report.error(node->place(), "more than 1000 vars");
    return;
  }
  VarReader reader(*node, context);
  for (size_t i = 0; i < node->keys.size(); ++i) reader.read(i);
}

void read_version(Mapping& top, Context& context) {
  const Node* version = top.take("scree");
  if (!version) {
    context.report.error(top.place(), "the scene wants its version in front: write 'scree: 1'");
  } else if (!version->is_scalar() || version->text != "1") {
    context.report.error(version->place(),
                         "scene format " + describe(*version) + " is not known; this scree reads 'scree: 1'");
  }
}

std::optional<double> read_positive(Mapping& top, const std::string& key, const std::string& unit, Context& context,
                                    Place* place = nullptr) {
  const Node* node = top.take(key);
  if (!node) return std::nullopt;
  if (place) *place = node->place();
  const auto value = read_plain(*node, {key, unit}, context);
  if (value && !(*value > 0)) {
    context.report.error(
        node->place(), "'" + key + "' must be above 0" + (unit == "1" ? "" : " " + unit) + ", not " + describe(*node));
    return std::nullopt;
  }
  return value;
}

void read_head(Mapping& top, Scene& scene, Context& context) {
  read_version(top, context);
  if (const Node* title = top.take("title")) scene.title = read_word(*title, "title", context).value_or("");
  if (const Node* seed = top.take("seed")) scene.seed = read_count(*seed, "seed", false, context).value_or(1);
  read_vars(top, context);
  scene.vars = context.vars;
  if (const Node* cell = top.take("cell")) scene.cell = read_cell(*cell, context);
  const Node* step = top.node().find("timestep");
  if (step && step->is_scalar() && (step->text == "automatic" || step->text == "accurate")) {
    scene.accurate = step->text == "accurate";
    top.take("timestep");
  } else {
    scene.timestep = read_positive(top, "timestep", "s", context, &scene.timestep_place);
  }
  if (const Node* unsafe = top.take("unsafe")) scene.unsafe = read_bool(*unsafe, "unsafe", context).value_or(false);
  scene.skin = read_positive(top, "skin", "m", context);
  scene.overlap_limit = read_positive(top, "overlap_limit", "1", context).value_or(scene.overlap_limit);
  if (const Node* start = top.take("start")) {
    Mapping mapping(*start, "'start'", context);
    if (const Node* state = mapping.need("state"))
      if (const auto name = read_word(*state, "state", context))
        if (is_inner_path(*name, state->place(), context.report))
          scene.start_state = Name{(context.folders.scene / *name).lexically_normal().string(), state->place()};
    mapping.finish();
  }
}

void read_parts(const Node& root, Scene& scene, Context& context) {
  Mapping top(root, "the scene", context);
  read_head(top, scene, context);
  read_entries(top, "walls", scene.walls, context, read_wall);
  read_entries(top, "balls", scene.balls, context, read_ball_set);
  const Node* rules = root.find("contacts");
  context.rules_doubtful = rules && !rules->is_list() && !rules->is_null();
  each_item(top, "contacts", "rules", context,
            [&](const Node& node, size_t i) { scene.contacts.push_back(read_rule(node, i, context)); });
  read_entries(top, "processes", scene.processes, context, read_process);
  read_entries(top, "quantities", scene.quantities, context, read_quantity);
  each_item(top, "stages", "stages", context,
            [&](const Node& node, size_t) { scene.stages.push_back(read_stage(node, context)); });
  read_entries(top, "record", scene.record, context, read_record);
  each_item(top, "expect", "expectations", context,
            [&](const Node& node, size_t) { scene.expect.push_back(read_expect(node, context)); });
  top.take("include");
  top.finish();
}

Folders folders_of(const ReadOptions& options) {
  Folders folders;
  fs::path folder = options.file.empty() ? fs::path() : fs::path(options.file).parent_path();
  if (folder.empty()) folder = ".";
  std::error_code error;
  folders.scene = fs::absolute(folder, error).lexically_normal();
  for (const std::string& other : options.include_dirs) folders.others.emplace_back(other);
  return folders;
}

std::string real_path(const std::string& file) {
  std::error_code error;
  const fs::path path = file.empty() ? fs::path() : fs::weakly_canonical(file, error);
  return error ? file : path.string();
}

}  // namespace

Scene read_scene(const ReadOptions& options, const OpenComponent& open) {
  Report report;
  Context context{report, open, folders_of(options), {}, {}, {}, {}};
  Scene scene;
  scene.file = options.file;
  const std::string label = options.file.empty() ? "scene" : options.file;
  const auto text = options.text.empty() && !options.file.empty() ? read_text(options.file, {label, 0, 0}, report)
                                                                  : std::optional<std::string>(options.text);
  auto root = text ? load_yaml(*text, label, report) : std::nullopt;
  if (!root) report.raise();
  if (root->is_null()) report.error({label, 0, 0}, "the scene is empty: begin with 'scree: 1', then balls and walls");
  if (!root->is_null() && !root->is_map())
    report.error(root->place(), "a scene is a mapping that begins with 'scree: 1', not " + describe(*root));
  if (!root->is_map()) report.raise();
  include_fragments(*root, options.text.empty() ? real_path(options.file) : "", context.folders, report);
  apply_overrides(*root, options.set, report);
  read_parts(*root, scene, context);
  check_scene(scene, context);
  report.raise();
  scene.resolved = emit(*root);
  scene.warnings = report.warnings();
  return scene;
}

Scene read_scene(const ReadOptions& options, Catalogue& catalogue) {
  return read_scene(options, OpenComponent([&](Kind kind, const std::string& name) -> const Component& {
                      return catalogue.open(kind, name);
                    }));
}

}  // namespace scree::core
