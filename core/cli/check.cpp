#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/log.hpp"
#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/output.hpp"
#include "core/run/explain.hpp"
#include "core/run/fields.hpp"
#include "core/run/quantities.hpp"
#include "core/run/run.hpp"

namespace scree::core {

namespace {

std::string counted(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

std::string ok_text(const Simulation& simulation) {
  std::string out = simulation.scene.file + ": ok (" + counted(simulation.engine.balls.size(), "ball") + ", " +
                    counted(simulation.engine.walls.size(), "wall") + ", " + counted(simulation.rules.size(), "rule") +
                    ", " + counted(simulation.scene.stages.size(), "stage");
  if (simulation.engine.step.step() > 0) out += fmt::format(", step {:.6g} s", simulation.engine.step.step());
  return out + ")\n";
}

std::string ok_json(const Simulation& simulation, const std::vector<std::string>& warnings) {
  nlohmann::ordered_json json{{"scene", simulation.scene.file},          {"ok", true},
                              {"balls", simulation.engine.balls.size()}, {"walls", simulation.engine.walls.size()},
                              {"rules", simulation.rules.size()},        {"stages", simulation.scene.stages.size()}};
  if (simulation.engine.step.step() > 0) json["timestep"] = simulation.engine.step.step();
  json["warnings"] = warnings;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Names that only the pieces of the scene tell: quantities and fields.
void check_records(Simulation& simulation) {
  Quantities(simulation).check_scene();
  for (const Record& record : simulation.scene.record) chosen_fields(record.fields, record.name);
}

}  // namespace

Deed declare_check(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    SceneFlags scene;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  flags->scene.declare(app, true);
  declare_json(app, flags->json, "the answer");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    const auto catalogue = flags->common.catalogue();
    Scene scene = flags->scene.read(*catalogue);
    std::vector<std::string> warnings = scene.warnings;
    for (const std::string& warning : warnings) print_note(warning);
    const auto simulation = begin_scene(std::move(scene), *catalogue, {});
    check_records(*simulation);
    stand_before_first_cycle(*simulation);
    print(flags->json ? ok_json(*simulation, warnings) : ok_text(*simulation));
    return Exit::done;
  };
}

}  // namespace scree::core
