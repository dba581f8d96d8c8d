#include <scree/process.hpp>

namespace {

using namespace scree;

/// A process: a drag in proportion to the velocity, which also keeps account of the energy that it takes.
struct PluginName {
  // A process that writes Force says whether it adds to it or scales it: all that add run before all that scale.
  static constexpr Effect effect = Effect::adds_force;

  // What a scene gives. A key that it leaves out keeps the value written here.
  double time = 1;

  static void describe(Settings<PluginName>& s) {
    s.number("time", &PluginName::time, "s", "in which drag alone takes a velocity down to 1/e").above(0).required();
  }

  // For each free ball in each cycle, between the contact forces and the motion; on any thread, so it changes nothing
  // but its arguments. The parameters are the columns that it needs: `const` reads, without it the column is written.
  void ball(const Mass& mass, const Velocity& velocity, Force& force) const { force -= (mass / time) * velocity; }

  /// What is remembered from cycle to cycle; zero at the start, saved in checkpoints.
  struct State {
    double lost;  ///< J
  };

  // Before the first cycle: look up walls, refuse by throwing, and say what will be published.
  void prepare(const Host& host) const {
    host.publish("power", 0);
    host.publish("lost", 0);
  }

  // Between cycles, on one thread, on the columns of all balls; leave it out where `ball` is all there is to do.
  void step(Step& step, State& state) {
    const auto mass = step.host.column(SCREE_MASS, 0);
    double power = 0;
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const auto velocity = step.host.column(SCREE_VELOCITY, axis);
      for (std::size_t row = 0; row < velocity.size(); ++row) power += mass[row] / time * velocity[row] * velocity[row];
    }
    state.lost += power * step.dt;
    // Scenes, recorders and other processes read them as processes.NAME.power and processes.NAME.lost.
    step.host.publish("power", power);
    step.host.publish("lost", state.lost);
  }
};

}  // namespace

SCREE_PLUGIN(scree::process<PluginName>("plugin_name", "0.1.0", "drag in proportion to the velocity"))
