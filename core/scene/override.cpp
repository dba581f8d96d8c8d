#include <charconv>

#include "core/scene/compose.hpp"
#include "core/scene/load.hpp"
#include "core/scene/numbers.hpp"

namespace scree::core {
namespace {

std::vector<std::string> names_in(const Node& node) {
  std::vector<std::string> names;
  for (const Key& key : node.keys) names.push_back(key.text);
  if (!node.is_list()) return names;
  for (const Node& item : node.items) {
    const Node* name = item.find("name");
    if (name && name->is_scalar()) names.push_back(name->text);
    if (item.is_map() && item.keys.size() == 1) names.push_back(item.keys[0].text);
  }
  return names;
}

Node* entry_of_list(Node& list, const std::string& part) {
  size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error == std::errc() && end == part.data() + part.size())
    return index < list.items.size() ? &list.items[index] : nullptr;
  for (Node& item : list.items) {
    const Node* name = item.find("name");
    if (name && name->is_scalar() && name->text == part) return &item;
    if (item.is_map() && item.keys.size() == 1 && item.keys[0].text == part) return &item.items[0];
  }
  return nullptr;
}

class Override {
 public:
  Override(const std::string& path, const std::string& value, Report& report)
      : path_(path), value_(value), report_(report), place_{"--set " + path + "=" + value, 0, 0} {}

  void apply(Node& root) {
    const auto value = load_yaml(value_, place_.file, report_);
    if (!value) return;
    Node* at = &root;
    size_t start = 0;
    while (true) {
      const size_t dot = path_.find('.', start);
      const std::string part = path_.substr(start, dot == std::string::npos ? dot : dot - start);
      if (part.empty()) return refuse("the path has an empty part");
      const bool last = dot == std::string::npos;
      Node* next = at->is_list() ? entry_of_list(*at, part) : at->find(part);
      if (last) return put(*at, next, part, *value);
      if (!next)
        return refuse("there is no '" + path_.substr(0, dot) + "' in the scene" + suggestion(part, names_in(*at)));
      at = next;
      start = dot + 1;
    }
  }

 private:
  void refuse(const std::string& why) { report_.error(place_, why); }

  void put(Node& parent, Node* there, const std::string& part, Node value) {
    value.spot = {std::make_shared<const std::string>(place_.file), 0, 0};
    if (there) {
      *there = std::move(value);
    } else if (parent.is_map()) {
      parent.put({part, value.spot}, value);
    } else {
      refuse("there is no '" + path_ + "' in the scene" + suggestion(part, names_in(parent)));
    }
  }

  std::string path_, value_;
  Report& report_;
  Place place_;
};

}  // namespace

void apply_overrides(Node& root, const std::vector<std::pair<std::string, std::string>>& set, Report& report) {
  for (const auto& [path, value] : set) Override(path, value, report).apply(root);
}

}  // namespace scree::core
