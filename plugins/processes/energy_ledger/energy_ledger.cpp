#include <scree/process.hpp>

namespace {

using namespace scree;

/// Asks for the energy balance of the run, and does nothing itself.
struct EnergyLedger {
  static constexpr bool traces_energy = true;
  static void describe(Settings<EnergyLedger>&) {}
};

}  // namespace

SCREE_PLUGIN(scree::process<EnergyLedger>("energy_ledger", "1.0.0", "keeps the energy balance: quantities energy.*"))
