#include <algorithm>
#include <set>

#include "core/scene/compose.hpp"
#include "core/scene/files.hpp"
#include "core/scene/load.hpp"

namespace scree::core {
namespace {

constexpr size_t most_files = 1000, deepest_chain = 32;

bool is_merged_list(const std::string& key) { return key == "contacts" || key == "stages" || key == "expect"; }
bool is_merged_map(const std::string& key) {
  for (const char* const name : {"vars", "walls", "balls", "processes", "quantities", "record"})
    if (key == name) return true;
  return false;
}

class Includer {
 public:
  Includer(const Folders& folders, Report& report) : folders_(folders), report_(report) {}

  void whole(Node& root, const std::string& file) {
    chain_.push_back(file);
    if (root.is_map()) {
      splice_stages(root, file);
      merge_fragments(root, file);
    }
    chain_.pop_back();
  }

 private:
  std::filesystem::path folder(const std::string& file) const {
    return file.empty() ? folders_.scene : std::filesystem::path(file).parent_path();
  }

  /// The fragment that `name` asks for, with its path; nothing when it is refused (reported).
  std::optional<std::pair<Node, std::string>> fragment(const Node& name, const std::string& from) {
    if (!name.is_scalar() || name.text.empty()) {
      report_.error(name.place(), "'include' wants the name of a file, not " + describe(name));
      return std::nullopt;
    }
    const auto path = find_file(name.text, folder(from), name.place(), folders_, report_);
    if (!path) return std::nullopt;
    if (std::find(chain_.begin(), chain_.end(), *path) != chain_.end()) {
      report_.error(name.place(), "'" + name.text + "' includes itself");
      return std::nullopt;
    }
    if (chain_.size() >= deepest_chain || ++files_ > most_files) {
      report_.error(name.place(), "too many files are included: at most 1000, at most 32 deep");
      return std::nullopt;
    }
    const auto text = read_text(*path, name.place(), report_);
    auto node = text ? load_yaml(*text, shown(*path), report_) : std::nullopt;
    if (!node) return std::nullopt;
    values_ += node->size;
    if (values_ > LoadLimits::nodes) {
      report_.error(name.place(), "the included files hold more than 1000000 values together");
      return std::nullopt;
    }
    return std::make_pair(std::move(*node), *path);
  }

  /// A short name of a fragment for messages: relative to the scene's folder where it lies below.
  std::string shown(const std::string& path) const {
    std::error_code error;
    const auto root = std::filesystem::weakly_canonical(folders_.scene, error);
    const auto relative = std::filesystem::path(path).lexically_relative(root);
    return relative.empty() || *relative.begin() == ".." ? path : relative.string();
  }

  void merge_fragments(Node& root, const std::string& file) {
    const Node* found = root.find("include");
    if (!found) return;
    const Node list = *found;
    erase(root, "include");
    std::set<std::string> own;
    remember(root, own);
    std::set<std::string> from_fragments;
    const std::vector<Node> names = list.is_list() ? list.items : std::vector<Node>{list};
    size_t stages_before = 0, expect_before = 0;
    for (const Node& name : names) {
      auto loaded = fragment(name, file);
      if (!loaded) continue;
      Node& part = loaded->first;
      if (!part.is_map()) {
        if (!part.is_null())
          report_.error(part.place(),
                        "an included file is a mapping like a scene; a list of actions is included by a stage");
        continue;
      }
      whole(part, loaded->second);
      merge(root, part, own, from_fragments, stages_before, expect_before);
    }
  }

  static void erase(Node& map, const std::string& key) {
    for (size_t i = 0; i < map.keys.size(); ++i) {
      if (map.keys[i].text != key) continue;
      map.keys.erase(map.keys.begin() + static_cast<ptrdiff_t>(i));
      map.items.erase(map.items.begin() + static_cast<ptrdiff_t>(i));
      return;
    }
  }

  /// Entries that the including file gives itself: they win over those of its fragments.
  static void remember(const Node& root, std::set<std::string>& own) {
    for (size_t i = 0; i < root.keys.size(); ++i) {
      own.insert(root.keys[i].text);
      if (is_merged_map(root.keys[i].text) && root.items[i].is_map())
        for (const Key& key : root.items[i].keys) own.insert(root.keys[i].text + "." + key.text);
    }
  }

