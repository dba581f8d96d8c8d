#include "laws.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/base/isa.hpp"
#include "packing.hpp"

namespace scree::bench {

namespace {

struct Law {
  const char* name;
  const char* text;
  double bond_gap;
};

// Springs of about the same stiffness at the overlaps of the packing; bonds of all pairs up to a fiftieth of a
// diameter.
constexpr Law laws[] = {
    {"linear", "model: linear, kn: 2000, ks: 571.4286, fric: 0.5, dp_nratio: 0.4", 0},
    {"hertz_mindlin", "model: hertz_mindlin, shear: 3000, poiss: 0.2, fric: 0.5, dp_nratio: 0.4", 0},
    {"contact_bond",
     "model: contact_bond, kn: 2000, ks: 571.4286, fric: 0.5, dp_nratio: 0.4, cb_tenf: 1e9, cb_shearf: 1e9", 0.02},
    {"parallel_bond",
     "model: parallel_bond, kn: 2000, ks: 571.4286, fric: 0.5, dp_nratio: 0.4, pb_kn: 2500, pb_ks: 700, pb_ten: .inf, "
     "pb_coh: .inf",
     0.02},
};

}  // namespace

void compare_all_laws(core::Catalogue& catalogue) {
  std::printf("dense packing, one thread; ns per ball-step (median of 5 rounds in turns), list rebuilds included\n");
  std::printf("%8s %-14s %9s %9s %9s %9s\n", "balls", "law", "ns", "active", "bonded", "rebuilds");
  for (const std::size_t balls : {4000u, 32000u, 256000u}) {
    std::vector<std::unique_ptr<core::Simulation>> packings;
    std::vector<std::vector<double>> times(std::size(laws));
    for (const Law& law : laws) {
      Setting setting;
      setting.balls = balls;
      setting.isa = static_cast<int>(core::detect_isa());
      setting.law = law.text;
      setting.bond_gap = law.bond_gap;
      packings.push_back(dense_packing(setting, catalogue));
    }
    for (int round = 0; round < 5; ++round)
      for (std::size_t k = 0; k < packings.size(); ++k)
        times[k].push_back(measure(*packings[k], std::max<std::size_t>(10, 2000000 / balls)));
    for (std::size_t k = 0; k < packings.size(); ++k) {
      const core::Engine& engine = packings[k]->engine;
      const auto per_ball = [&](uint64_t count) {
        return 2 * static_cast<double>(count) / static_cast<double>(engine.balls.size());
      };
      std::printf("%8zu %-14s %9.1f %9.2f %9.2f %9llu\n", engine.balls.size(), laws[k].name, median(times[k]),
                  per_ball(engine.contacts.active()), per_ball(engine.contacts.bonded()),
                  static_cast<unsigned long long>(engine.rebuilds()));
      std::fflush(stdout);
    }
  }
}

}  // namespace scree::bench
