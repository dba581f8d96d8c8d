// A servo: moves a wall along its axis until the balls press on it with a given force.
#include <scree/process.hpp>

#include <algorithm>

namespace {
using namespace scree;

struct Piston {
  std::string wall;
  Vec3 axis{0, 0, 1};
  double force = 0, gain = 0.1, speed = 1;
  Wall moved;

  static void describe(Settings<Piston>& s) {
    s.text("wall", &Piston::wall, "name of the wall that is moved").required();
    s.vector("axis", &Piston::axis, "1", "direction in which the balls push it; any length");
    s.number("force", &Piston::force, "N", "to be reached").at_least(0).required();
    s.number("gain", &Piston::gain, "1", "share of the error that one cycle may mend").above(0).at_most(1);
    s.number("speed", &Piston::speed, "m/s", "never faster than this").above(0);
  }
  /// What a checkpoint saves; everything else follows from the settings.
  struct State {
    double reached;  ///< model time at which the error first fell below 0.5 %, s; 0: not yet
  };

  void check() {
    if (axis.norm() == 0) throw std::runtime_error("'axis' is zero; give the direction in which the balls push");
    axis = axis.normalized();
  }
  /// Before the first cycle and after each edit of the scene; throws when there is no such wall. What is published here
  /// is only the first value: a scene can then name the quantity.
  void prepare(const Host& host) {
    moved = host.wall(wall);
    host.publish("error", force);
    host.publish("reached", 0);
  }

  /// Between cycles, on one thread. The stiffness of the wall's contacts turns an error of force into a way.
  void step(Step& step, State& state) {
    scree_wall_view& view = step.host.view(moved);
    const double pressed = Vec3{view.force[0], view.force[1], view.force[2]}.dot(axis), error = force - pressed;
    const double wanted = view.stiffness > 0 ? gain * error / (view.stiffness * step.dt) : speed;
    const Vec3 velocity = -std::clamp(wanted, -speed, speed) * axis;
    for (std::size_t k = 0; k < 3; ++k) view.velocity[k] = velocity[k];
    if (state.reached == 0 && abs(error) < 0.005 * force) state.reached = step.time;
    step.host.publish("error", error);
    step.host.publish("reached", state.reached);
  }
};

}  // namespace

SCREE_PLUGIN(scree::process<Piston>("piston", "1.0.0", "moves a wall until it is pressed with a given force"))
