// Case 64 of docs/stability.md: the certified step of random small networks against the eigenvalues of their stiffness
// matrix. `./dev verify stability` looks at 10 000 of them, every change at 200.
#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "core/contact/holding.hpp"
#include "core/contact/network_bound.hpp"
#include "stability/networks.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

void look_at(uint64_t count, const std::string& name, bool glued_floor = false) {
  lab::Lab here;
  std::vector<double> ratios;
  const auto begin = std::chrono::steady_clock::now();
  for (uint64_t index = 0; index < count; ++index) {
    networks::Maker maker(index, index % 2 == 0 ? 12 : 1, index % 3 == 2, glued_floor);
    const networks::Spec spec = maker.make(here.folder());
    const auto simulation = here.make(spec.scene);
    simulation->engine.forces();
    for (const Action& action : simulation->scene.stages[0].actions)
      if (std::holds_alternative<BondAction>(action.what)) simulation->edit(action);
    simulation->engine.forces();
    Engine& engine = simulation->engine;
    NetworkQuery query;
    query.links.margin = 1e-8;
    query.sweeps = 20;
    const double certified =
        network_bound(engine.contacts, engine.balls, engine.walls, engine.cell, query, engine.team).network.step;
    const double taken = engine.step.bound().step;
    const double limit = networks::true_limit(*simulation, 1e-3 * certified);
    ratios.push_back(certified / limit);
    INFO("network " << index << ": certified " << certified << " s, true " << limit << " s\n" << spec.scene);
    REQUIRE(certified <= limit * (1 + 5e-6));
    REQUIRE(taken <= limit * (1 + 5e-6));
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::sort(ratios.begin(), ratios.end());
  const double median = ratios[ratios.size() / 2];
  CHECK(median >= 0.95);
  CHECK(ratios.front() > 0.7);
  lab::measured(name, std::to_string(count) + " networks: certified over true step from " +
                          lab::number(ratios.front()) + ", median " + lab::number(median) + ", to " +
                          lab::number(ratios.back()) + "; " + lab::number(seconds) + " s");
}

}  // namespace

TEST_CASE("64 OK: the step of small networks is certified and sharp") { look_at(200, "64"); }

TEST_CASE("64 OK: the step of small networks is certified and sharp where the floor holds them by bonds") {
  look_at(100, "64, glued floor", true);
}

TEST_CASE("64 OK: 10 000 small networks", "[.][verify]") { look_at(10000, "64 verify"); }

namespace {

// A reference gap joins neighbours that do not touch, as bonds do.
const char* const sprung =
    "{name: grains, between: [sand, sand], model: linear, kn: 2e5, ks: 8e4, fric: 10, rgap: 1.5 mm}";
const char* const cemented =
    "{name: grains, between: [sand, sand], model: parallel_bond, emod: 1e8, kratio: 2.5, fric: 0.5, "
    "pb_emod: 1e8, pb_kratio: 2.5, pb_ten: .inf, pb_coh: .inf}";

// Whether a step holds is asked faster than which step holds, in single precision: the line lies in the same place.
void ask(Engine& engine, NetworkQuery query, double local_damping) {
  query.sweeps = 0;
  query.local_damping = local_damping;
  const double limit =
      network_bound(engine.contacts, engine.balls, engine.walls, engine.cell, query, engine.team).network.step;
  const auto holding = [&](double step, double factor) {
    return step_holds(engine.contacts, engine.balls, engine.walls, engine.cell, query.links, local_damping, step,
                      factor, engine.team);
  };
  CHECK(holding((1 - 1e-4) * limit, 1).holds);
  CHECK(!holding((1 + 1e-4) * limit, 1).holds);
  CHECK(holding(0.9 * limit, 1.2).holds);
  CHECK(!holding(0.9 * limit, 1.2).larger);
  CHECK(holding(0.6 * limit, 1.2).larger);
}

std::unique_ptr<Simulation> packing(lab::Lab& here, const std::string& law) {
  const bool bonds = law == cemented;
  auto simulation = here.make(R"(scree: 1
seed: 3
cell: {low: [0, 0, 0], high: [0.105, 0.105, 0.105], periodic: [x, y, z]}
balls:
  sand: {generator: random, box: [[0, 0, 0], [0.105, 0.105, 0.105]], radius: [3 mm, 4.5 mm], count: 2000, density: 2600}
contacts:
  - )" + law + "\nstages:\n  - go: [" +
                              (bonds ? "bond: {rule: grains, gap: 1.5 mm}" : "cycle: 1") + "]\n");
  simulation->engine.forces();
  if (bonds) simulation->edit(simulation->scene.stages[0].actions[0]);
  simulation->engine.forces();
  return simulation;
}

void look_at_packing(const std::string& law, const std::string& name) {
  lab::Lab here;
  const auto simulation = packing(here, law);
  Engine& engine = simulation->engine;
  NetworkQuery query;
  query.links.margin = 1e-6;
  const Links all = gather_links(engine.contacts, engine.balls, engine.walls, engine.cell, query.links, 0,
                                 engine.balls.size(), engine.team);
  REQUIRE(all.links.size() > 4000);
  const double coordination = 2.0 * static_cast<double>(all.links.size()) / 2000;
  const double limit = networks::limit_by_powers(engine.balls, all);
  std::string shares;
  double most = 0;
  for (const unsigned sweeps : {0u, 1u, 2u, 5u, 10u, 20u}) {
    query.sweeps = sweeps;
    const auto begin = std::chrono::steady_clock::now();
    const NetworkBound found =
        network_bound(engine.contacts, engine.balls, engine.walls, engine.cell, query, engine.team);
    const double ms = 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    CHECK(found.network.step <= limit);
    most = std::max(most, found.network.step);
    shares += " " + lab::number(found.network.step / limit) + " (" + std::to_string(found.sweeps) + ", " +
              lab::number(ms) + " ms)";
  }
  ask(engine, query, 0);
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < 20; ++k) {
    engine.forces_outdated();
    engine.forces();
  }
  const double pass = 50 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  CHECK(most >= 0.88 * limit);
  CHECK(engine.clock.dt >= 0.8 * limit);
  lab::measured(name, "2000 balls, " + lab::number(coordination) +
                          " contacts each: certified over true step (sweeps, time)" + shares + "; a force pass takes " +
                          lab::number(pass) + " ms; used " + lab::number(engine.clock.dt / limit) +
                          " of the true step");
}

}  // namespace

TEST_CASE("step OK: a random packing gets more than four fifths of its critical step") {
  look_at_packing(sprung, "step");
}

TEST_CASE("step OK: a bonded random packing gets more than four fifths of its critical step") {
  look_at_packing(cemented, "step, bonded");
}

TEST_CASE("step OK: whether a step holds is answered as the bound would, with dashpots too") {
  for (const char* dashpots : {"", ", dp_nratio: 0.3, dp_sratio: 0.2"}) {
    lab::Lab here;
    std::string law = sprung;
    law.insert(law.size() - 1, dashpots);
    const auto simulation = packing(here, law);
    NetworkQuery query;
    query.links.margin = 1e-4;
    for (const double local_damping : {0.0, 0.7}) ask(simulation->engine, query, local_damping);
  }
}
