// Air or a liquid that moves past the balls: G. G. Stokes, "On the effect of the internal friction of fluids on the
// motion of pendulums", Transactions of the Cambridge Philosophical Society 9 (1851): F = 6 pi mu r (u - v).
#include <scree/process.hpp>

namespace {
using namespace scree;

struct Air {
  /// Forces that are added come before those that scale, such as local damping.
  static constexpr Effect effect = Effect::adds_force;

  double viscosity = 1.8e-5;
  Vec3 wind;

  static void describe(Settings<Air>& s) {
    s.number("viscosity", &Air::viscosity, "Pa s", "of the fluid").at_least(0);
    s.vector("wind", &Air::wind, "m/s", "velocity of the fluid");
  }

  /// One ball. The parameters are the columns that are needed: `const` reads, `Force&` also writes. Runs on any thread,
  /// as a vector loop over blocks of balls.
  void ball(const Radius& radius, const Velocity& velocity, Force& force) const {
    constexpr double pi = 3.14159265358979323846;
    force += 6 * pi * viscosity * radius * (wind - velocity);
  }
};

}  // namespace

SCREE_PLUGIN(scree::process<Air>("air", "1.0.0", "Stokes' drag of a fluid on every ball"))
