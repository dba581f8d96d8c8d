#pragma once
// A folder of plug-ins that a test fills and that vanishes with it.
#include <stdlib.h>
#include <sys/stat.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "core/plugin/catalogue.hpp"
#include "support/paths.hpp"

namespace scree::test {

class PluginFolder {
 public:
  PluginFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "scree-loader-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = std::filesystem::canonical(name);
    std::filesystem::create_directory(path_ / "contact_model");
    chmod((path_ / "contact_model").c_str(), 0755);
  }
  ~PluginFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  PluginFolder(const PluginFolder&) = delete;
  PluginFolder& operator=(const PluginFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(const std::string& name = "spring") const {
    return path_ / "contact_model" / (name + ".so");
  }
  /// Puts one of the libraries of tests/loader/wrong here, under the name that a scene would use.
  void put(const std::string& library, const std::string& name = "spring") const {
    std::filesystem::copy_file(std::filesystem::path(support::binary_dir()) / "tests" / "wrong" / library, file(name),
                               std::filesystem::copy_options::overwrite_existing);
    chmod(file(name).c_str(), 0644);
  }
  core::Catalogue catalogue() const { return core::Catalogue(core::SearchPath{{}, {path_}}); }

 private:
  std::filesystem::path path_;
};

/// The refusal when `name` is opened, with the folder's own path written as DIR; "" when it opens.
inline std::string refusal(const PluginFolder& folder, core::Catalogue& catalogue, const std::string& name = "spring") {
  try {
    catalogue.open(core::Kind::contact_model, name);
    return "";
  } catch (const core::Refusal& refused) {
    if (refused.code() != core::Exit::plugin) return "wrong exit code";
    std::string text = refused.what();
    const std::string path = folder.path().string();
    for (std::size_t at = 0; (at = text.find(path, at)) != std::string::npos;) text.replace(at, path.size(), "DIR");
    return text;
  }
}

}  // namespace scree::test
