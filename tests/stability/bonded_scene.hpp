#pragma once
// Balls of 10 mm held by bonds, for the cases about bonds and about very unequal stiffnesses.
#include <numbers>
#include <string>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

namespace bonded {

constexpr double kn = 1e6;                                            ///< N/m, of a bond unless a case says otherwise
const double mass = 2500 * 4.0 / 3 * std::numbers::pi * 1e-6;         ///< kg, of a ball of 10 mm
constexpr double area = std::numbers::pi * 1e-4;                      ///< m2, of a bond as wide as its balls
inline const std::string endless = "cb_tenf: .inf, cb_shearf: .inf";  ///< a contact bond that never breaks

/// The balls of balls.csv under one law named `glue`, bonded where they touch; `more` are further actions of that
/// stage, each "    - ...\n".
inline std::string chain(const std::string& law, const std::string& more = "") {
  return "scree: 1\nballs:\n  chain: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n  - {name: glue, "
         "between: [chain, chain], " +
         law + "}\nstages:\n  - glue:\n    - bond: {rule: glue, gap: 1e-6}\n" + more;
}

/// The actions of the first stage that are no run. Sums and reports are left out of the cycles that follow.
inline void edit(support::SceneRun& run) {
  for (const auto& action : run.simulation().scene.stages.at(0).actions) run.simulation().edit(action);
  run.engine().forces();
  run.engine().sums_wanted = run.engine().report_wanted = false;
}

}  // namespace bonded
