#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace scree::core {

/// Where a node stands. The file name is shared, because a scene may have a million nodes.
struct Spot {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;
  Place place() const { return {file ? *file : std::string(), line, column}; }
};

struct Key {
  std::string text;
  Spot spot;
};

/// A YAML value that knows its place. Maps keep the order of the file; `keys` runs parallel to `items`.
struct Node {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< a quoted scalar is an expression where a number is wanted
  std::vector<Node> items;
  std::vector<Key> keys;
  Spot spot;
  uint32_t size = 1, depth = 1;  ///< nodes of this tree, levels of this tree; as loaded

  Place place() const { return spot.place(); }
  bool is_null() const { return kind == Kind::null; }
  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_list() const { return kind == Kind::list; }
  bool is_map() const { return kind == Kind::map; }
  const Node* find(const std::string& key) const;
  Node* find(const std::string& key);
  void put(Key key, Node value);  ///< appends to a map
};

/// "a list", "a mapping", "the text 'abc'", "nothing": for messages.
std::string describe(const Node& node);

/// The tree as YAML text that loads to the same tree.
std::string emit(const Node& root);

}  // namespace scree::core
