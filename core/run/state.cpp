#include "core/run/state.hpp"

#include <filesystem>

#include "core/base/hash.hpp"
#include "core/run/ball_state.hpp"
#include "core/run/bound_state.hpp"
#include "core/run/engine_state.hpp"
#include "core/run/packing.hpp"
#include "core/run/plugin_state.hpp"
#include "core/run/section_check.hpp"
#include "core/run/word_state.hpp"

namespace scree::core {

namespace {

void save_scene(const Scene& scene, ArchiveWriter& out) {
  std::error_code error;
  const auto file = std::filesystem::absolute(scene.file, error);
  out.put_text("scene/file", error || scene.file.empty() ? scene.file : file.string());
  out.put_text("scene/text", scene.resolved);
  out.put_value<uint64_t>("scene/hash", hash64(scene.resolved));
}

void save_position(const Position& position, ArchiveWriter& out) {
  Packer packer;
  packer.u64(position.stage);
  packer.u64(position.action);
  packer.flag(position.inside);
  packer.u64(position.start_cycle);
  packer.f64(position.start_time);
  packer.u64(position.extreme.size());
  packer.f64s(position.extreme.data(), position.extreme.size());
  out.put("position", packer.bytes());
}

Position read_position(const ArchiveReader& archive, const Scene& scene) {
  Unpacker in(archive, "position");
  Position position;
  position.stage = in.u64();
  position.action = in.u64();
  position.inside = in.flag();
  position.start_cycle = in.u64();
  position.start_time = in.f64();
  position.extreme.resize(static_cast<std::size_t>(in.count()));
  in.f64s(position.extreme.data(), position.extreme.size());
  in.finish();
  const uint64_t stages = scene.stages.size();
  if (position.stage > stages || (position.stage == stages && (position.action > 0 || position.inside)))
    in.refuse("it lies behind the last stage");
  if (position.stage == stages) return position;
  const auto& actions = scene.stages[static_cast<std::size_t>(position.stage)].actions;
  if (position.action > actions.size()) in.refuse("it lies behind the last action of its stage");
  if (!position.inside) return position;
  const auto* run = position.action == actions.size()
                        ? nullptr
                        : std::get_if<RunAction>(&actions[static_cast<std::size_t>(position.action)].what);
  if (run == nullptr) in.refuse("it lies inside an action that does not run");
  if (!position.extreme.empty() && position.extreme.size() != run->until.size())
    in.refuse("it has another number of tests than its action");
  return position;
}

}  // namespace

void save_state(const Simulation& simulation, ArchiveWriter& out) {
  save_scene(simulation.scene, out);
  save_plugins(simulation.catalogue, out);
  save_words(simulation, out);
  save_bound(simulation.engine.contacts.book, out);
  save_position(simulation.position, out);
  save_engine(simulation.engine, out);
}

Scene saved_scene(const ArchiveReader& in, Catalogue& catalogue, bool allow_plugin_change,
                  const std::vector<std::string>& include_dirs) {
  const std::vector<std::string> changed = check_plugins(in, catalogue, allow_plugin_change);
  const std::string text = in.get_text("scene/text");
  want(hash64(text) == in.get_value<uint64_t>("scene/hash"), in, "scene/text",
       "its hash is not the one that was saved");
  Scene scene = read_scene({in.get_text("scene/file"), text, {}, include_dirs}, catalogue);
  for (const std::string& plugin : changed)
    scene.warnings.push_back(in.path() + ": warning: " + plugin + " changed since the state was saved");
  return scene;
}

void load_state(Simulation& simulation, const ArchiveReader& in) {
  Engine& engine = simulation.engine;
  load_words(simulation, in);
  load_balls(engine.balls, in, simulation.groups.size());
  load_process_words(simulation, in);
  simulation.bind_rules();
  load_bound(engine.contacts.book, in);
  engine.warn = simulation.warn;
  simulation.prepare_processes();
  load_engine(engine, in, simulation.groups.size());
  simulation.position = read_position(in, simulation.scene);
}

}  // namespace scree::core
