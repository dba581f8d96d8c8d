#include "core/scene/files.hpp"

#include <algorithm>
#include <system_error>

namespace scree::core {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& file, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end();
}

}  // namespace

bool is_inner_path(const std::string& name, const Place& place, Report& report) {
  const fs::path path(name);
  const bool climbs = std::find(path.begin(), path.end(), fs::path("..")) != path.end();
  if (!name.empty() && !path.is_absolute() && !climbs && name.find('\0') == std::string::npos) return true;
  report.error(place, "'" + name.substr(0, 200) +
                          "': a scene names files below its own folder; absolute paths and '..' are refused");
  return false;
}

std::optional<std::string> find_file(const std::string& name, const fs::path& from, const Place& place,
                                     const Folders& folders, Report& report) {
  if (!is_inner_path(name, place, report)) return std::nullopt;
  std::vector<fs::path> roots = folders.others;
  roots.insert(roots.begin(), folders.scene);
  std::vector<fs::path> tries = roots;
  tries.insert(tries.begin(), from);
  for (const fs::path& folder : tries) {
    std::error_code error;
    const fs::path file = fs::canonical(folder / name, error);
    if (error || fs::is_directory(file, error)) continue;
    for (const fs::path& root : roots) {
      const fs::path real = fs::weakly_canonical(root, error);
      if (!error && is_below(file, real)) return file.string();
    }
    report.error(place, "'" + name + "' is a link that leads out of the scene's folder: copy the file instead");
    return std::nullopt;
  }
  report.error(place, "no file '" + name + "' beside the scene" +
                          (folders.others.empty() ? "" : " or in the installed configs"));
  return std::nullopt;
}

}  // namespace scree::core
