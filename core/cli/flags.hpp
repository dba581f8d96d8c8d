#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/log.hpp"
#include "core/plugin/catalogue.hpp"
#include "core/run/run.hpp"
#include "core/scene/scene.hpp"

namespace CLI {
class App;
}

namespace scree::core {

/// Flags of every command.
struct CommonFlags {
  std::vector<std::string> plugins;
  bool quiet = false, verbose = false, no_color = false;

  void declare(CLI::App& app);
  log::Settings log_settings() const;
  void open_log() const;
  std::unique_ptr<Catalogue> catalogue() const;  ///< its warnings go to stderr
};

/// A scene file and what replaces values in it.
struct SceneFlags {
  std::string file;
  std::vector<std::string> set;

  void declare(CLI::App& app, bool with_file);
  ReadOptions options() const;  ///< refuses a --set without a key
  Scene read(Catalogue& catalogue) const;
};

/// How a run is carried out; the texts are read by `options`, which says what is wrong with them.
struct RunFlags {
  std::string threads, isa, cycles, time_limit, patience, output, stage, from;
  bool restart = false;

  void declare(CLI::App& app);            ///< threads, isa, cycles, time limit, patience
  void declare_beginning(CLI::App& app);  ///< output, stage, from, restart
  RunOptions options(const CommonFlags& common) const;
};

/// --json of commands that print a result.
void declare_json(CLI::App& app, bool& json, const std::string& what);

/// The folder that holds bin/ with this program, as find_package wants it; "" when the system does not tell.
std::string program_prefix();

/// A folder with the data of the program (examples, configs, template): share/scree beside bin/ in the build tree as in
/// an installation; "" when there is none.
std::string data_folder();
/// Where scenes find fragments and files besides their own folder.
std::vector<std::string> installed_configs();

}  // namespace scree::core
