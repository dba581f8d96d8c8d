#include "sizes.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/isa.hpp"
#include "core/base/philox.hpp"
#include "packing.hpp"

namespace scree::bench {

namespace {

constexpr double edge = 1.145, large = 50;  // in diameters: of the lattice's cell, and the large ball's radius

/// A shaken body-centred lattice on which six of eight neighbours touch: a cube of it, or what lies within `thick` of
/// the large ball. All drift alike, so that lists wear out at the same pace.
void write_balls(const std::filesystem::path& path, int cells, double thick) {
  const core::Random random(4, "sizes");
  std::ofstream file(path);
  file.precision(17);
  file << "x,y,z,r,vx,vy,vz\n";
  if (thick > 0) file << "0,0,0," << large << ",2,0,0\n";
  uint64_t index = 0;
  const int low = thick > 0 ? -cells : 0;
  for (int i = low; i < cells; ++i)
    for (int j = low; j < cells; ++j)
      for (int k = low; k < cells; ++k)
        for (const double half : {0.25, 0.75}) {
          double at[3] = {(i + half) * edge, (j + half) * edge, (k + half) * edge};
          for (uint64_t c = 0; c < 3; ++c) at[c] += 0.03 * (2 * random.uniform(index, c) - 1);
          const double r = 0.5 * (1 + 0.08 * (2 * random.uniform(index, 3) - 1));
          ++index;
          const double away = std::hypot(at[0], at[1], at[2]) - large;
          if (thick > 0 && (away < 0.9 * r || away > thick)) continue;
          file << at[0] << ',' << at[1] << ',' << at[2] << ',' << r << ",2,0,0\n";
        }
}

std::unique_ptr<core::Simulation> packing(const std::string& name, int cells, double thick,
                                          core::Catalogue& catalogue) {
  const auto folder = std::filesystem::temp_directory_path() / "scree_bench_sizes";
  std::filesystem::create_directories(folder);
  write_balls(folder / (name + ".csv"), cells, thick);
  const auto path = folder / (name + ".yaml");
  // So soft that nothing moves by more than a thousandth meanwhile: the balls need not come to rest.
  std::ofstream(path) << "scree: 1\ntimestep: 1.0e-3\nskin: 0.1\nballs:\n  all: {generator: file, path: " << name
                      << ".csv, density: 1.909859}\ncontacts:\n  - {name: all, between: [all, all], model: linear, kn: "
                         "2, ks: 0.57, fric: 0.5, dp_nratio: 0.4}\nstages:\n  - go: [cycle: 1]\n";
  core::ReadOptions options;
  options.file = path.string();
  auto simulation = std::make_unique<core::Simulation>(core::read_scene(options, catalogue), catalogue, 1,
                                                       static_cast<int>(core::detect_isa()));
  simulation->set_up();
  simulation->prepare();
  for (int cycle = 0; cycle < 40; ++cycle) simulation->engine.advance();
  return simulation;
}

void line(const char* name, const core::Engine& engine, double ns) {
  const double balls = static_cast<double>(engine.balls.size()),
               contacts = static_cast<double>(engine.contacts.active());
  std::printf("%-10s %8.0f %10.2f %10.2f %10.1f %12.1f %10llu\n", name, balls, contacts / balls,
              static_cast<double>(engine.contacts.listed()) / balls, ns, ns * balls / contacts,
              static_cast<unsigned long long>(engine.rebuilds()));
}

}  // namespace

void compare_sizes(core::Catalogue& catalogue) {
  const auto equal = packing("equal", 37, 0, catalogue), mixed = packing("mixed", 46, 2.4, catalogue);
  std::vector<double> first, second, ratio;
  const auto each = [](const core::Simulation& simulation) {
    return static_cast<double>(simulation.engine.balls.size()) /
           static_cast<double>(simulation.engine.contacts.active());
  };
  for (int round = 0; round < 7; ++round) {
    first.push_back(measure(*equal, 50));
    second.push_back(measure(*mixed, 50));
    ratio.push_back(second.back() * each(*mixed) / (first.back() * each(*equal)));
  }
  std::printf("a layer of balls on one 100 times as large, and equal balls; one thread, median of 7 rounds in turns\n");
  std::printf("%-10s %8s %10s %10s %10s %12s %10s\n", "packing", "balls", "contacts", "listed", "ns/ball", "ns/contact",
              "rebuilds");
  line("equal", equal->engine, median(first));
  line("1:100", mixed->engine, median(second));
  std::printf("time of a contact, 1:100 over equal: %.2f\n", median(ratio));
}

}  // namespace scree::bench
