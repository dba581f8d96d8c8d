#include <scree/process.hpp>

namespace {

using namespace scree;

/// Asks for the energy balance of the run, and does nothing itself.
struct Energy {
  static constexpr bool traces_energy = true;
  static void describe(Settings<Energy>&) {}
};

}  // namespace

SCREE_PLUGIN(scree::process<Energy>("energy", "1.0.0", "keeps the energy balance: quantities energy.*"))