  void merge(Node& root, Node& part, const std::set<std::string>& own, std::set<std::string>& seen,
             size_t& stages_before, size_t& expect_before) {
    for (size_t i = 0; i < part.keys.size(); ++i) {
      const Key& key = part.keys[i];
      Node& value = part.items[i];
      Node* there = root.find(key.text);
      if (key.text == "scree") {
        if (!value.is_scalar() || value.text != "1")
          report_.error(value.place(),
                        "this file is written for another version of the scene format; this scree reads version 1");
      } else if (is_merged_map(key.text) && value.is_map()) {
        if (!there || there->is_null()) there = &fresh(root, key, Node::Kind::map);
        for (size_t k = 0; k < value.keys.size(); ++k)
          put(*there, key.text + ".", value.keys[k], value.items[k], own, seen);
      } else if (is_merged_list(key.text) && value.is_list()) {
        if (!there || there->is_null()) there = &fresh(root, key, Node::Kind::list);
        size_t* const before = key.text == "stages" ? &stages_before : key.text == "expect" ? &expect_before : nullptr;
        if (there->is_list()) insert(*there, value, before);
      } else {
        put(root, "", key, value, own, seen);
      }
    }
  }

  static Node& fresh(Node& root, const Key& key, Node::Kind kind) {
    Node node;
    node.kind = kind;
    node.spot = key.spot;
    if (Node* there = root.find(key.text)) return *there = std::move(node);
    root.put(key, std::move(node));
    return root.items.back();
  }

  void put(Node& map, const std::string& prefix, const Key& key, Node& value, const std::set<std::string>& own,
           std::set<std::string>& seen) {
    if (!map.is_map() || own.contains(prefix + key.text)) return;
    if (seen.insert(prefix + key.text).second) {
      map.put(key, std::move(value));
      return;
    }
    const Place first = map.find(key.text)->place();
    report_.error(key.spot.place(), "'" + prefix + key.text + "' is given by two included files, here and at " +
                                        first.text() + ": give it in the scene itself to choose");
  }

  /// Stages and expectations of fragments come before the file's own, in the order of inclusion; rules come after, so
  /// that the file's own rules are looked at first.
  static void insert(Node& list, Node& more, size_t* before) {
    auto at = before ? list.items.begin() + static_cast<ptrdiff_t>(*before) : list.items.end();
    if (before) *before += more.items.size();
    list.items.insert(at, std::make_move_iterator(more.items.begin()), std::make_move_iterator(more.items.end()));
  }

  void splice_stages(Node& root, const std::string& file) {
    Node* stages = root.find("stages");
    if (!stages || !stages->is_list()) return;
    for (Node& stage : stages->items)
      for (Node& actions : stage.items)
        if (actions.is_list()) splice_actions(actions, file);
  }

  void splice_actions(Node& actions, const std::string& file) {
    std::vector<Node> out;
    for (Node& item : actions.items) {
      if (!item.is_map() || !item.find("include")) {
        out.push_back(std::move(item));
        continue;
      }
      for (size_t i = 0; i < item.keys.size(); ++i) {
        if (item.keys[i].text == "include") {
          splice_file(item.items[i], file, out);
          continue;
        }
        Node single;
        single.spot = item.keys[i].spot;
        single.put(item.keys[i], std::move(item.items[i]));
        out.push_back(std::move(single));
      }
    }
    actions.items = std::move(out);
  }

  void splice_file(const Node& name, const std::string& file, std::vector<Node>& out) {
    auto loaded = fragment(name, file);
    if (!loaded) return;
    Node& part = loaded->first;
    if (!part.is_list()) {
      report_.error(part.place(), "a file included by a stage is a list of actions, not " + describe(part));
      return;
    }
    chain_.push_back(loaded->second);
    splice_actions(part, loaded->second);
    chain_.pop_back();
    for (Node& item : part.items) out.push_back(std::move(item));
  }

  const Folders& folders_;
  Report& report_;
  std::vector<std::string> chain_;
  size_t files_ = 0, values_ = 0;
};

}  // namespace

void include_fragments(Node& root, const std::string& file, const Folders& folders, Report& report) {
  Includer(folders, report).whole(root, file);
}

}  // namespace scree::core
