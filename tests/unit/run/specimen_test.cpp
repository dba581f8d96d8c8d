#include <cmath>
#include <map>
#include <memory>

#include "unit/run/saved_run.hpp"

// `start: {state}`: the reference is the run that the state was saved from, going on.

using namespace scree::core;
using namespace support;

namespace {

const char* const head = R"(scree: 1
timestep: 4e-6
walls:
  floor: {wall: plane, point: [0, 0, 0.0002], normal: [0, 0, 1], velocity: [0.2, 0, 0]}
)";
const char* const balls = R"(balls:
  sand: {generator: lattice, kind: fcc, radius: 3 mm, spacing: 5.9 mm, box: [[0, 0, 0], [0.03, 0.03, 0.02]],
         density: 2600, spin: [30, 0, 10], contact: {fric: "0.3 + x"}}
)";
const char* const tail = R"(contacts:
  - {name: grains, between: [sand, sand], model: linear, kn: 2e5, ks: 1e5}
  - {name: sides, between: [sand, floor], model: linear, kn: 2e5, ks: 1e5, fric: 0.5}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
stages: [{settle: [{cycle: 100}]}]
)";

/// Sum of the sizes of what contacts remember.
double memory(const Simulation& simulation) {
  double sum = 0;
  for (const TouchList& list : simulation.engine.contacts.lists())
    for (const auto& column : list.state)
      for (double value : column) sum += std::abs(value);
  for (const WallList& list : simulation.engine.contacts.wall_lists())
    for (double value : list.state) sum += std::abs(value);
  return sum;
}

double distance(const Simulation& a, const Simulation& b) {
  std::map<uint64_t, std::size_t> row;
  for (std::size_t k = 0; k < a.engine.balls.size(); ++k) row[a.engine.balls.id()[k]] = k;
  double most = 0;
  for (std::size_t k = 0; k < b.engine.balls.size(); ++k)
    for (Column c : {Column::x, Column::y, Column::z})
      most = std::max(most, std::abs(b.engine.balls[c][k] - a.engine.balls[c][row.at(b.engine.balls.id()[k])]));
  return most;
}

struct Bench {
  TemporaryFolder folder;
  Catalogue catalogue{plugins_of_build()};
  Simulation original{read_scene({"", std::string(head) + balls + tail, {}, {}}, catalogue), catalogue, 1, 0};

  explicit Bench(bool with_forces) {
    original.set_up();
    original.prepare();
    run(original, 20);
    if (with_forces) original.engine.forces();
    save(original, folder / "state");
    REQUIRE(original.engine.walls[0].contacts > 5);
    REQUIRE(memory(original) > 0);
  }
  std::unique_ptr<Simulation> specimen(const std::string& rest) {
    auto simulation = std::make_unique<Simulation>(
        read_scene({"", head + std::string("start: {state: state}\n") + rest, {}, {}}, catalogue), catalogue, 2, 0);
    load_specimen(*simulation, ArchiveReader(folder / "state"));
    return simulation;
  }
};

}  // namespace

TEST_CASE("a specimen goes on as it was under the same rules") {
  for (bool with_forces : {false, true}) {
    Bench bench(with_forces);
    const auto specimen = bench.specimen(tail);
    CHECK(specimen->engine.clock.cycle == 20);
    CHECK(specimen->engine.clock.time() == bench.original.engine.clock.time());
    CHECK(specimen->engine.walls[0].centre == bench.original.engine.walls[0].centre);
    CHECK(specimen->groups.leaves() == bench.original.groups.leaves());
    specimen->engine.forces();
    bench.original.engine.forces();
    CHECK(memory(*specimen) == Approx(memory(bench.original)).epsilon(1e-12));
    run(*specimen, 20);
    run(bench.original, 20);
    // Lists are rebuilt, so sums may round otherwise; steps are equal, so nothing else differs.
    CHECK(specimen->engine.clock.dt == bench.original.engine.clock.dt);
    CHECK(distance(bench.original, *specimen) < 1e-15);
  }
}

TEST_CASE("contacts under a rule of another name start fresh, and new pieces may come") {
  Bench bench(true);
  const auto renamed =
      bench.specimen(replaced(replaced(tail, "name: grains", "name: others"), "name: sides", "name: s"));
  renamed->engine.forces();
  CHECK(renamed->engine.contacts.active() == bench.original.engine.contacts.active());
  CHECK(memory(*renamed) == 0);
  const std::string more = R"(balls:
  more: {generator: lattice, kind: sc, radius: 2 mm, box: [[0, 0, 0.03], [0.02, 0.02, 0.04]], density: 2600,
         contact: {fric: 0.1}}
)";
  const auto grown = bench.specimen(
      more + replaced(replaced(tail, "[sand, floor]", "[balls, floor]"), "[sand, sand]", "[balls, balls]"));
  const auto& leaves = grown->groups.leaves();
  CHECK(leaves == std::vector<std::string>{"sand", "more"});
  CHECK(grown->engine.balls.size() > bench.original.engine.balls.size());
  run(*grown, 3);
}
