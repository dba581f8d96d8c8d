#include <fstream>
#include <map>

#include "core/base/isa.hpp"
#include "core/run/explain.hpp"
#include "unit/run/saved_run.hpp"

// Properties drawn for each contact or ball: their values depend on the seed, the rule, the property and who meets, and
// on nothing else. The reference is always the same run in another way.

using namespace scree::core;
using namespace support;

namespace {

using Pair = std::pair<uint64_t, uint64_t>;

const char* const drawn = R"(scree: 1
seed: 7
timestep: 1e-5
walls: {floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}}
balls:
  sand: {generator: file, path: balls.csv, density: 2600, velocity: [0.4, 0.1, -1],
         contact: {fric: {uniform: {low: 0.2, high: 0.6}}}}
contacts:
  - {name: all, between: [sand, [sand, floor]], model: linear, kn: {weibull: {shape: 3, scale: 2e5}}, ks: 1e5,
     dp_nratio: {normal: {mean: 0.2, sd: 0.2}}, fric: {normal: {mean: 0.4, sd: 0.1, high: 0.5}}}
stages:
  - first:
    - cycle: 10
    - set: {contacts.all.ks: {normal: {mean: 1e5, sd: 3e4, low: 2e4}}}
)";

/// 64 balls on a lattice that overlap a little, in the order of `step`: 1 as numbered, 5 or 23 mixed.
void write_balls(const std::string& path, std::size_t step) {
  std::ofstream file(path);
  file << "id,radius,x,y,z\n";
  for (std::size_t k = 0; k < 64; ++k) {
    const std::size_t site = k * step % 64;
    file << site + 1 << ",0.01005," << 0.02 * static_cast<double>(site % 4) << ","
         << 0.02 * static_cast<double>(site / 4 % 4) << "," << 0.01 + 0.02 * static_cast<double>(site / 16) << "\n";
  }
}

/// The scene with plug-ins of this build, set up and some cycles old.
struct Run {
  Run(const std::string& text, std::size_t order, unsigned threads, int isa, uint64_t cycles)
      : catalogue(plugins_of_build()), simulation(scene(text, order), catalogue, threads, isa) {
    simulation.set_up();
    simulation.prepare();
    run(simulation, cycles);
  }
  Scene scene(const std::string& text, std::size_t order) {
    write_balls(folder / "balls.csv", order);
    write_text(folder / "scene.yaml", text);
    return read_scene({folder / "scene.yaml", "", {}, {}}, catalogue);
  }

  std::vector<double> words(uint32_t row1, uint32_t row2, const Wall* wall, uint64_t bonding = 0) const {
    const Balls& balls = simulation.engine.balls;
    const bool turned = wall == nullptr && balls.id()[row1] > balls.id()[row2];
    Birth birth;
    birth.row1 = turned ? row2 : row1;
    birth.row2 = wall != nullptr ? no_row : turned ? row1 : row2;
    birth.wall = wall;
    birth.r1 = balls[Column::radius][birth.row1];
    birth.r2 = wall != nullptr ? 0 : balls[Column::radius][birth.row2];
    birth.mass = 1;
    birth.bonding = bonding;
    const BoundRule& rule = simulation.engine.contacts.book.rules[0];
    std::vector<double> words = rule.words;
    rule.vary(birth, words.data());
    return words;
  }

  /// All words of every pair, by id; 0 is the floor.
  std::map<Pair, std::vector<double>> all() const {
    const Engine& engine = simulation.engine;
    std::map<Pair, std::vector<double>> out;
    for (uint32_t a = 0; a < engine.balls.size(); ++a) {
      out[{0, engine.balls.id()[a]}] = words(a, no_row, &engine.walls[0]);
      for (uint32_t b = 0; b < engine.balls.size(); ++b)
        if (engine.balls.id()[a] < engine.balls.id()[b])
          out[{engine.balls.id()[a], engine.balls.id()[b]}] = words(a, b, nullptr);
    }
    return out;
  }

  TemporaryFolder folder;
  Catalogue catalogue;
  Simulation simulation;
};

}  // namespace

