#include "core/scene/tree.hpp"

namespace scree::core {

const Node* Node::find(const std::string& key) const {
  for (size_t i = 0; i < keys.size(); ++i)
    if (keys[i].text == key) return &items[i];
  return nullptr;
}

Node* Node::find(const std::string& key) {
  for (size_t i = 0; i < keys.size(); ++i)
    if (keys[i].text == key) return &items[i];
  return nullptr;
}

void Node::put(Key key, Node value) {
  kind = Kind::map;
  keys.push_back(std::move(key));
  items.push_back(std::move(value));
}

std::string describe(const Node& node) {
  if (node.is_null()) return "nothing";
  if (node.is_list()) return "a list";
  if (node.is_map()) return "a mapping";
  constexpr size_t longest = 60;
  return node.text.size() <= longest ? "'" + node.text + "'" : "'" + node.text.substr(0, longest) + "...'";
}

}  // namespace scree::core
