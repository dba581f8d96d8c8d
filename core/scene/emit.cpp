#include <algorithm>

#include "core/scene/tree.hpp"

namespace scree::core {
namespace {

std::string in_quotes(const std::string& text) {
  static const char* const hex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (code < 0x20 || code == 0x7f) {
      out += "\\x";
      out += hex[code >> 4];
      out += hex[code & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

/// A key keeps no memory of quotes, so anything unusual gets them.
std::string key_text(const std::string& key) {
  const bool plain = !key.empty() && key != "null" && key != "~" && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  });
  return plain ? key : in_quotes(key);
}

std::string scalar(const Node& node) {
  if (node.is_null()) return "~";
  return node.quoted ? in_quotes(node.text) : node.text;
}

/// A plain scalar may hold signs that end it inside a flow list.
bool fits_flow(const Node& node) {
  if (node.is_map()) return false;
  if (node.is_list()) return std::all_of(node.items.begin(), node.items.end(), fits_flow);
  return node.quoted || node.text.find_first_of(",[]{}") == std::string::npos;
}

void flow(const Node& node, std::string& out) {
  if (!node.is_list()) {
    out += scalar(node);
    return;
  }
  out += '[';
  for (size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) out += ", ";
    flow(node.items[i], out);
  }
  out += ']';
}

void block(const Node& node, int indent, bool first_inline, std::string& out);

/// What follows "key:" or "-": on the same line where it fits, else an indented block.
void value(const Node& node, int indent, bool after_dash, std::string& out) {
  if (node.is_map() && node.items.empty()) {
    out += " {}\n";
  } else if (node.is_map() && after_dash) {
    out += ' ';
    block(node, indent + 2, true, out);
  } else if (!fits_flow(node) && !node.is_scalar()) {
    out += '\n';
    block(node, indent + 2, false, out);
  } else {
    out += ' ';
    flow(node, out);
    out += '\n';
  }
}

void block(const Node& node, int indent, bool first_inline, std::string& out) {
  const std::string margin(static_cast<size_t>(indent), ' ');
  for (size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0 || !first_inline) out += margin;
    if (node.is_map()) {
      out += key_text(node.keys[i].text) + ":";
      value(node.items[i], indent, false, out);
    } else {
      out += "-";
      value(node.items[i], indent, true, out);
    }
  }
}

}  // namespace

std::string emit(const Node& root) {
  std::string out;
  if ((root.is_map() && !root.items.empty()) || (root.is_list() && !fits_flow(root))) {
    block(root, 0, false, out);
  } else if (root.is_map()) {
    out = "{}\n";
  } else {
    flow(root, out);
    out += '\n';
  }
  return out;
}

}  // namespace scree::core
