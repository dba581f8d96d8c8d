#include "packing.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "core/base/philox.hpp"

namespace scree::bench {

namespace {

// The balls go through a file, as a user's would; the scene then reads like any other.
void write_balls(const std::filesystem::path& folder, int cells, double edge) {
  const core::Random random(7, "bench");
  std::ofstream file(folder / "balls.csv");
  file.precision(17);
  file << "x,y,z,r\n";
  const double basis[2][3] = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}};
  uint64_t index = 0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        for (const auto& site : basis) {
          const int cell[3] = {i, j, k};
          for (int axis = 0; axis < 3; ++axis)
            file << (cell[axis] + site[axis]) * edge +
                        0.03 * (2 * random.uniform(index, static_cast<uint64_t>(axis)) - 1)
                 << ',';
          file << 0.5 * (1 + 0.08 * (2 * random.uniform(index, 3) - 1)) << '\n';
          ++index;
        }
}

std::string law_of(const Setting& setting) {
  if (!setting.law.empty()) return setting.law;
  return "model: " + setting.model + ", kn: 2000, ks: " + (setting.friction ? "571.4286, fric: 0.5" : "0, fric: 0") +
         ", dp_nratio: 0.4";
}

std::string scene_text(double length, const std::string& balls, const Setting& setting, bool settling) {
  const std::string edge = std::to_string(length);
  return "scree: 1\ntitle: dense packing\ntimestep: 1.0e-3\nskin: 0.1\ncell: {low: [0, 0, 0], high: [" + edge + ", " +
         edge + ", " + edge + "], periodic: [x, y, z]}\nballs:\n  grains: {generator: file, path: " + balls +
         ", density: 1.909859}\ncontacts:\n  - {name: grains, between: [grains, grains], " + law_of(setting) + "}\n" +
         (settling ? "processes:\n  calm: {process: local_damping, factor: 0.7}\n" : "") + "stages:\n  - go: [" +
         (setting.bond_gap > 0 ? "bond: {rule: grains, gap: " + std::to_string(setting.bond_gap) + "}" : "cycle: 1") +
         "]\n";
}

std::unique_ptr<core::Simulation> simulation_of(const std::filesystem::path& folder, const std::string& text,
                                                const Setting& setting, core::Catalogue& catalogue) {
  const auto path = folder / "scene.yaml";
  std::ofstream(path) << text;
  core::ReadOptions options;
  options.file = path.string();
  auto simulation =
      std::make_unique<core::Simulation>(core::read_scene(options, catalogue), catalogue, setting.threads, setting.isa);
  simulation->set_up();
  simulation->prepare();
  return simulation;
}

// By law: what is timed has come to rest under it.
std::string settled_file(const Setting& setting) {
  const std::size_t of_law = std::hash<std::string>()(setting.law);
  return "settled_" + (setting.law.empty() ? setting.friction ? "rough" : "smooth" : std::to_string(of_law)) + ".csv";
}

// The lattice comes to rest once per size under the law that is timed: a packing that still moves rebuilds its lists
// more often.
void settle(const std::filesystem::path& folder, double length, const Setting& setting, core::Catalogue& catalogue) {
  const auto simulation = simulation_of(folder, scene_text(length, "balls.csv", setting, true), setting, catalogue);
  const core::Balls& balls = simulation->engine.balls;
  const std::size_t cycles = std::clamp<std::size_t>(150000000 / balls.size(), 600, 10000);
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) simulation->engine.advance();
  std::ofstream file(folder / settled_file(setting));
  file.precision(17);
  file << "x,y,z,r\n";
  for (std::size_t row = 0; row < balls.size(); ++row)
    file << balls[core::Column::x][row] << ',' << balls[core::Column::y][row] << ',' << balls[core::Column::z][row]
         << ',' << balls[core::Column::radius][row] << '\n';
}

double seconds_of(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

std::unique_ptr<core::Simulation> dense_packing(const Setting& setting, core::Catalogue& catalogue) {
  const int cells = static_cast<int>(std::lround(std::cbrt(static_cast<double>(setting.balls) / 2)));
  const double edge = 1.145;  // a little less than touching at the mean size: six of the eight neighbours touch
  const auto folder = std::filesystem::temp_directory_path() / ("scree_bench_" + std::to_string(setting.balls));
  std::filesystem::create_directories(folder);
  static std::set<std::pair<std::size_t, std::string>> settled;
  if (settled.insert({setting.balls, settled_file(setting)}).second) {
    write_balls(folder, cells, edge);
    settle(folder, cells * edge, setting, catalogue);
  }
  auto simulation =
      simulation_of(folder, scene_text(cells * edge, settled_file(setting), setting, false), setting, catalogue);
  if (setting.bond_gap > 0) {
    simulation->engine.forces();
    simulation->edit(simulation->scene.stages[0].actions[0]);
  }
  for (int cycle = 0; cycle < 40; ++cycle) simulation->engine.advance();
  return simulation;
}

double measure(core::Simulation& simulation, std::size_t cycles) {
  const clockid_t clock = simulation.engine.team.size() == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC;
  const double start = seconds_of(clock);
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) simulation.engine.advance();
  const double seconds = seconds_of(clock) - start;
  return seconds * 1e9 / static_cast<double>(cycles) / static_cast<double>(simulation.engine.balls.size());
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace scree::bench
