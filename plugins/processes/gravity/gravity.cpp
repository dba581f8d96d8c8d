#include <scree/process.hpp>

namespace {

using namespace scree;

/// Uniform pull on every free ball.
struct Gravity {
  static constexpr Effect effect = Effect::adds_force;
  Vec3 acceleration{0, 0, -9.81};

  static void describe(Settings<Gravity>& settings) {
    settings.vector("acceleration", &Gravity::acceleration, "m/s2", "pull on every ball; 0 0 -9.81 when absent");
  }
  void ball(const Mass& mass, Force& force) const { force += mass * acceleration; }
};

}  // namespace

SCREE_PLUGIN(scree::process<Gravity>("gravity", "1.0.0", "uniform pull on every free ball"))
