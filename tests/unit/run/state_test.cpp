#include <functional>
#include <random>

#include "core/base/isa.hpp"
#include "unit/run/saved_run.hpp"

// What is checked here needs no closed form: a run that was saved, loaded and continued must have the same bits as the
// run that went on, so the uninterrupted run is the reference.

using namespace scree::core;
using namespace support;

namespace {

const char* const flow = R"(scree: 1
vars: {edge: 0.06}
seed: 7
cell: {low: [0, 0, -0.01], high: [edge, edge, 0.1], periodic: [x, y]}
skin: 0.4 mm
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1], spin: [0, 0, 40]}
  lid: {wall: plane, point: [0, 0, 0.045], normal: [0, 0, -1], velocity: [0.3, 0, -0.5]}
balls:
  sand: {generator: random, box: [[0, 0, 0], [edge, edge, 0.042]], radius: [3 mm, 4.2 mm], count: 200, density: 2600,
         velocity: [1, 0.3, -2], contact: {fric: "0.3 + x"}}
contacts:
  - {name: grains, between: [sand, sand], model: linear, kn: 2e5, ks: 1e5, dp_nratio: 0.3}
  - {name: sides, between: [sand, walls], model: linear, kn: 2e5, ks: 1e5, fric: 0.5, dp_nratio: 0.3}
processes:
  pull: {process: gravity, acceleration: [20, 0, -400]}
  damping: {process: local_damping, factor: 0.1}
stages:
  - first:
    - cycle: 10
    - set: {contacts.grains.kn: 3e5}
    - fix: {balls: sand, where: "id < 6"}
    - set: {processes.damping.factor: 0.3}
    - apply: {balls: sand, force: [0, 0, -0.01], where: "z > 0.02"}
    - delete: {balls: sand, where: "z > 0.03"}
    - delete: {walls: lid}
    - add: {walls: {cover: {wall: plane, point: [0, 0, 0.045], normal: [0, 0, -1], velocity: [0, 0, -1]}}}
    - add: {contacts: [{name: soft, between: [sand, cover], model: linear, kn: 1e5, ks: 0, fric: 0}]}
    - set: {balls.sand.velocity: [0, 0, 2]}
    - set: {walls.cover.velocity: [0, 0, -2]}
    - set: {timestep: 1e-6}
    - delete: {processes: pull}
)";

Scene scene_of(const std::string& text, Catalogue& catalogue) { return read_scene({"", text, {}, {}}, catalogue); }

/// The hash after loading and `cycles` more, with another thread count and instruction set.
uint64_t continued(const std::string& path, Catalogue& catalogue, uint64_t cycles, unsigned threads, int isa,
                   const std::function<void(Simulation&)>& first = {}) {
  const ArchiveReader in(path);
  Simulation simulation(saved_scene(in, catalogue), catalogue, threads, isa);
  load_state(simulation, in);
  if (first) first(simulation);
  run(simulation, cycles);
  return simulation.engine.state_hash();
}

const std::vector<Action>& actions_of(const Simulation& simulation) { return simulation.scene.stages.at(0).actions; }

}  // namespace

TEST_CASE("a run saved at any cycle goes on with the same bits") {
  const TemporaryFolder folder;
  Catalogue catalogue(plugins_of_build());
  Simulation simulation(scene_of(flow, catalogue), catalogue, 1, 0);
  simulation.set_up();
  simulation.prepare();
  run(simulation, 1200);
  REQUIRE(simulation.engine.contacts.active() > 50);
  const uint64_t rebuilds = simulation.engine.rebuilds();
  constexpr uint64_t saves = 40, end = 60;
  for (uint64_t k = 0; k < saves; ++k) {
    // Every second time the forces of this time are there already, as at the end of an action.
    if (k % 2 == 1) simulation.engine.forces();
    REQUIRE(simulation.engine.forces_current() == (k % 2 == 1));
    save(simulation, folder / std::to_string(k));
    run(simulation, 1);
  }
  run(simulation, end - saves);
  const uint64_t hash = simulation.engine.state_hash();
  CHECK(simulation.engine.rebuilds() > rebuilds + 2);
  for (uint64_t k = 0; k < saves; ++k) {
    INFO("saved after " << k << " cycles");
    CHECK(continued(folder / std::to_string(k), catalogue, end - k, 1 + static_cast<unsigned>(k % 3),
                    static_cast<int>(detect_isa()), [&](Simulation& loaded) {
                      CHECK(loaded.engine.balls.size() == 200);
                      CHECK(loaded.engine.contacts.active() > 0);
                    }) == hash);
  }
}

