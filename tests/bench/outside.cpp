#include "outside.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/base/isa.hpp"
#include "packing.hpp"

namespace scree::bench {

namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
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
  for (int round = 0; round < 21; ++round) {
    // Who goes first changes, so that what a round leaves behind in the machine falls on both.
    const bool turn = round % 2 != 0;
    const double a = measure(turn ? *second_packing : *first_packing, 100);
    const double b = measure(turn ? *first_packing : *second_packing, 100);
    first.push_back(turn ? b : a);
    copy.push_back(turn ? a : b);
    ratio.push_back(copy.back() / first.back());
  }
  std::printf("dense packing, %zu balls, one thread, %s; ns per ball-step, median of %zu rounds in turns\n",
              first_packing->engine.balls.size(), core::isa_name(static_cast<core::Isa>(setting.isa)), ratio.size());
  std::printf("%-16s %8.1f\n%-16s %8.1f\nratio            %8.3f, median of the rounds (limit %.3f)\n", one.c_str(),
              median(first), other.c_str(), median(copy), median(ratio), limit);
  return median(ratio) <= limit ? 0 : 1;
}

}  // namespace scree::bench
