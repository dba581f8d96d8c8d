// Balls at random places of a ring (solid torus) about the z axis, without overlap.
#include <scree/generator.hpp>

#include <stdexcept>

namespace {
using namespace scree;

struct Torus {
  Vec3 centre;
  double ring = 0, tube = 0, radius = 0;
  uint32_t count = 0, tries = 1000;

  static void describe(Settings<Torus>& s) {
    s.vector("centre", &Torus::centre, "m", "of the ring");
    s.number("ring", &Torus::ring, "m", "from the axis to the middle of the tube").above(0).required();
    s.number("tube", &Torus::tube, "m", "radius of the tube; every ball lies wholly inside").above(0).required();
    s.number("radius", &Torus::radius, "m", "of every ball").above(0).required();
    s.integer("count", &Torus::count, "1", "number of balls").at_least(1).required();
    s.integer("tries", &Torus::tries, "1", "places tried for one ball before giving up").at_least(1);
  }
  /// After all settings: what no bound of a single one can say.
  void check() const {
    if (tube <= radius) throw std::runtime_error("'tube' must be larger than 'radius', or no ball fits");
    if (tube >= ring) throw std::runtime_error("'tube' must be smaller than 'ring', or the ring has no hole");
  }

  /// A number drawn for a ball belongs to the ball's index and the count of its draws, so it is the same on every
  /// machine and whatever the other balls do.
  void generate(Sink& sink) const {
    for (uint32_t index = 0; index < count; ++index) {
      bool placed = false;
      for (uint64_t attempt = 0, draw = 0; attempt < tries && !placed; ++attempt) {
        const auto within = [&](double half) { return half * (2 * sink.uniform(index, draw++) - 1); };
        const double room = tube - radius, x = within(ring + room), y = within(ring + room), z = within(room);
        const double off = sqrt(x * x + y * y) - ring;
        placed = off * off + z * z <= room * room && sink.try_ball({centre + Vec3{x, y, z}, radius});
      }
      if (!placed)
        throw std::runtime_error("no place for ball " + std::to_string(index + 1) + " of " + std::to_string(count) +
                                 ": ask for fewer or smaller balls, a thicker tube or more 'tries'");
    }
  }
};

}  // namespace

SCREE_PLUGIN(scree::generator<Torus>("torus", "1.0.0", "balls at random places of a ring, without overlap"))
