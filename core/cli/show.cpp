#include <CLI/CLI.hpp>
#include <memory>

#include "core/base/nearest.hpp"
#include "core/cli/command.hpp"
#include "core/cli/component_text.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/kinds.hpp"
#include "core/cli/output.hpp"

namespace scree::core {

namespace {

/// Of which kind the name is; a name may be of several.
Kind kind_of(const std::string& name, const std::optional<Kind>& wanted, const Catalogue& catalogue) {
  if (wanted) return *wanted;
  std::vector<Kind> kinds;
  std::vector<std::string> all;
  for (const Kind kind : all_kinds) {
    if (catalogue.exists(kind, name)) kinds.push_back(kind);
    const std::vector<std::string> names = catalogue.names(kind);
    all.insert(all.end(), names.begin(), names.end());
  }
  if (kinds.size() == 1) return kinds.front();
  if (kinds.empty()) {
    const std::string near = nearest_name(name, all);
    throw Refusal(Exit::plugin, "no plug-in '" + name + "' is installed" +
                                    (near.empty() ? "" : "; did you mean '" + near + "'?") +
                                    "  (scree list names those that are)");
  }
  throw Refusal(Exit::usage, "'" + name + "' is a " + kind_name(kinds[0]) + " and a " + kind_name(kinds[1]) +
                                 ": say which with --kind " + kind_name(kinds[0]));
}

}  // namespace

Deed declare_show(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    std::string name, kind;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  app.add_option("NAME", flags->name, "the plug-in")->required()->type_name("");
  app.add_option("--kind", flags->kind, "which kind, where a name is of several: " + kind_words())->type_name("KIND");
  declare_json(app, flags->json, "the plug-in");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    const std::optional<Kind> wanted = parse_kind(flags->kind);
    const auto catalogue = flags->common.catalogue();
    const Component& component = catalogue->open(kind_of(flags->name, wanted, *catalogue), flags->name);
    print(flags->json ? component_json(component) : component_text(component));
    return Exit::done;
  };
}

}  // namespace scree::core
