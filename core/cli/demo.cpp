#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/report.hpp"
#include "core/run/run.hpp"
#include "core/run/signals.hpp"

namespace scree::core {

namespace {

std::string demo_scene() {
  const std::string data = data_folder(), file = data + "/examples/demo/demo.yaml";
  if (data.empty() || !std::filesystem::exists(file))
    throw Refusal(Exit::io, "the demo scene is not installed: share/scree/examples/demo/demo.yaml is missing beside " +
                                std::string("the program's bin folder: install scree again"));
  return file;
}

}  // namespace

Deed declare_demo(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    SceneFlags scene;
    RunFlags run;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  flags->scene.declare(app, false);
  flags->run.declare_beginning(app);
  flags->run.declare(app);
  declare_json(app, flags->json, "the summary");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    RunOptions options = flags->run.options(flags->common);
    if (options.output.empty()) options.output = "demo.out";
    flags->scene.file = demo_scene();
    const auto catalogue = flags->common.catalogue();
    Scene scene = flags->scene.read(*catalogue);
    install_signal_handlers();
    return print_result(run_scene(std::move(scene), *catalogue, options), flags->json);
  };
}

}  // namespace scree::core
