#include "core/run/run.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/report.hpp"
#include "core/run/signals.hpp"

namespace scree::core {

Deed declare_run(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    SceneFlags scene;
    RunFlags run;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  flags->scene.declare(app, true);
  flags->run.declare_beginning(app);
  flags->run.declare(app);
  declare_json(app, flags->json, "the summary");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    const RunOptions options = flags->run.options(flags->common);
    const auto catalogue = flags->common.catalogue();
    Scene scene = flags->scene.read(*catalogue);
    install_signal_handlers();
    return print_result(run_scene(std::move(scene), *catalogue, options), flags->json);
  };
}

}  // namespace scree::core
