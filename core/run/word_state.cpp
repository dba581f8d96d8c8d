#include "core/run/word_state.hpp"

#include "core/run/section_check.hpp"
#include "core/run/use_state.hpp"

namespace scree::core {

namespace {

void save_vars(const std::map<std::string, double>& vars, ArchiveWriter& out) {
  Packer packer;
  packer.u64(vars.size());
  for (const auto& [name, value] : vars) {
    packer.text(name);
    packer.f64(value);
  }
  out.put("words/vars", packer.bytes());
}

std::map<std::string, double> read_vars(const ArchiveReader& archive) {
  Unpacker in(archive, "words/vars");
  std::map<std::string, double> vars;
  for (uint64_t left = in.count(16); left > 0; --left) {
    const std::string name = in.text();
    vars[name] = in.f64();
  }
  in.finish();
  return vars;
}

template <class F>
void each_word(const ArchiveReader& archive, const char* section, Simulation& simulation, F f) {
  const auto vars = read_vars(archive);
  Unpacker in(archive, section);
  UseReader reader{in, simulation.catalogue, vars};
  const uint64_t count = in.count();
  for (uint64_t k = 0; k < count; ++k) f(reader, static_cast<std::size_t>(k), in);
  in.finish();
}

}  // namespace

void save_words(const Simulation& simulation, ArchiveWriter& out) {
  save_vars(simulation.scene.vars, out);
  out.put_texts("groups", simulation.groups.leaves());
  std::vector<std::string> walls, processes;
  for (const Wall& wall : simulation.engine.walls) walls.push_back(wall.name);
  for (const Process& process : simulation.engine.processes) processes.push_back(process.name);
  out.put_texts("words/wall_names", walls);
  out.put_texts("words/process_names", processes);
  const auto put = [&](const char* section, const auto& items) {
    Packer packer;
    packer.u64(items.size());
    for (const auto& item : items) pack(packer, item);
    out.put(section, packer.bytes());
  };
  put("words/walls", simulation.wall_uses);
  put("words/processes", simulation.process_uses);
  put("words/balls", simulation.ball_sets);
  put("words/rules", simulation.rules);
  out.put("words/precedence", simulation.precedence);
}

void load_groups(Simulation& simulation, const ArchiveReader& in) {
  simulation.groups.restore(in.get_texts("groups"));
  want(simulation.groups.size() < no_rule, in, "groups", "there are too many groups");
}

void load_ball_sets(Simulation& simulation, const ArchiveReader& in) {
  simulation.ball_sets.clear();
  each_word(in, "words/balls", simulation,
            [&](UseReader& reader, std::size_t, Unpacker&) { simulation.ball_sets.push_back(reader.ball_set()); });
}

void load_words(Simulation& simulation, const ArchiveReader& in) {
  load_groups(simulation, in);
  const std::vector<std::string> walls = in.get_texts("words/wall_names");
  want(walls.size() < no_rule, in, "words/wall_names", "there are too many walls");
  each_word(in, "words/walls", simulation, [&](UseReader& reader, std::size_t k, Unpacker& section) {
    if (k >= walls.size()) section.refuse("it holds more walls than there are names");
    WallUse wall;
    wall.name = walls[k];
    wall.wall = reader.use(Kind::wall);
    simulation.add_wall(wall);
  });
  simulation.ball_sets.clear();
  each_word(in, "words/balls", simulation,
            [&](UseReader& reader, std::size_t, Unpacker&) { simulation.ball_sets.push_back(reader.ball_set()); });
  simulation.rules.clear();
  each_word(in, "words/rules", simulation,
            [&](UseReader& reader, std::size_t, Unpacker&) { simulation.rules.push_back(reader.rule()); });
  want(simulation.rules.size() < no_rule, in, "words/rules", "there are too many rules");
  simulation.precedence = in.get<uint16_t>("words/precedence");
  for (uint16_t index : simulation.precedence)
    want(index < simulation.rules.size(), in, "words/precedence", "a rule does not exist");
}

void load_process_words(Simulation& simulation, const ArchiveReader& in) {
  const std::vector<std::string> names = in.get_texts("words/process_names");
  each_word(in, "words/processes", simulation, [&](UseReader& reader, std::size_t k, Unpacker& section) {
    if (k >= names.size()) section.refuse("it holds more processes than there are names");
    ProcessUse process;
    process.name = names[k];
    process.process = reader.use(Kind::process);
    simulation.add_process(process);
  });
}

}  // namespace scree::core
