#include "outside.hpp"

#include <cstdio>
#include <ctime>
#include <vector>

#include "core/base/isa.hpp"
#include "packing.hpp"

namespace scree::bench {

namespace {

/// ns of processor time per ball-step: other programs on the machine count less than in time by the clock on the wall.
double spent(core::Simulation& simulation, std::size_t cycles) {
  const std::clock_t start = std::clock();
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) simulation.engine.advance();
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return seconds * 1e9 / static_cast<double>(cycles) / static_cast<double>(simulation.engine.balls.size());
}

}  // namespace

int compare_laws(const std::string& one, const std::string& other, double limit, core::Catalogue& catalogue) {
  Setting setting;
  setting.isa = static_cast<int>(core::detect_isa());
  Setting second = setting;
  setting.model = one;
  second.model = other;
  const auto first_packing = dense_packing(setting, catalogue), second_packing = dense_packing(second, catalogue);
  std::vector<double> first, copy, ratio;
  for (int round = 0; round < 81; ++round) {
    // Who goes first changes, so that what a round leaves behind in the machine falls on both.
    const bool turn = round % 2 != 0;
    const double a = spent(turn ? *second_packing : *first_packing, 30);
    const double b = spent(turn ? *first_packing : *second_packing, 30);
    first.push_back(turn ? b : a);
    copy.push_back(turn ? a : b);
    ratio.push_back(copy.back() / first.back());
  }
  std::printf(
      "dense packing, %zu balls, one thread, %s; ns of processor time per ball-step, median of %zu rounds in turns\n",
      first_packing->engine.balls.size(), core::isa_name(static_cast<core::Isa>(setting.isa)), ratio.size());
  std::printf("%-16s %8.1f\n%-16s %8.1f\nratio            %8.3f, median of the rounds (limit %.3f)\n", one.c_str(),
              median(first), other.c_str(), median(copy), median(ratio), limit);
  if (first_packing->engine.state_hash() != second_packing->engine.state_hash()) {
    std::printf("the two runs differ, so this is no comparison\n");
    return 1;
  }
  return median(ratio) <= limit ? 0 : 1;
}

}  // namespace scree::bench
