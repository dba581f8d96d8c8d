#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/scene/context.hpp"
#include "core/scene/tree.hpp"

namespace scree::core {

/// Reads a mapping key by key; what was not taken in the end is an unknown key.
class Mapping {
 public:
  /// `what` stands in messages: "wall 'floor'". A node that is no mapping is reported; nothing counts as an empty one.
  Mapping(const Node& node, std::string what, Context& context);

  const Node* take(const std::string& key);  ///< null when absent
  const Node* need(const std::string& key);  ///< reports when absent
  bool has(const std::string& key) const { return node_->find(key) != nullptr; }
  /// Every key that was not taken so far, in the order of the file; marks it taken.
  void rest(const std::function<void(const Key&, const Node&)>& visit);
  /// Reports keys that were not taken. `also`: further names to list, as a component's properties.
  void finish(const std::vector<std::string>& also = {});
  void unknown(const Key& key, const std::vector<std::string>& names);
  void leave_rest() { left_ = true; }  ///< nothing is known of the other keys, so none is reported

  bool is_map() const { return node_->is_map(); }
  const std::string& what() const { return what_; }
  Place place() const { return node_->place(); }
  const Node& node() const { return *node_; }
  const std::vector<std::string>& asked() const { return asked_; }

 private:
  const Node* node_;
  std::string what_;
  Context& context_;
  std::vector<std::string> asked_;
  std::vector<bool> taken_;
  bool left_ = false;
};

/// Letters, digits and `_`, not starting with a digit: such a name can stand in an expression. Reports others.
bool check_name(const Key& key, const std::string& what, Context& context);
/// The same with `-` and a digit in front allowed: names that become files and folders.
bool check_file_name(const std::string& text, const Place& place, const std::string& what, Context& context);

}  // namespace scree::core
