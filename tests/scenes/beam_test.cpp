// P-11: frequencies of a cantilever of bonded balls, from the spectrum of its tip after a blow.
#include <cmath>
#include <numbers>
#include <vector>

#include "support/measure.hpp"
#include "support/scene_run.hpp"
#include "support/spectrum.hpp"

using namespace support;
using scree::core::Column;

namespace {

constexpr double radius = 0.1, length = 0.2, modulus = 1e9, step = 1e-4;

std::string balls(int bonds, double vx, double vz) {
  std::string text = "x,y,z,radius,vx,vy,vz,group\n";
  for (int k = 0; k <= bonds; ++k)
    text += digits(k * length) + ",0,0,0.1," + (k == bonds ? digits(vx) + ",0," + digits(vz) + ",tip" : "0,0,0,rest") +
            "\n";
  return text;
}

std::string beam(const std::string& stages) {
  return "scree: 1\ntimestep: 1e-4\nvars: {E: 1e9, l: 0.2}\n"
         "balls:\n  beam: {generator: file, path: balls.csv, density: 2000}\n"
         "contacts:\n  - {name: beam, between: [beam, beam], model: parallel_bond, kn: 0, ks: 0, fric: 0, pb_kn: E/l, "
         "pb_ks: E/2.6/l, pb_ten: .inf, pb_coh: .inf}\n" +
         stages;
}

void act(SceneRun& run, std::size_t stage) {
  for (const auto& action : run.simulation().scene.stages.at(stage).actions) run.simulation().edit(action);
}

/// Motion of the tip along x and z from now on.
struct Record {
  std::vector<double> x, z;
  Record(SceneRun& run, int bonds, std::size_t cycles) {
    const auto row = [&] {
      std::size_t at = 0;
      while (run.engine().balls.id()[at] != static_cast<uint64_t>(bonds) + 1) ++at;
      return at;
    };
    for (std::size_t k = 0; k < cycles; ++k) {
      run.step();
      const std::size_t tip = row();
      x.push_back(run.engine().balls[Column::x][tip] - bonds * length);
      z.push_back(run.engine().balls[Column::z][tip]);
    }
  }
};

}  // namespace

TEST_CASE("P-11: bending and axial frequencies of a bonded cantilever") {
  struct Case {
    int bonds;
    double seconds;
    std::vector<double> bending;
    double axial;
  };
  // Eigenvalues of the chain of n bonds (beam joints in the middle of each) with the mass and inertia of its balls.
  const std::vector<Case> cases = {{10, 10, {5.48527, 33.7930, 91.8415}, 103.0021},
                                   {20, 20, {1.440823, 8.988526, 24.9626}, 52.7935},
                                   {50, 40, {.2375182, 1.487382, 4.159003}, 0}};
  Measure measure("P-11", "eigenvalues of the mass-spring chain of n bonds with sphere inertia");
  for (const Case& one : cases) {
    SceneRun run(beam("stages:\n  - bond: [bond: {rule: beam, gap: 1e-9}, fix: {balls: beam, where: \"x < 0.05\"}]\n"),
                 balls(one.bonds, 1e-4, 1e-4));
    run.engine().sums_wanted = run.engine().report_wanted = false;
    act(run, 0);
    const Record tip(run, one.bonds, static_cast<std::size_t>(one.seconds / step));
    const std::string name = " of " + std::to_string(one.bonds) + " bonds, Hz";
    for (std::size_t mode = 0; mode < 3; ++mode)
      measure.check("bending frequency " + std::to_string(mode + 1) + name, peak(tip.z, step, one.bending[mode]),
                    one.bending[mode], 1e-3 * one.bending[mode]);
    if (one.axial > 0)
      measure.check("axial frequency" + name, peak(tip.x, step, one.axial), one.axial, 1e-3 * one.axial);
  }
}

TEST_CASE("P-11: an axial load lowers the bending frequency by sqrt(1 - P/Pcr)") {
  constexpr int bonds = 10;
  const double inertia = std::numbers::pi * std::pow(radius, 4) / 4, span = bonds * length;
  const double buckling = std::numbers::pi * std::numbers::pi * modulus * inertia / (4 * span * span);
  Measure measure("P-11, column", "f(P) = f(0) sqrt(1 - P/Pcr), Pcr = pi^2 E I/(4 L^2) (Euler 1757)");
  for (const double share : {0.3, -0.5}) {
    SceneRun run(
        beam("processes:\n  damping: {process: local_damping, factor: 0.7}\nstages:\n"
             "  - load: [bond: {rule: beam, gap: 1e-9}, fix: {balls: beam, where: \"x < 0.05\"}, apply: {balls: "
             "beam.tip, force: [" +
             digits(-share * buckling) +
             ", 0, 0]}]\n  - swing: [delete: {processes: damping}, set: {balls.beam.tip.velocity: [0, 0, 1e-4]}]\n"),
        balls(bonds, 0, 0));
    run.engine().sums_wanted = run.engine().report_wanted = false;
    act(run, 0);
    run.step(5000);
    run.engine().forces();
    act(run, 1);
    const Record tip(run, bonds, 100000);
    const double expected = 5.48527 * std::sqrt(1 - share);
    measure.check("bending frequency at P/Pcr = " + digits(share) + ", Hz", peak(tip.z, step, expected), expected,
                  0.02 * expected);
  }
}
