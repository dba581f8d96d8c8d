#include "core/cli/plugin_name.hpp"

#include <algorithm>
#include <set>

namespace scree::core {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_keyword(const std::string& word) {
  static const std::set<std::string> words = {
      "alignas",      "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
      "bitor",        "bool",     "break",      "case",      "catch",     "char",         "char8_t",
      "char16_t",     "char32_t", "class",      "co_await",  "co_return", "co_yield",     "compl",
      "concept",      "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
      "decltype",     "default",  "delete",     "do",        "double",    "else",         "enum",
      "dynamic_cast", "explicit", "export",     "extern",    "false",     "float",        "for",
      "friend",       "goto",     "if",         "inline",    "int",       "long",         "mutable",
      "namespace",    "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
      "or",           "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
      "requires",     "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
      "static_cast",  "struct",   "switch",     "template",  "this",      "thread_local", "throw",
      "true",         "try",      "typedef",    "typeid",    "typename",  "union",        "unsigned",
      "using",        "virtual",  "void",       "volatile",  "wchar_t",   "while",        "xor",
      "xor_eq"};
  return words.contains(word);
}

/// Types of the namespace that plug-ins work in: a struct of such a name would hide them.
bool is_type_of_the_sdk(const std::string& name) {
  static const std::set<std::string> names = {
      "Ball",         "CellView",      "Columns",    "Contact",        "Described",     "Description",    "Effect",
      "GluedSprings", "LinearSprings", "Energies",   "Files",          "Force",         "Host",           "Inertia",
      "Mass",         "Mix",           "Moment",     "MomentResponse", "NormalContact", "NormalResponse", "Outline",
      "Pair",         "Position",      "Properties", "Property",       "Radius",        "Response",       "RowCell",
      "RowFunction",  "Setting",       "Settings",   "Sink",           "Spin",          "SpinContact",    "State",
      "Step",         "Stiffness",     "Stopped",    "Touches",        "Vec3",          "Velocity",       "Wall"};
  return names.contains(name);
}

std::string pascal_case(const std::string& name) {
  std::string out;
  bool first = true;
  for (const char c : name) {
    if (c != '_') out += first && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    first = c == '_';
  }
  return out;
}

}  // namespace

void check_plugin_name(Kind kind, const std::string& name, const Catalogue& catalogue) {
  const auto refuse = [&](const std::string& why) {
    throw Refusal(Exit::usage,
                  "'" + name + "' cannot be the name of a new " + std::string(kind_name(kind)) + ": " + why);
  };
  constexpr std::size_t longest = 64;
  const bool plain =
      std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
  if (name.empty() || !plain || !is_letter(name.front()))
    refuse("use letters, digits and '_', and a letter in front, as in rolling_disc");
  if (name.size() > longest) refuse("it is longer than 64 letters");
  if (is_keyword(name)) refuse("it is a word of C++: choose another");
  if (kind == Kind::contact_model && name == "none")
    refuse("'model: none' says in scenes that pieces do not interact: choose another");
  for (const Found& found : catalogue.found())
    if (found.kind == kind && found.name == name)
      refuse("there is one of this name already, " + found.file.string() + ": choose another");
}

std::string struct_name(Kind kind, const std::string& name) {
  const std::string pascal = pascal_case(name);
  return is_type_of_the_sdk(pascal) ? pascal + pascal_case(kind_name(kind)) : pascal;
}

}  // namespace scree::core
