#pragma once
// Scenes of the stability cases brought to life inside the test program, and the figures they leave for
// docs/stability.md.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include "core/run/simulation.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace lab {

/// The plug-ins of this build, those of the tests that are wrong on purpose, and a folder for scenes. `make` sets a
/// scene up; nothing has moved yet.
class Lab {
 public:
  Lab() : catalogue_(scree::core::SearchPath{{support::plugin_dir(), support::binary_dir() + "/tests/hostile"}, {}}) {}
  scree::core::Catalogue& catalogue() { return catalogue_; }
  const TemporaryFolder& folder() const { return folder_; }

  scree::core::Scene read(const std::string& text) {
    write_text(folder_ / "scene.yaml", text);
    scree::core::ReadOptions options;
    options.file = folder_ / "scene.yaml";
    return read_scene(options, catalogue_);
  }
  std::unique_ptr<scree::core::Simulation> make(const std::string& text, unsigned threads = 1, int isa = 0) {
    auto simulation = std::make_unique<scree::core::Simulation>(read(text), catalogue_, threads, isa);
    simulation->set_up();
    simulation->prepare();
    return simulation;
  }
  /// The same with `balls` as balls.csv beside the scene.
  std::unique_ptr<scree::core::Simulation> make(const std::string& text, const std::string& balls) {
    write_text(folder_ / "balls.csv", balls);
    return make(text);
  }

 private:
  TemporaryFolder folder_;
  scree::core::Catalogue catalogue_;
};

inline void run(scree::core::Simulation& simulation, uint64_t cycles) {
  for (uint64_t k = 0; k < cycles; ++k) simulation.engine.advance();
  simulation.engine.forces();
}

/// Row of a ball; the number of rows when there is none.
inline std::size_t row_of(const scree::core::Simulation& simulation, uint64_t id) {
  const scree::core::Balls& balls = simulation.engine.balls;
  std::size_t row = 0;
  while (row < balls.size() && balls.id()[row] != id) ++row;
  return row;
}

inline double at(const scree::core::Simulation& simulation, scree::core::Column column, uint64_t id) {
  return simulation.engine.balls[column][row_of(simulation, id)];
}

inline std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Appends "case: figure" to the file that SCREE_MEASURED names, if it is set: the third column of docs/stability.md.
inline void measured(const std::string& name, const std::string& figure) {
  if (const char* path = std::getenv("SCREE_MEASURED"))
    std::ofstream(path, std::ios::app) << name << ": " << figure << "\n";
}

/// 2100 balls of 3 to 4.5 mm that slide down a periodic chute: collisions, friction, dashpots, damping, many rebuilds,
/// three blocks of rows.
inline const char* const flow = R"(scree: 1
seed: 5
cell: {low: [0, 0, -0.01], high: [0.12, 0.12, 0.4], periodic: [x, y]}
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  sand: {generator: random, box: [[0, 0, 0], [0.12, 0.12, 0.14]], radius: [3 mm, 4.5 mm], count: 2100, density: 2600,
         velocity: [1, 0.3, -3]}
contacts:
  - {name: grains, between: [sand, sand], model: linear, kn: 2e5, ks: 1e5, fric: 0.4, dp_nratio: 0.1}
  - {name: ground, between: [sand, floor], model: linear, kn: 4e5, ks: 2e5, fric: 0.5, dp_nratio: 0.1}
processes:
  pull: {process: gravity, acceleration: [3.4, 0, -9.2]}
  damping: {process: local_damping, factor: 0.05}
stages:
  - flow: [cycle: 1000]
)";

}  // namespace lab
