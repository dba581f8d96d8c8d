#include <algorithm>
#include <chrono>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"

namespace scree::core::vet {

namespace {

using Clock = std::chrono::steady_clock;

/// Nanoseconds for one contact: the median of rounds over one batch that lies in the first-level cache.
double time_of(LawBench& bench) {
  constexpr int rounds = 41, calls = 200;
  const scree_law law = bench.law();
  const scree_batch batch = bench.prepared(0, bench.size());
  std::vector<double> times;
  for (int round = 0; round < rounds; ++round) {
    const auto start = Clock::now();
    for (int k = 0; k < calls; ++k) law(bench.rule(), &batch);
    times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count() /
                    (calls * static_cast<double>(bench.size())));
  }
  std::nth_element(times.begin(), times.begin() + rounds / 2, times.end());
  return times[rounds / 2];
}

}  // namespace

Outcome law_speed(const Subject& subject) {
  const scree_contact_model& model = subject.component->contact_model();
  std::string text;
  bool scalar = false;
  double best = 0;
  const Case c = cases(model, 1, 131).front();
  for (const Part part : parts(model)) {
    LawBench bench(model, part, SCREE_BATCH, c.words);
    bench.dt = c.dt;
    Party party(c, part, SCREE_BATCH, 132, true);
    // In the middle of the second leg, where contacts are loaded and have a past.
    party.restart(20);
    for (int k = 0; k < 30; ++k) party.step(c.dt);
    party.put(bench);
    double time[3] = {0, 0, 0};
    std::string line;
    for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4}) {
      if (isa > detect_isa()) continue;
      bench.isa = isa;
      time[static_cast<int>(isa)] = best = time_of(bench);
      line += fmt::format("{}{} {:.1f}", line.empty() ? "" : ", ", isa_name(isa), best);
    }
    text += fmt::format("{}{}: {} ns per contact", text.empty() ? "" : "; ", part_name(part), line);
    if (time[1] > 0) {
      // Twice as many lanes take 0.5 to 0.6 of the time where the loop is a vector loop, all of it where it is not.
      const double ratio = time[1] / time[0];
      scalar = scalar || ratio > 0.75;
      text += fmt::format(", v3 takes {:.2f} of baseline: {}", ratio, ratio <= 0.75 ? "vectorised" : "not vectorised");
    }
  }
  return {Verdict::info, text, scalar ? "docs/plugins.md, Fast laws, lists what compilers turn into vector code" : "",
          best, NAN};
}

}  // namespace scree::core::vet
