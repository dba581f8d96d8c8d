#include "core/cli/kinds.hpp"

#include "core/base/nearest.hpp"

namespace scree::core {

std::string kind_words() {
  std::string out;
  for (const Kind kind : all_kinds) out += (out.empty() ? "" : ", ") + std::string(kind_name(kind));
  return out;
}

std::optional<Kind> parse_kind(const std::string& word) {
  if (word.empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const Kind kind : all_kinds) {
    if (word == kind_name(kind)) return kind;
    names.emplace_back(kind_name(kind));
  }
  const std::string near = nearest_name(word, names);
  throw Refusal(Exit::usage, "'" + word + "' is no kind of plug-in" +
                                 (near.empty() ? "" : "; did you mean '" + near + "'?") + "  (" + kind_words() + ")");
}

}  // namespace scree::core
