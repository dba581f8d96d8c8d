// Nothing is missed silently: at every cycle of a flow each pair that overlaps is found by a sweep that shares no code
// with the hash, and compared with the contacts whose law runs.
#include <algorithm>
#include <numeric>

#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

struct Count {
  uint64_t overlapping = 0, missed = 0, doubtful = 0;
};

/// Overlapping pairs by sweeping along z: rows in the order of their lower ends, each against those that begin before
/// its upper end.
class Sweep {
 public:
  explicit Sweep(const Engine& engine) : engine_(engine) {}

  Count check() {
    const Balls& balls = engine_.balls;
    const std::size_t n = balls.size();
    order_.resize(n);
    std::iota(order_.begin(), order_.end(), 0u);
    const double *z = balls[Column::z], *radius = balls[Column::radius];
    std::sort(order_.begin(), order_.end(),
              [&](uint32_t a, uint32_t b) { return z[a] - radius[a] < z[b] - radius[b]; });
    for (auto* column : {&x_, &y_, &z_, &r_}) column->resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      x_[k] = balls[Column::x][order_[k]];
      y_[k] = balls[Column::y][order_[k]];
      z_[k] = z[order_[k]];
      r_[k] = radius[order_[k]];
    }
    Count count;
    for (std::size_t k = 0; k < n; ++k) row(k, count);
    return count;
  }

 private:
  /// Balls drift less than half an edge out of the cell between rebuilds.
  static double nearest(double d, const PeriodicCell& cell, int axis) {
    if (!cell.periodic[axis]) return d;
    const double edge = cell.length(axis);
    return d > 0.5 * edge ? d - edge : d < -0.5 * edge ? d + edge : d;
  }
  void row(std::size_t k, Count& count) {
    const double top = z_[k] + r_[k];
    for (std::size_t m = k + 1; m < x_.size() && z_[m] - r_[m] <= top; ++m) {
      const double dx = nearest(x_[m] - x_[k], engine_.cell, 0), sum = r_[m] + r_[k], limit = sum * sum;
      if (dx * dx > limit * (1 + 1e-13)) continue;
      const double dy = nearest(y_[m] - y_[k], engine_.cell, 1), dz = z_[m] - z_[k];
      const double square = dx * dx + dy * dy + dz * dz;
      if (square > limit * (1 + 1e-13)) continue;
      if (square > limit * (1 - 1e-13)) {
        ++count.doubtful;  // touching to the last digit: either answer is right
        continue;
      }
      ++count.overlapping;
      if (!is_active(order_[k], order_[m])) ++count.missed;
    }
  }
  bool is_active(uint32_t a, uint32_t b) const {
    const uint32_t low = std::min(a, b), high = std::max(a, b);
    for (const TouchList& list : engine_.contacts.lists()) {
      if (list.begin.empty()) continue;
      const uint32_t* begin = list.other.data() + list.begin[low];
      const uint32_t* end = list.other.data() + list.begin[low + 1];
      const uint32_t* found = std::lower_bound(begin, end, high);
      if (found != end && *found == high && list.active[static_cast<std::size_t>(found - list.other.data())] != 0)
        return true;
    }
    return false;
  }

  const Engine& engine_;
  std::vector<uint32_t> order_;
  std::vector<double> x_, y_, z_, r_;
};

/// Runs and checks every cycle; returns the largest number of overlapping pairs met.
uint64_t follow(Simulation& simulation, int cycles) {
  Engine& engine = simulation.engine;
  Sweep sweep(engine);
  uint64_t missed = 0, extra = 0, most = 0;
  for (int k = 0; k < cycles; ++k) {
    engine.forces();
    const Count count = sweep.check();
    missed += count.missed;
    if (engine.contacts.active() > count.overlapping + count.doubtful) ++extra;
    most = std::max(most, count.overlapping);
    engine.advance();
  }
  CHECK(missed == 0);
  CHECK(extra == 0);
  return most;
}

}  // namespace

TEST_CASE("pairs OK: nothing is missed in 2000 cycles of a flow of 2100 balls") {
  lab::Lab here;
  const auto simulation = here.make(lab::flow);
  const uint64_t most = follow(*simulation, 2000);
  CHECK(most > 1000);
  CHECK(simulation->engine.rebuilds() > 5);
  lab::measured("pairs, flow", "2000 cycles, " + std::to_string(simulation->engine.rebuilds()) + " rebuilds, up to " +
                                   std::to_string(most) + " overlapping pairs, none missed");
}

TEST_CASE("pairs OK: nothing is missed beside a giant ball, in a cluster, among dust and with balls that escape") {
  lab::Lab here;
  const auto simulation = here.make(R"(scree: 1
seed: 9
overlap_limit: 150 %
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  giant: {generator: lattice, kind: sc, radius: 0.1, box: [[0, 0, 0.131], [0.2, 0.2, 0.331]], density: 300, velocity: [0, 0, -1.5]}
  cluster: {generator: random, box: [[0, 0, 0], [0.2, 0.2, 0.13]], radius: [6 mm, 8 mm], count: 1000, density: 2600, velocity: [0, 0.5, -2]}
  dust: {generator: random, box: [[0.05, 0.05, 0], [0.15, 0.15, 0.13]], radius: 1 mm, count: 900, density: 2600, velocity: [0.5, 0, -4]}
  sparse: {generator: random, box: [[-5, -5, 1], [5, 5, 9]], radius: [5 mm, 8 mm], count: 80, density: 2600}
  escaping: {generator: random, box: [[0, 0, 0.4], [0.2, 0.2, 0.6]], radius: 4 mm, count: 20, density: 2600, velocity: [10, 5, 22]}
contacts:
  - {name: all, between: [balls, [balls, walls]], model: linear, kn: 1e4, ks: 5e3, fric: 0.3, dp_nratio: 0.1}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
stages:
  - fall: [cycle: 600]
)");
  const uint64_t most = follow(*simulation, 600);
  CHECK(most > 100);
  lab::measured("pairs, mixed", "2001 balls, radii 1:100, 600 cycles, " +
                                    std::to_string(simulation->engine.rebuilds()) + " rebuilds, up to " +
                                    std::to_string(most) + " overlapping pairs, none missed");
}
