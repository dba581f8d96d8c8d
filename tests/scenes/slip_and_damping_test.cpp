// One contact loaded sideways, and one oscillator under local damping.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Column;

TEST_CASE("F1: slip sets in at mu Fn/ks") {
  // Pressed in by 10 um at 10 MN/m: Fn = 100 N. The floor moves by 10 nm a cycle.
  SceneRun run(R"(scree: 1
timestep: 1e-5
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1], velocity: [1e-3, 0, 0]}
balls:
  ball: {generator: file, path: balls.csv, density: 2500, fixed: true}
contacts:
  - {between: [ball, floor], model: linear, kn: 10 MN/m, ks: 1 MN/m, fric: 0.5}
  - {between: [ball, ball], model: none}
)",
               "x,y,z,radius\n0,0,0.00999,0.01\n");
  constexpr double increment = 1e-8, ks = 1e6;
  double before = 0, linear = 0;
  while (run.value("contacts.sliding") == 0 && run.time() < 0.1) {
    before = run.value("contacts.1.floor.shear_force");
    linear = std::max(linear, std::abs(before - ks * run.value("walls.floor.displacement.x")));
    run.step();
  }
  Measure measure("F1", "u = mu Fn/ks, |Fs| <= mu Fn (Coulomb 1785; spring and slider of Cundall & Strack 1979)");
  measure.check("displacement at slip", run.value("walls.floor.displacement.x"), 50e-6, 1.001 * increment);
  measure.check("shear force at slip", run.value("contacts.1.floor.shear_force"), 50, 1e-9);
  measure.check("shear force one increment before", before, 50, 1.001 * ks * increment);
  measure.check("deviation from ks u before slip", linear, 0, 1e-9);
  run.step(1000);
  measure.check("shear force 10 um further", run.value("contacts.1.floor.shear_force"), 50, 1e-9);
}

TEST_CASE("D1: amplitudes of an oscillator under local damping fall by sqrt((1 - a)/(1 + a)) each half cycle") {
  // A ball held between two floors by 0.1 mm of overlap each, so that it never leaves either: stiffness 2 kn.
  constexpr double kn = 1e5, start = 0.9e-4;
  const double mass = 4.0 / 3.0 * std::numbers::pi * 1e-6 * 2500, frequency = std::sqrt(2 * kn / mass);
  Measure measure("D1",
                  "force opposed by a|F|: amplitude ratio sqrt((1 - a)/(1 + a)), half period (pi/2w)(1/sqrt(1 - a) "
                  "+ 1/sqrt(1 + a)), from Cundall's (1987) definition, piecewise harmonic motion");
  for (const double factor : {0.1, 0.3, 0.7}) {
    SceneRun run("scree: 1\ntimestep: " + digits(2e-4 / frequency) +
                     "\nwalls:\n  low: {wall: plane, point: [0, 0, -0.0099], normal: [0, 0, 1]}\n"
                     "  high: {wall: plane, point: [0, 0, 0.0099], normal: [0, 0, -1]}\n"
                     "balls:\n  ball: {generator: file, path: balls.csv, density: 2500}\n"
                     "contacts:\n  - {between: [ball, [low, high]], model: linear, kn: 1e5, ks: 0}\n"
                     "  - {between: [ball, ball], model: none}\n"
                     "processes:\n  damping: {process: local_damping, factor: " +
                     digits(factor) + "}\n",
                 "x,y,z,radius\n0,0," + digits(start) + ",0.01\n");
    run.engine().report_wanted = run.engine().sums_wanted = false;
    const auto z = [&] { return run.engine().balls[Column::z][0]; };
    const auto vz = [&] { return run.engine().balls[Column::vz][0]; };
    run.step(10);
    std::vector<double> amplitudes, times;
    while (amplitudes.size() < 3) {
      const bool down = vz() < 0;
      while ((vz() < 0) == down) run.step();
      amplitudes.push_back(std::abs(z()));
      times.push_back(run.time());
    }
    const double ratio = std::sqrt((1 - factor) / (1 + factor));
    const double half = std::numbers::pi / 2 * (1 / std::sqrt(1 - factor) + 1 / std::sqrt(1 + factor));
    const std::string name = ", factor " + digits(factor);
    measure.check("amplitude ratio of the first half cycle" + name, amplitudes[0] / start, ratio, 1e-6);
    measure.check("amplitude ratio of the second half cycle" + name, amplitudes[1] / amplitudes[0], ratio, 1e-6);
    measure.check("amplitude ratio of the third half cycle" + name, amplitudes[2] / amplitudes[1], ratio, 1e-6);
    // A turn is noticed up to a step late, with the velocity (1 + a)/(1 - a) times what the new force would have given.
    measure.check("half period times w" + name, (times[2] - times[0]) / 2 * frequency, half,
                  2e-4 * (1 + factor) / (1 - factor));
  }
}