TEST_CASE("saving changes nothing, and loading gives back what was saved") {
  const TemporaryFolder folder;
  Catalogue catalogue(plugins_of_build());
  Simulation one(scene_of(flow, catalogue), catalogue, 1, 0), two(scene_of(flow, catalogue), catalogue, 1, 0);
  for (Simulation* simulation : {&one, &two}) {
    simulation->set_up();
    simulation->prepare();
  }
  for (int k = 0; k < 150; ++k) {
    run(one, 1);
    if (k % 3 == 0) one.engine.forces();
    save(one, folder / "a");
    run(two, 1);
  }
  CHECK(one.engine.state_hash() == two.engine.state_hash());
  one.position = {0, 0, true, 17, 0.25, {}};
  save(one, folder / "a");
  const ArchiveReader in(folder / "a");
  Simulation loaded(saved_scene(in, catalogue), catalogue, 2, 0);
  load_state(loaded, in);
  CHECK(loaded.position.inside);
  CHECK(loaded.position.start_cycle == 17);
  CHECK(loaded.engine.clock.time() == one.engine.clock.time());
  CHECK(loaded.engine.contact_updates() == one.engine.contact_updates());
  CHECK(loaded.engine.balls.next_id == 201);
  save(loaded, folder / "b");
  const ArchiveReader again(folder / "b");
  REQUIRE(again.names() == in.names());
  CHECK(read_text(folder / "a") == read_text(folder / "b"));
}

TEST_CASE("blocks that share contacts go on with the same bits on any number of threads") {
  const TemporaryFolder folder;
  Catalogue catalogue(plugins_of_build());
  std::string text = replaced(flow, "count: 200", "count: 2500");
  text = replaced(text, "edge: 0.06", "edge: 0.14");
  text = replaced(replaced(text, "0.042]]", "0.1]]"), "0, 0.045]", "0, 0.11]");
  text = replaced(text, "edge, 0.1]", "edge, 0.2]");
  Simulation simulation(scene_of(text, catalogue), catalogue, 2, 0);
  simulation.set_up();
  simulation.prepare();
  run(simulation, 800);
  REQUIRE(simulation.engine.contacts.slices().blocks() == 3);
  for (int k = 0; k < 4; ++k) {
    if (k % 2 == 0) simulation.engine.forces();
    save(simulation, folder / std::to_string(k));
    run(simulation, 3);
  }
  run(simulation, 10);
  for (unsigned k = 0; k < 4; ++k)
    CHECK(continued(folder / std::to_string(k), catalogue, 10 + 3 * (4 - k), 4 - k, static_cast<int>(k % 2)) ==
          simulation.engine.state_hash());
}

TEST_CASE("what edits made of the scene is saved too") {
  const TemporaryFolder folder;
  Catalogue catalogue(plugins_of_build());
  Simulation simulation(scene_of(flow, catalogue), catalogue, 1, 0);
  simulation.set_up();
  simulation.prepare();
  run(simulation, 1200);
  const auto& actions = actions_of(simulation);
  const auto go_on = [&](Simulation& loaded, std::size_t from) {
    for (std::size_t k = from; k < actions.size(); ++k) {
      loaded.edit(actions_of(loaded)[k]);
      run(loaded, k % 3);
    }
    run(loaded, 40);
  };
  for (std::size_t k = 1; k < actions.size(); ++k) {
    save(simulation, folder / (std::to_string(k) + "before"));
    simulation.edit(actions[k]);
    save(simulation, folder / (std::to_string(k) + "after"));
    run(simulation, k % 3);
  }
  run(simulation, 40);
  const uint64_t hash = simulation.engine.state_hash();
  for (std::size_t k = 1; k < actions.size(); ++k) {
    INFO("action " << k);
    CHECK(continued(folder / (std::to_string(k) + "before"), catalogue, 0, 2, 0,
                    [&](Simulation& loaded) { go_on(loaded, k); }) == hash);
    CHECK(continued(folder / (std::to_string(k) + "after"), catalogue, 0, 1, 0, [&](Simulation& loaded) {
            run(loaded, k % 3);
            go_on(loaded, k + 1);
          }) == hash);
  }
}
