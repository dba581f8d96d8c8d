#pragma once
#include <scree/abi.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace scree::core {

enum class Kind : uint32_t {
  contact_model = SCREE_CONTACT_MODEL,
  wall = SCREE_WALL,
  generator = SCREE_GENERATOR,
  process = SCREE_PROCESS,
  writer = SCREE_WRITER
};
const char* kind_name(Kind kind);  ///< "contact_model", ... : also the name of its folder

/// One component of an opened library. Lives as long as the catalogue; libraries are never unloaded.
struct Component {
  Kind kind;
  std::string name, version, doc;
  std::filesystem::path file;
  std::string sha256;
  const void* table = nullptr;
  std::shared_ptr<const void> owner{};  ///< of the table: a copy of the library's in this program's shape

  const scree_contact_model& contact_model() const { return *static_cast<const scree_contact_model*>(table); }
  const scree_wall& wall() const { return *static_cast<const scree_wall*>(table); }
  const scree_generator& generator() const { return *static_cast<const scree_generator*>(table); }
  const scree_process& process() const { return *static_cast<const scree_process*>(table); }
  const scree_writer& writer() const { return *static_cast<const scree_writer*>(table); }
  /// The property table of any kind.
  const scree_property* properties() const;
  uint32_t property_count() const;
};

/// A library file that discovery met, opened or not.
struct Found {
  Kind kind;
  std::string name;
  std::filesystem::path file;
  bool shadowed = false;  ///< another file of this name wins, because its folder was given on the command line
};

/// Where plug-ins are looked for, first match first.
struct SearchPath {
  std::vector<std::filesystem::path> command_line;  ///< --plugins DIR
  std::vector<std::filesystem::path> others;        ///< SCREE_PLUGIN_PATH, the user's data folder, the installation
  /// Reads SCREE_PLUGIN_PATH, XDG_DATA_HOME/HOME and the place of the running program.
  static SearchPath standard(std::vector<std::filesystem::path> command_line);
};

/// Finds plug-ins by kind and name and opens those that are asked for, after checks. [one thread]
class Catalogue {
 public:
  explicit Catalogue(SearchPath path);
  ~Catalogue();
  Catalogue(const Catalogue&) = delete;
  Catalogue& operator=(const Catalogue&) = delete;

  /// Opens `<dir>/<kind>/<name>.so` on first use. Throws Refusal(Exit::plugin) with the reason.
  const Component& open(Kind kind, const std::string& name);
  bool exists(Kind kind, const std::string& name) const;
  const std::vector<Found>& found() const;          ///< every file met, in search order; nothing is opened
  std::vector<std::string> names(Kind kind) const;  ///< for suggestions
  std::vector<const Component*> opened() const;     ///< in order of opening
  /// What is worth telling so far: shadowed files, libraries that did more than they should when they were opened.
  std::vector<std::string> warnings() const;
  std::function<void(const std::string&)> warn;  ///< called with each warning that comes when a library is opened

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree::core
