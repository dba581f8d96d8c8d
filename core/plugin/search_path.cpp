#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/plugin/catalogue.hpp"

namespace scree::core {
namespace {

namespace fs = std::filesystem;

// secure_getenv answers nothing in a program that runs with more rights than its caller has.
std::string_view environment(const char* name) {
  const char* value = secure_getenv(name);
  return value ? value : "";
}

void add_listed(std::string_view list, std::vector<fs::path>& out) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(':'), list.size());
    const fs::path folder(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
    if (folder.empty()) continue;
    if (!folder.is_absolute())
      throw Refusal(Exit::plugin, "SCREE_PLUGIN_PATH: '" + folder.string() +
                                      "' depends on the working directory, from which plug-ins are never loaded: "
                                      "write an absolute path");
    out.push_back(folder);
  }
}

fs::path user_folder() {
  const fs::path data(environment("XDG_DATA_HOME"));
  if (data.is_absolute()) return data / "scree" / "plugins";
  const fs::path home(environment("HOME"));
  return home.is_absolute() ? home / ".local" / "share" / "scree" / "plugins" : fs::path();
}

/// Beside the program: bin/scree and lib/scree/plugins under one folder, in the build tree as in an installation.
fs::path installed_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path().parent_path() / SCREE_PLUGIN_DIR;
}

}  // namespace

SearchPath SearchPath::standard(std::vector<fs::path> command_line) {
  SearchPath path;
  path.command_line = std::move(command_line);
  add_listed(environment("SCREE_PLUGIN_PATH"), path.others);
  for (fs::path folder : {user_folder(), installed_folder()})
    if (!folder.empty()) path.others.push_back(std::move(folder));
  return path;
}

}  // namespace scree::core
