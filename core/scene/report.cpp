#include "core/scene/report.hpp"

#include <algorithm>

#include "core/scene/scene.hpp"

namespace scree::core {
namespace {

constexpr size_t most_errors = 200;  // a hostile file must not fill the terminal or the memory

std::string joined(const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += (out.empty() ? "" : "\n") + line;
  return out;
}

}  // namespace

SceneErrors::SceneErrors(std::vector<std::string> errors)
    : Refusal(Exit::scene, joined(errors)), errors_(std::move(errors)) {}

void Report::error(const Place& place, const std::string& message) { add(place, message, false); }
void Report::missing_plugin(const Place& place, const std::string& message) { add(place, message, true); }

void Report::warn(const Place& place, const std::string& message) {
  const std::string line = place.text() + ": warning: " + message;
  if (seen_.insert(line).second) warnings_.push_back(line);
}

void Report::add(const Place& place, const std::string& message, bool plugin) {
  if (errors_.size() > most_errors) return;
  const std::string line = place.text() + ": error: " + message;
  if (!seen_.insert(line).second) return;
  auto file = std::find(files_.begin(), files_.end(), place.file);
  if (file == files_.end()) file = files_.insert(files_.end(), place.file);
  errors_.push_back({place, line, plugin, static_cast<size_t>(file - files_.begin())});
}

void Report::raise() const {
  if (errors_.empty()) return;
  std::vector<Entry> sorted = errors_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    if (a.file_order != b.file_order) return a.file_order < b.file_order;
    if (a.place.line != b.place.line) return a.place.line < b.place.line;
    return a.place.column < b.place.column;
  });
  std::vector<std::string> lines;
  bool only_plugins = true;
  for (const Entry& entry : sorted) {
    only_plugins = only_plugins && entry.plugin;
    lines.push_back(entry.text);
  }
  if (lines.size() > most_errors) {
    lines.resize(most_errors);
    lines.push_back("error: more than " + std::to_string(most_errors) + " errors; the rest is not shown");
  }
  if (only_plugins) throw Refusal(Exit::plugin, joined(lines));
  throw SceneErrors(std::move(lines));
}

}  // namespace scree::core
