#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/heap.hpp"
#include "core/base/isa.hpp"
#include "core/run/summary.hpp"
#include "laws.hpp"
#include "outside.hpp"
#include "packing.hpp"
#include "sizes.hpp"

// scree_bench            ns per ball-step of the dense packing, all sizes, with and without friction, threads and ISA
// scree_bench quick      the smallest size only
// scree_bench memory N   peak memory of one packing of N balls, for the slope between two sizes
// scree_bench outside COPY DIR [LIMIT]   the law `linear` and its copy of that name in the plug-in folder DIR, in turns
// scree_bench laws       the dense packing under each law, bonded too, one thread
// scree_bench sizes      a layer of balls on one 100 times as large beside equal balls, in turns
// Friction and no friction are run in turn and their ratio is the median over the rounds: the machine's mood cancels.

namespace {

using scree::bench::median;
using scree::bench::Setting;

void line(const Setting& setting, scree::core::Catalogue& catalogue) {
  Setting smooth = setting;
  smooth.friction = false;
  const auto rough_packing = dense_packing(setting, catalogue);
  const auto smooth_packing = dense_packing(smooth, catalogue);
  const std::size_t cycles = std::max<std::size_t>(10, 2000000 / setting.balls);
  std::vector<double> rough, frictionless, ratio;
  for (int round = 0; round < 5; ++round) {
    rough.push_back(scree::bench::measure(*rough_packing, cycles));
    frictionless.push_back(scree::bench::measure(*smooth_packing, cycles));
    ratio.push_back(frictionless.back() / rough.back());
  }
  const double balls = static_cast<double>(rough_packing->engine.balls.size());
  std::printf("%8.0f %8u %9s %9.1f %9.1f %8.2f %9.2f %9.2f\n", balls, setting.threads,
              scree::core::isa_name(static_cast<scree::core::Isa>(setting.isa)), median(rough), median(frictionless),
              median(ratio), 2 * static_cast<double>(rough_packing->engine.contacts.active()) / balls,
              2 * static_cast<double>(rough_packing->engine.contacts.listed()) / balls);
  std::fflush(stdout);
}

int memory(std::size_t balls, scree::core::Catalogue& catalogue) {
  Setting setting;
  setting.balls = balls;
  setting.isa = static_cast<int>(scree::core::detect_isa());
  const auto packing = dense_packing(setting, catalogue);
  for (int cycle = 0; cycle < 60; ++cycle) packing->engine.advance();
  std::printf("%zu %llu\n", packing->engine.balls.size(),
              static_cast<unsigned long long>(scree::core::peak_memory_bytes().value_or(0)));
  return 0;
}

}  // namespace

int main(int count, char** words) {
  scree::core::tune_heap();
  scree::core::Catalogue catalogue(scree::core::SearchPath::standard({}));
  const std::string what = count > 1 ? words[1] : "";
  if (what == "outside" && count > 3) {
    scree::core::Catalogue with_copy(scree::core::SearchPath::standard({words[3]}));
    const char* limit = count > 4 ? words[4] : "1.03";
    double value = 1.03;
    std::from_chars(limit, limit + std::strlen(limit), value);
    return scree::bench::compare_laws("linear", words[2], value, with_copy);
  }
  if (what == "laws") {
    scree::bench::compare_all_laws(catalogue);
    return 0;
  }
  if (what == "sizes") {
    scree::bench::compare_sizes(catalogue);
    return 0;
  }
  if (what == "memory" && count > 2) return memory(std::strtoull(words[2], nullptr, 10), catalogue);
  std::printf("dense packing, linear contacts; ns per ball-step (median of 5 rounds), list rebuilds included\n");
  std::printf("%8s %8s %9s %9s %9s %8s %9s %9s\n", "balls", "threads", "isa", "friction", "smooth", "ratio", "contacts",
              "listed");
  const int best = static_cast<int>(scree::core::detect_isa());
  for (std::size_t balls : {4000u, 32000u, 256000u}) {
    if (what == "quick" && balls > 4000) break;
    for (unsigned threads : {1u, 2u})
      for (int isa = 0; isa <= best; ++isa) line({balls, true, threads, isa}, catalogue);
  }
  return 0;
}
