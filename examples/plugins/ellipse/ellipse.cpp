// A trough or drum of elliptic cross-section, along y: balls touch it from inside.
#include <scree/wall.hpp>

namespace {
using namespace scree;

struct Ellipse {
  double a = 1, b = 1;
  Vec3 centre;

  static void describe(Settings<Ellipse>& s) {
    s.number("a", &Ellipse::a, "m", "semi-axis along x").above(0).required();
    s.number("b", &Ellipse::b, "m", "semi-axis along z").above(0).required();
    s.vector("centre", &Ellipse::centre, "m", "a point of the axis");
  }

  /// The nearest point (x, z) of the ellipse to (u, v) in the first quadrant has x = a^2 u/(t + a^2) and z = b^2 v/(t +
  /// b^2), with t the largest root of F(t) = (x/a)^2 + (z/b)^2 - 1: D. Eberly, "Distance from a point to an ellipse, an
  /// ellipsoid, or a hyperellipsoid" (2013). F falls and is convex, so Newton's steps from the left never pass the
  /// root.
  Vec3 nearest(double u, double v) const {
    const double aa = a * a, bb = b * b;
    double t = std::max(a * u - aa, b * v - bb);
    for (int step = 0; step < 60; ++step) {
      const double p = a * u / (t + aa), q = b * v / (t + bb);
      const double f = p * p + q * q - 1;
      if (f < 1e-15) break;
      t += 0.5 * f / (p * p / (t + aa) + q * q / (t + bb));
    }
    return {aa * u / (t + aa), 0, bb * v / (t + bb)};
  }

  /// `x` is the centre of a ball. A ball smaller than the sharpest bend of the wall touches in one place: patch 0.
  void touch(const Vec3& x, double reach, Touches& out) const {
    const Vec3 from = x - centre;
    // Off the axes by a hair: on them the direction to the wall may have two answers.
    const double tiny = 1e-9 * min(a, b), u = max(abs(from.x), tiny), v = max(abs(from.z), tiny);
    const Vec3 to = nearest(u, v) - Vec3{u, 0, v};
    const double inside = u * u / (a * a) + v * v / (b * b) < 1 ? 1.0 : -1.0, distance = inside * to.norm();
    if (distance >= reach || distance <= -reach) return;
    // The gradient of the ellipse at the wall: a direction even when the centre lies on it.
    const Vec3 at = to + Vec3{u, 0, v};
    const Vec3 outward = Vec3{at.x / (a * a), 0, at.z / (b * b)}.normalized();
    out.add({from.x < 0 ? -outward.x : outward.x, 0, from.z < 0 ? -outward.z : outward.z}, distance, 0);
  }
};

}  // namespace

SCREE_PLUGIN(scree::wall<Ellipse>("ellipse", "1.0.0", "trough or drum of elliptic cross-section, from inside"))
