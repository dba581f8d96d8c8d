// Cases 38, 39, D41, D42, D64: bonds that break, all at once, one by one, on any number of threads and across restarts.
#include <chrono>

#include "core/base/isa.hpp"
#include "stability/breaking.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

/// Two bonded lattices of 686 balls each that fly apart and are bonded to each other.
const char* const torn = R"(scree: 1
balls:
  left: {generator: lattice, kind: sc, radius: 5 mm, spacing: 10 mm, box: [[0, 0, 0], [0.14, 0.07, 0.07]], density: 2500,
         velocity: [-2, 0.3, 0]}
  right: {generator: lattice, kind: sc, radius: 5 mm, spacing: 10 mm, box: [[0.14, 0, 0], [0.28, 0.07, 0.07]],
          density: 2500, velocity: [2, 0, -0.3]}
contacts:
  - {name: stone, between: [balls, balls], model: parallel_bond, emod: 1e8, kratio: 2, fric: 0.5, pb_emod: 1e8,
     pb_kratio: 2, pb_ten: 5e5, pb_coh: 4e5}
processes:
  energy: {process: energy_ledger}
stages:
  - cement: [bond: {rule: stone, gap: 1e-6}]
)";

std::unique_ptr<Simulation> begin(lab::Lab& lab, unsigned threads, int isa = 0) {
  auto simulation = lab.make(torn, threads, isa);
  simulation->edit(simulation->scene.stages[0].actions[0]);
  return simulation;
}

using breaking::Log;
using breaking::log_of;
constexpr uint64_t cycles = 600;

}  // namespace

TEST_CASE("39 OK: the same bonds break in the same cycles on any number of threads and instruction set") {
  Log reference;
  uint64_t hash = 0;
  for (unsigned threads = 1; threads <= 4; ++threads) {
    lab::Lab here;
    const int isa = static_cast<int>(detect_isa());
    const auto simulation = begin(here, threads, threads % 2 == 0 ? isa : 0);
    lab::run(*simulation, cycles);
    const Log log = log_of(simulation->engine);
    if (threads == 1) {
      reference = log;
      hash = simulation->engine.state_hash();
      CHECK(log.size() > 40);
      CHECK(simulation->engine.contacts.bonded() > 1000);
    }
    CHECK(log == reference);
    CHECK(simulation->engine.state_hash() == hash);
  }
  lab::measured("39", std::to_string(reference.size()) + " breaks, equal on 1 to 4 threads");
}

TEST_CASE("D64 OK: a run restarted while bonds break goes on with the same bits and the same energy account") {
  lab::Lab here;
  const Log log = breaking::same_across_restarts(
      here, [&] { return begin(here, 1); }, cycles, 60, 3);
  CHECK(log.size() > 40);
  lab::measured("D64", "60 restarts on 1 to 3 threads, " + std::to_string(log.size()) + " breaks, same bits");
}

TEST_CASE("38 D42 OK: all bonds break in one cycle, and what they stored is accounted for") {
  // A lattice of 19 683 balls and 56 862 bonds, pulled apart evenly: ball k moves with 10 x per second.
  lab::Lab here;
  std::string text = R"(scree: 1
balls:
  cube: {generator: lattice, kind: sc, radius: 5 mm, spacing: 10 mm, box: [[0, 0, 0], [0.27, 0.27, 0.27]], density: 2500}
contacts:
  - {name: stone, between: [balls, balls], model: contact_bond, kn: 1e6, ks: 1e6, fric: 0, cb_tenf: 10, cb_shearf: .inf}
processes:
  energy: {process: energy_ledger}
timestep: 1e-6
stages:
  - cement: [bond: {rule: stone, gap: 1e-6}]
)";
  const auto simulation = here.make(text, 2);
  simulation->edit(simulation->scene.stages[0].actions[0]);
  Engine& engine = simulation->engine;
  engine.synchronize();
  for (std::size_t row = 0; row < engine.balls.size(); ++row)
    for (int c = 0; c < 3; ++c)
      engine.balls[static_cast<Column>(static_cast<int>(Column::vx) + c)][row] =
          100 * engine.balls[static_cast<Column>(static_cast<int>(Column::x) + c)][row];
  engine.ledger = EnergyBalance();
  engine.ledger.on = true;
  lab::run(*simulation, 0);
  const uint64_t bonds = engine.contacts.bonded();
  CHECK(bonds == 3 * 27 * 27 * 26);
  double before = 0, at_break = 0;
  const auto timed = [&](uint64_t n) {
    const auto start = std::chrono::steady_clock::now();
    lab::run(*simulation, n);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / static_cast<double>(n);
  };
  std::size_t broke_at_once = 0;
  while (engine.contacts.bonded() > 0 && engine.clock.cycle < 100) {
    const double now = timed(1);
    if (engine.broken.empty())
      before = now;
    else
      at_break = std::max(at_break, now);
    broke_at_once = std::max(broke_at_once, engine.broken.size());
    engine.broken.clear();
  }
  CHECK(engine.contacts.bonded() == 0);
  CHECK(broke_at_once > bonds / 2);
  const double share = engine.ledger.residual_share(engine.stored_energy());
  CHECK(share < 1e-3);
  lab::measured("38, D42", std::to_string(broke_at_once) + " of " + std::to_string(bonds) +
                               " bonds in one cycle; energy not accounted for " + lab::number(share) +
                               "; that cycle took " + lab::number(at_break / std::max(before, 1e-9)) +
                               " times one before");
}

TEST_CASE("D41 OK: bonds of strength 0 break at the first load, infinite ones never, and nothing divides by zero") {
  for (const std::string model : {"contact_bond, cb_tenf: S, cb_shearf: S",
                                  "parallel_bond, pb_emod: 1e8, pb_kratio: 2, "
                                  "pb_ten: S, pb_coh: S"}) {
    for (const std::string strength : {"0", ".inf"}) {
      std::string law = model;
      for (std::size_t at; (at = law.find(": S")) != std::string::npos;) law.replace(at, 3, ": " + strength);
      lab::Lab here;
      const auto simulation = here.make(
          "scree: 1\nballs:\n  a: {generator: lattice, kind: sc, radius: 5 mm, spacing: 10 mm, box: [[0, 0, 0], [0.02, "
          "0.01, 0.01]], density: 2500}\ncontacts:\n  - {name: glue, between: [a, a], emod: 1e8, kratio: 2, fric: 0.3, "
          "model: " +
          law +
          "}\nstages:\n  - glue: [bond: {rule: glue, gap: 1e-6}, apply: {balls: a, force: [1, 0, 0], where: \"x > "
          "0.01\"}]\n");
      INFO(law);
      for (const Action& action : simulation->scene.stages[0].actions) simulation->edit(action);
      lab::run(*simulation, 200);
      CHECK(simulation->engine.contacts.bonded() == (strength == "0" ? 0 : 1));
      for (std::size_t row = 0; row < 2; ++row) CHECK(std::isfinite(simulation->engine.balls[Column::x][row]));
    }
  }
  lab::measured("D41", "strength 0: broken within 200 cycles; infinite: whole");
}
