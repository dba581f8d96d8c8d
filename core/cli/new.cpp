#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/file.hpp"
#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/kinds.hpp"
#include "core/cli/output.hpp"
#include "core/cli/plugin_name.hpp"
#include "core/cli/schema.hpp"
#include "core/cli/template.hpp"

namespace scree::core {

namespace {

using Json = nlohmann::ordered_json;

struct Made {
  Kind kind;
  std::string name, folder;
  std::vector<std::string> files;
};

/// A path in the syntax of JSON strings, without the quotes around it.
std::string escaped(const std::string& path) {
  const std::string quoted = Json(path).dump(-1, ' ', false, Json::error_handler_t::replace);
  return quoted.substr(1, quoted.size() - 2);
}

Made make(Kind kind, const std::string& name, const std::string& parent, Catalogue& catalogue) {
  check_plugin_name(kind, name, catalogue);
  const std::string templates = data_folder() + "/template/";
  const std::string folder = parent.empty() ? name : (std::filesystem::path(parent) / name).string();
  Made made{kind, name, folder, {}};
  made.files = fill_template({templates + "all", templates + kind_name(kind)}, folder,
                             {{"plugin_name", name},
                              {"PluginName", struct_name(kind, name)},
                              {"plugin_kind", kind_name(kind)},
                              {"scree_prefix", escaped(program_prefix())}});
  const std::string schema = folder + "/scree.schema.json";
  if (const int failure = write_atomically(schema, schema_text(catalogue)); failure != 0)
    throw Refusal(Exit::io, schema + ": cannot write it: " + errno_text(failure) + ": make room and remove " + folder);
  made.files.emplace_back("scree.schema.json");
  return made;
}

std::vector<std::string> next_commands(const Made& made) {
  return {"cd " + made.folder, "cmake --preset scree", "cmake --build build",
          "ctest --test-dir build --output-on-failure"};
}

std::string text_of(const Made& made) {
  std::string out = "made the " + std::string(kind_name(made.kind)) + " '" + made.name + "' in " + made.folder + ":\n ";
  for (const std::string& file : made.files) out += " " + file;
  out += "\nnow build and test it; README.md says more:\n";
  for (const std::string& command : next_commands(made)) out += "  " + command + "\n";
  return out;
}

std::string json_of(const Made& made) {
  const Json out{{"kind", kind_name(made.kind)},
                 {"name", made.name},
                 {"folder", made.folder},
                 {"files", made.files},
                 {"next", next_commands(made)}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Deed declare_new(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    std::string kind, name, parent;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  app.add_option("KIND", flags->kind, "what it is to be: " + kind_words())->required()->type_name("");
  app.add_option("NAME", flags->name, "what scenes will call it, as in rolling_disc")->required()->type_name("");
  app.add_option("-o,--output", flags->parent, "where to make the folder NAME; by default in the working directory")
      ->type_name("DIR");
  declare_json(app, flags->json, "what was made");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    const std::optional<Kind> kind = parse_kind(flags->kind);
    if (!kind) throw Refusal(Exit::usage, "'' is no kind of plug-in  (" + kind_words() + ")");
    const auto catalogue = flags->common.catalogue();
    const Made made = make(*kind, flags->name, flags->parent, *catalogue);
    print(flags->json ? json_of(made) : text_of(made));
    return Exit::done;
  };
}

}  // namespace scree::core
