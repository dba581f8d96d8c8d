#include <scree/generator.hpp>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace {

using namespace scree;

/// A generator: equal balls on a circle about an axis along z.
struct PluginName {
  // What a scene gives. A key that it leaves out keeps the value written here; an `optional` one stays empty.
  Vec3 centre;
  double ring = 1;
  int count = 3;
  std::optional<double> radius;
  double speed = 0;

  static void describe(Settings<PluginName>& s) {
    s.vector("centre", &PluginName::centre, "m", "of the circle").required();
    s.number("ring", &PluginName::ring, "m", "radius of the circle through the centres of the balls")
        .above(0)
        .required();
    s.integer("count", &PluginName::count, "1", "number of balls").at_least(2).required();
    s.number("radius", &PluginName::radius, "m", "of a ball; when absent, neighbours just touch").above(0);
    s.number("speed", &PluginName::speed, "m/s", "away from the centre");
  }

  // Hands the balls over one by one. Refuse by throwing, and say what to change. A generator that needs random numbers
  // asks sink.uniform(ball, draw): a scene then gives the same balls on every machine.
  void generate(Sink& sink) const {
    const double half_angle = std::numbers::pi / count;
    const double largest = ring * std::sin(half_angle);
    const double size = radius.value_or(largest);
    if (size > largest * (1 + 1e-12))
      throw std::runtime_error(std::to_string(count) + " balls of radius " + shortest(size) +
                               " m overlap on this circle: 'radius' may be " + shortest(largest) + " m at most");
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * k * half_angle;
      const Vec3 outwards{std::cos(angle), std::sin(angle), 0};
      sink.ball({.position = centre + ring * outwards, .radius = size, .velocity = speed * outwards});
    }
  }
};

}  // namespace

SCREE_PLUGIN(scree::generator<PluginName>("plugin_name", "0.1.0", "equal balls on a circle"))
