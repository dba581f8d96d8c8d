#include "core/scene/mapping.hpp"

#include <algorithm>

#include "core/scene/numbers.hpp"

namespace scree::core {
namespace {

bool is_word(const std::string& text, bool file) {
  constexpr size_t longest = 100;
  if (text.empty() || text.size() > longest) return false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool digit = c >= '0' && c <= '9';
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    const bool inner = digit || (file && c == '-');
    if (!letter && !(inner && (i > 0 || (file && digit)))) return false;
  }
  return true;
}

}  // namespace

Mapping::Mapping(const Node& node, std::string what, Context& context)
    : node_(&node), what_(std::move(what)), context_(context), taken_(node.keys.size(), false) {
  if (!node.is_map() && !node.is_null())
    context.report.error(node.place(), what_ + " wants a mapping (key: value), not " + describe(node));
  for (size_t i = 0; i < node.keys.size(); ++i) {
    if (node.keys[i].text != "<<") continue;
    context.report.error(node.keys[i].spot.place(),
                         "merge keys ('<<') are not read: write the values out, or use an alias for a whole value");
    taken_[i] = left_ = true;
  }
}

const Node* Mapping::take(const std::string& key) {
  asked_.push_back(key);
  for (size_t i = 0; i < node_->keys.size(); ++i) {
    if (node_->keys[i].text != key) continue;
    taken_[i] = true;
    return &node_->items[i];
  }
  return nullptr;
}

const Node* Mapping::need(const std::string& key) {
  const Node* found = take(key);
  if (!found && !left_ && (node_->is_map() || node_->is_null()))
    context_.report.error(node_->place(), what_ + " wants the key '" + key + "'");
  return found;
}

void Mapping::rest(const std::function<void(const Key&, const Node&)>& visit) {
  for (size_t i = 0; i < node_->keys.size(); ++i) {
    if (taken_[i]) continue;
    taken_[i] = true;
    visit(node_->keys[i], node_->items[i]);
  }
}

void Mapping::unknown(const Key& key, const std::vector<std::string>& names) {
  const std::string shown = key.text.size() > 60 ? key.text.substr(0, 60) + "..." : key.text;
  context_.report.error(key.spot.place(), "unknown key '" + shown + "' in " + what_ + suggestion(key.text, names) +
                                              "  (" + list_of(names) + ")");
}

void Mapping::finish(const std::vector<std::string>& also) {
  if (left_) return;
  std::vector<std::string> names = asked_;
  names.insert(names.end(), also.begin(), also.end());
  rest([&](const Key& key, const Node&) { unknown(key, names); });
}

bool check_name(const Key& key, const std::string& what, Context& context) {
  if (is_word(key.text, false)) return true;
  context.report.error(key.spot.place(), "'" + key.text.substr(0, 60) + "' cannot be the name of a " + what +
                                             ": use letters, digits and '_', and no digit in front");
  return false;
}

bool check_file_name(const std::string& text, const Place& place, const std::string& what, Context& context) {
  if (is_word(text, true)) return true;
  context.report.error(place, "'" + text.substr(0, 60) + "' cannot be the name of a " + what +
                                  ", which becomes a file: use letters, digits, '_' and '-'");
  return false;
}

}  // namespace scree::core
