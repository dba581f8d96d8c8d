#include "core/run/run.hpp"

#include <algorithm>
#include <filesystem>

#include "core/base/log.hpp"
#include "core/base/threads.hpp"
#include "core/run/session.hpp"
#include "core/run/signals.hpp"
#include "core/run/state.hpp"
#include "core/run/target_check.hpp"

namespace scree::core {

namespace {

std::string default_folder(const std::string& scene) {
  return scene.empty() ? "scree.out" : std::filesystem::path(scene).stem().string() + ".out";
}

// A saved state is named with or without its ending.
std::string state_file(const std::string& name) {
  return std::filesystem::exists(name) || name.ends_with(".scree") ? name : name + ".scree";
}

std::string start_state(const Scene& scene, const RunOptions& options) {
  if (!options.from.empty()) return state_file(options.from);
  if (!scene.start_state) return "";
  const std::filesystem::path path(scene.start_state->text);
  return state_file(path.is_absolute() ? path.string()
                                       : (std::filesystem::path(scene.file).parent_path() / path).string());
}

// How many balls a scene will have is known only after its generators ran, and a team cannot grow: threads follow the
// cores, and a scene of few blocks leaves the others asleep.
std::unique_ptr<Simulation> make(Scene scene, Catalogue& catalogue, const RunOptions& options) {
  const unsigned threads = options.threads > 0 ? options.threads : usable_cores();
  auto simulation = std::make_unique<Simulation>(std::move(scene), catalogue, threads, static_cast<int>(options.isa));
  simulation->warn = [](const std::string& text) { log::warning("{}", text); };
  simulation->tell = [](const std::string& text) { log::info("{}", text); };
  return simulation;
}

void open_log(OutputFolder& folder, const Scene& scene) {
  if (!log::open_file(folder.file("log.txt"))) log::warning("cannot write {}", folder.file("log.txt"));
  if (!folder.moved_to().empty()) log::info("the earlier results are now in {}", folder.moved_to());
  for (std::string warning : scene.warnings) {
    // The reader says "file:line:column: warning: ..." as compilers do; the log has a word of its own for it.
    const std::string word = " warning:";
    if (const std::size_t at = warning.find(word); at != std::string::npos) warning.erase(at, word.size());
    log::warning("{}", warning);
  }
}

}  // namespace

std::unique_ptr<Simulation> begin_scene(Scene scene, Catalogue& catalogue, const RunOptions& options) {
  const std::string state = start_state(scene, options);
  auto simulation = make(std::move(scene), catalogue, options);
  if (state.empty()) {
    simulation->set_up();
    simulation->prepare();
  } else {
    load_specimen(*simulation, ArchiveReader(state));
  }
  targets_exist(*simulation);
  return simulation;
}

RunResult run_scene(Scene scene, Catalogue& catalogue, const RunOptions& options) {
  auto simulation = begin_scene(std::move(scene), catalogue, options);
  // What the first cycle would refuse, such as a step above the stable limit, is refused before a folder is there; an
  // edit that comes first may still change what the first cycle is.
  const auto& stages = simulation->scene.stages;
  const bool runs_first =
      stages.empty() || stages[0].actions.empty() || std::holds_alternative<RunAction>(stages[0].actions[0].what);
  if (simulation->engine.balls.size() > 0 && runs_first) simulation->engine.detect();
  const std::string path = options.output.empty() ? default_folder(simulation->scene.file) : options.output;
  OutputFolder folder = OutputFolder::create(path, options.restart);
  open_log(folder, simulation->scene);
  const std::string resolved = simulation->scene.resolved;
  if (!folder.files().replace("scene.resolved.yaml", resolved.data(), resolved.size()))
    log::warning("{}", folder.files().error());
  Session session(std::move(simulation), std::move(folder), options);
  return session.run();
}

RunResult resume_run(const std::string& path, Catalogue& catalogue, const RunOptions& options, bool previous) {
  OutputFolder folder = OutputFolder::resume(path);
  const CheckpointFiles checkpoints(path);
  const ArchiveReader archive = previous ? checkpoints.open_previous() : checkpoints.open_latest();
  set_last_checkpoint(archive.path());
  Scene scene = saved_scene(archive, catalogue, options.allow_plugin_change, options.include_dirs);
  auto simulation = make(std::move(scene), catalogue, options);
  load_state(*simulation, archive);
  open_log(folder, simulation->scene);
  const auto names = archive.get_texts("files/names");
  const auto sizes = archive.get<uint64_t>("files/sizes", names.size());
  const auto replaced = archive.get<uint8_t>("files/replaced", names.size());
  std::vector<FileRecord> files;
  for (std::size_t k = 0; k < names.size(); ++k) files.push_back({names[k], sizes[k], replaced[k] != 0});
  for (const std::string& remark : folder.files().cut_back(files)) log::warning("{}", remark);
  log::info("goes on from cycle {} of {}", simulation->engine.clock.cycle, archive.path());
  Session session(std::move(simulation), std::move(folder), options);
  session.restore(archive);
  return session.run();
}

}  // namespace scree::core
