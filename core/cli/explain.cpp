#include "core/run/explain.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/output.hpp"
#include "core/run/run.hpp"

namespace scree::core {

Deed declare_explain(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    SceneFlags scene;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  flags->scene.declare(app, true);
  declare_json(app, flags->json, "the explanation");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    const auto catalogue = flags->common.catalogue();
    Scene scene = flags->scene.read(*catalogue);
    for (const std::string& warning : scene.warnings) print_note(warning);
    const auto simulation = begin_scene(std::move(scene), *catalogue, {});
    stand_before_first_cycle(*simulation);
    const Explanation explanation = explain(*simulation);
    print(flags->json ? to_json(explanation) : to_text(explanation));
    return Exit::done;
  };
}

}  // namespace scree::core
