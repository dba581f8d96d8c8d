// P-12: waves in a row of bonded balls.
#include <cmath>
#include <numbers>
#include <vector>

#include "support/measure.hpp"
#include "support/scene_run.hpp"
#include "support/spectrum.hpp"

using namespace support;
using scree::core::Column;

namespace {

constexpr double spacing = 1, stiffness = 5e5;  // balls of radius 0.5 m and 1000 kg/m3
const double mass = 4.0 / 3.0 * std::numbers::pi * 0.125 * 1000;
const double speed = spacing * std::sqrt(stiffness / mass);

/// A closed ring of balls that stands still and moves with a sine of this wavelength.
std::string ring(int count, double wavelength) {
  std::string text = "x,y,z,radius,vx,vy,vz\n";
  for (int k = 0; k < count; ++k)
    text += digits(k + 0.5) + ",0,0,0.5," + digits(1e-3 * std::sin(2 * std::numbers::pi * k * spacing / wavelength)) +
            ",0,0\n";
  return text;
}

std::string scene(int count, double step) {
  return "scree: 1\ntimestep: " + digits(step) + "\ncell: {low: [0, -2, -2], high: [" + digits(count) +
         ", 2, 2], periodic: [x]}\nballs:\n  row: {generator: file, path: balls.csv, density: 1000}\ncontacts:\n"
         "  - {name: bonds, between: [row, row], model: contact_bond, kn: 5e5, ks: 0, cb_tenf: .inf, cb_shearf: .inf}\n"
         "stages:\n  - bind: [bond: {rule: bonds, gap: 1e-9}]\n";
}

}  // namespace

TEST_CASE("P-12: phase speed of waves in a row falls with the wavelength as sin(pi d/L)/(pi d/L)") {
  Measure measure(
      "P-12",
      "w = 2 sqrt(k/m) sin(pi d/L) of a row of masses (Brillouin, Wave Propagation in Periodic Structures, 1946)");
  for (const double wavelength : {4.0, 6.0, 10.0, 20.0, 50.0}) {
    const int count = wavelength == 50 ? 100 : 60;
    const double step = 1e-3, angle = std::numbers::pi * spacing / wavelength;
    SceneRun run(scene(count, step), ring(count, wavelength));
    run.engine().sums_wanted = run.engine().report_wanted = false;
    run.simulation().edit(run.simulation().scene.stages[0].actions[0]);
    REQUIRE(run.value("bonds.count") == count);
    const double frequency = speed / wavelength * std::sin(angle) / angle;
    std::vector<double> motion;
    // The swing of one ball against the mean of all does not see the ring as a whole move.
    const uint64_t id = 2;
    for (std::size_t k = 0; k < static_cast<std::size_t>(30 / frequency / step); ++k) {
      run.step();
      std::size_t row = 0;
      while (run.engine().balls.id()[row] != id) ++row;
      motion.push_back(run.engine().balls[Column::vx][row]);
    }
    const double found = peak(motion, step, frequency);
    measure.check("phase speed over C at " + digits(wavelength) + " d", found * wavelength / speed,
                  std::sin(angle) / angle, 2e-4);
  }
}
