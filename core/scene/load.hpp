#pragma once
#include <optional>
#include <string>

#include "core/scene/report.hpp"
#include "core/scene/tree.hpp"

namespace scree::core {

/// What a file may ask for. Every count is checked while the file is read, before memory is spent on it.
struct LoadLimits {
  static constexpr size_t file_bytes = 64u << 20, scalar_bytes = 1u << 20;
  static constexpr size_t nodes = 1000000, expanded = 1000000;  ///< written, and copied by aliases
  static constexpr size_t depth = 64;
};

/// Reads one YAML document with the place of every node. Strict: duplicate keys, tags, aliases to themselves, a second
/// document and anything over the limits are errors in `report`. Nothing comes back when the file cannot be parsed.
std::optional<Node> load_yaml(const std::string& text, const std::string& file, Report& report);

/// The whole file, or nothing and an error at `asked` (the place that named the file).
std::optional<std::string> read_text(const std::string& file, const Place& asked, Report& report);

}  // namespace scree::core