TEST_CASE("a drawn property depends on who meets and not on order, threads or time", "[draws]") {
  const Run reference(drawn, 1, 1, 0, 0);
  const auto expected = reference.all();
  REQUIRE(expected.size() == 64 * 63 / 2 + 64);
  // Stiffnesses of different contacts differ, those of walls too.
  std::map<double, int> seen;
  for (const auto& [pair, words] : expected) ++seen[words[0]];
  CHECK(seen.size() > expected.size() - 3);
  CHECK(Run(drawn, 23, 1, 0, 0).all() == expected);
  CHECK(Run(drawn, 5, 3, static_cast<int>(detect_isa()), 300).all() == expected);
  CHECK(Run(replaced(drawn, "seed: 7", "seed: 8"), 1, 1, 0, 0).all() != expected);
  const std::string renamed = replaced(replaced(drawn, "name: all", "name: every"), "contacts.all", "contacts.every");
  CHECK(Run(renamed, 1, 1, 0, 0).all() != expected);
  CHECK(reference.words(3, 4, nullptr, 1) != reference.words(3, 4, nullptr, 0));
}

TEST_CASE("a run with drawn properties has the same bits with any number of threads", "[draws]") {
  REQUIRE(Run(drawn, 1, 1, 0, 20).simulation.engine.contacts.active() > 40);
  const Run reference(drawn, 1, 1, 0, 400);
  for (unsigned threads = 2; threads <= 4; ++threads)
    CHECK(Run(drawn, 1, threads, static_cast<int>(detect_isa()), 400).simulation.engine.state_hash() ==
          reference.simulation.engine.state_hash());
}

TEST_CASE("a drawn property acts, and a property that is set is drawn anew with the same chance", "[draws]") {
  Run with(drawn, 1, 1, 0, 0);
  const auto before = with.all();
  const Action& set = with.simulation.scene.stages.at(0).actions.at(1);
  with.simulation.edit(set);
  const auto after = with.all();
  std::size_t differ = 0;
  for (const auto& [pair, words] : after) {
    CHECK(words[0] == before.at(pair)[0]);
    CHECK(words[1] >= 2e4);
    differ += words[1] != before.at(pair)[1];
  }
  CHECK(differ == after.size());
  with.simulation.edit(set);
  CHECK(with.all() == after);
  const Run plain(replaced(drawn, "kn: {weibull: {shape: 3, scale: 2e5}}", "kn: 2e5"), 1, 1, 0, 200);
  run(with.simulation, 200);
  CHECK(with.simulation.engine.state_hash() != plain.simulation.engine.state_hash());
}

TEST_CASE("a run with drawn properties is resumed with the same bits", "[draws]") {
  const TemporaryFolder folder;
  Run saved(drawn, 1, 1, 0, 150);
  saved.simulation.edit(saved.simulation.scene.stages.at(0).actions.at(1));
  run(saved.simulation, 50);
  save(saved.simulation, folder / "state");
  run(saved.simulation, 200);
  const ArchiveReader in(folder / "state");
  Simulation loaded(saved_scene(in, saved.catalogue), saved.catalogue, 2, static_cast<int>(detect_isa()));
  load_state(loaded, in);
  run(loaded, 200);
  CHECK(loaded.engine.state_hash() == saved.simulation.engine.state_hash());
}

TEST_CASE("balls draw a contact property once, whatever their order", "[draws]") {
  const std::string text = replaced(drawn, ", fric: {normal: {mean: 0.4, sd: 0.1, high: 0.5}}", "");
  const Run one(text, 1, 1, 0, 0), other(text, 23, 1, 0, 0);
  std::map<uint64_t, double> first, second;
  const auto read = [](const Run& run, std::map<uint64_t, double>& out) {
    const Balls& balls = run.simulation.engine.balls;
    for (std::size_t row = 0; row < balls.size(); ++row) out[balls.id()[row]] = balls.properties().at("fric")[row];
  };
  read(one, first);
  read(other, second);
  CHECK(first == second);
  for (const auto& [id, fric] : first) {
    CHECK(fric >= 0.2);
    CHECK(fric < 0.6);
  }
  CHECK(one.all() == other.all());
}

TEST_CASE("explain tells what is drawn and what bounds do to it", "[draws]") {
  Run told(drawn, 1, 1, 0, 0);
  std::string steps;
  for (const auto& phase : explain(told.simulation).cycle)
    for (const std::string& step : phase.steps) steps += step + "\n";
  INFO(steps);
  CHECK(steps.find("all.kn of each contact: weibull, shape 3, scale 200000 N/m\n") != std::string::npos);
  CHECK(steps.find("all.dp_nratio of each contact: normal, mean 0.2, sd 0.2; cut to [0, ") != std::string::npos);
  CHECK(steps.find("which keeps 84.1") != std::string::npos);
  CHECK(steps.find("sand.fric of each ball, in SI units: uniform, from 0.2 to 0.6\n") != std::string::npos);
}
