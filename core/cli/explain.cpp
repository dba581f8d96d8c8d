#include "core/run/explain.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "core/base/log.hpp"
#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/output.hpp"

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
    Simulation simulation(flags->scene.read(*catalogue), *catalogue, 1, static_cast<int>(detect_isa()));
    simulation.warn = simulation.engine.warn = [](const std::string& text) { log::write(log::Level::warning, text); };
    simulation.set_up();
    stand_before_first_cycle(simulation);
    const Explanation explanation = explain(simulation);
    print(flags->json ? to_json(explanation) : to_text(explanation));
    return Exit::done;
  };
}

}  // namespace scree::core
