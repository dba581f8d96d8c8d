#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "core/run/quantities.hpp"
#include "support/simulated.hpp"

namespace support {

using Triple = std::array<double, 3>;

/// A ball at time n, with velocities of that time.
struct BallState {
  Triple position{}, velocity{}, spin{}, force{};
  double radius = 0, mass = 0;
};

/// A scene driven cycle by cycle, with balls by their ids and any quantity by its name. `balls` is the text of
/// balls.csv beside the scene.
class SceneRun {
 public:
  explicit SceneRun(const std::string& scene, const std::string& balls = "", unsigned threads = 1)
      : simulated_(scene, balls, threads), quantities_(*simulated_) {
    engine().sums_wanted = engine().report_wanted = true;
    engine().forces();
  }

  scree::core::Engine& engine() { return simulated_->engine; }
  scree::core::Simulation& simulation() { return *simulated_; }
  scree::core::Quantities& quantities() { return quantities_; }

  void step(uint64_t cycles = 1) {
    for (uint64_t k = 0; k < cycles; ++k) engine().advance();
  }
  double time() { return engine().clock.time(); }
  double value(const std::string& name) {
    engine().forces();
    return quantities_.value(name);
  }
  BallState ball(uint64_t id) {
    using scree::core::Column;
    engine().forces();
    scree::core::Instant& now = quantities_.instant();
    const scree::core::Observation& seen = now.observation();
    const uint32_t row = now.row_of(id);
    const auto& balls = engine().balls;
    BallState state{{balls[Column::x][row], balls[Column::y][row], balls[Column::z][row]},
                    {},
                    {},
                    {},
                    balls[Column::radius][row],
                    balls[Column::mass][row]};
    for (std::size_t c = 0; c < 3; ++c) {
      state.velocity[c] = seen.velocity[c][row];
      state.force[c] = seen.force[c][row];
      if (row < seen.spin[c].size()) state.spin[c] = seen.spin[c][row];
    }
    return state;
  }

 private:
  Simulated simulated_;
  scree::core::Quantities quantities_;
};

}  // namespace support
