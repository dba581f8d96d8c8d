#include <scree/process.hpp>

#include <cmath>

namespace {

using namespace scree;

/// Bonds what comes near: a cement that keeps setting, grains that sinter.
struct Bonding {
  std::string rule;
  double gap = 0;
  uint64_t cycles = 100;
  bool again = false;

  static void describe(Settings<Bonding>& settings) {
    settings.text("rule", &Bonding::rule, "rule whose pairs are bonded; its contact model must make bonds").required();
    settings.number("gap", &Bonding::gap, "m", "largest gap of a pair that is bonded; 0 when absent").at_least(0);
    settings.integer("every", &Bonding::cycles, "1", "cycles from one look to the next; 100 when absent").at_least(1);
    settings.boolean("again", &Bonding::again, "also pairs whose bond broke before; false when absent");
  }
  void prepare(const Host& host) { host.bond(rule, gap, again); }
  void step(Step& step) {
    if (step.cycle % cycles == 0) step.host.bond(rule, gap, again);
  }
};

}  // namespace

SCREE_PLUGIN(scree::process<Bonding>("bonding", "1.0.0", "bonds pairs of a rule as they come near"))
