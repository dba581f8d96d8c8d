#pragma once
// What runs in which bonds break are compared by, and the same run cut into pieces.
#include <functional>
#include <memory>
#include <tuple>
#include <vector>

#include "core/run/state.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

namespace breaking {

using Log = std::vector<std::tuple<uint64_t, scree::core::IdPair, uint16_t, uint8_t, double>>;
inline Log log_of(const scree::core::Engine& engine) {
  Log log;
  for (const scree::core::BrokenBond& bond : engine.broken)
    log.emplace_back(bond.cycle, bond.what.ids, bond.what.wall, bond.what.mode, bond.what.energy);
  return log;
}

/// Runs the scene whole, and again saved, dropped and loaded `parts` times on 1 to `threads` threads in turn: breaks,
/// state and energy account must have the same bits. Gives the log.
inline Log same_across_restarts(lab::Lab& lab, const std::function<std::unique_ptr<scree::core::Simulation>()>& begin,
                                uint64_t cycles, unsigned parts, unsigned threads) {
  using namespace scree::core;
  const auto whole = begin();
  lab::run(*whole, cycles);
  auto simulation = begin();
  Log log;
  const std::string path = lab.folder() / "state.scree";
  for (unsigned part = 0; part < parts; ++part) {
    lab::run(*simulation, cycles / parts);
    for (const auto& entry : log_of(simulation->engine)) log.push_back(entry);
    {
      ArchiveWriter out(path);
      save_state(*simulation, out);
      REQUIRE(out.commit());
    }
    const ArchiveReader in(path);
    simulation = std::make_unique<Simulation>(saved_scene(in, lab.catalogue()), lab.catalogue(), 1 + part % threads, 0);
    load_state(*simulation, in);
  }
  simulation->engine.forces();
  const Engine &one = simulation->engine, &other = whole->engine;
  CHECK(log == log_of(other));
  CHECK(one.state_hash() == other.state_hash());
  CHECK(one.contacts.breaks == other.contacts.breaks);
  CHECK(one.contacts.wall_breaks == other.contacts.wall_breaks);
  CHECK(one.contacts.bonded() == other.contacts.bonded());
  const StoredEnergy stored = simulation->engine.stored_energy(), wanted = whole->engine.stored_energy();
  for (const std::string& term : EnergyBalance::terms())
    CHECK(one.ledger.value(term, stored) == other.ledger.value(term, wanted));
  return log;
}

}  // namespace breaking
