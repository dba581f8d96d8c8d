#include <scree/wall.hpp>

#include <stdexcept>

namespace {

using namespace scree;

/// The part of a polygon with coordinate `axis` at most `bound` (side +1) or at least `bound` (side -1).
std::vector<Vec3> clip(const std::vector<Vec3>& polygon, std::size_t axis, double bound, double side) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = side * (a[axis] - bound), db = side * (b[axis] - bound);
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      Vec3 crossing = a + (b - a) * (da / (da - db));
      crossing[axis] = bound;
      kept.push_back(crossing);
    }
  }
  return kept;
}

/// An unbounded plane with one active side, the one its normal points to.
struct Plane {
  static constexpr bool flat = true;
  Vec3 point, normal;
  Vec3 unit{};

  static void describe(Settings<Plane>& settings) {
    settings.vector("point", &Plane::point, "m", "any point of the plane").required();
    settings.vector("normal", &Plane::normal, "1", "points to the side of the balls; any length").required();
  }
  void check() {
    // Scaled first, so that a very long or very short normal neither overflows nor vanishes.
    const double largest = max(max(std::abs(normal.x), std::abs(normal.y)), std::abs(normal.z));
    if (largest == 0) throw std::runtime_error("'normal' is zero; give a vector that points to the side of the balls");
    const Vec3 scaled = normal / largest;
    unit = scaled / scaled.norm();
  }
  void touch(const Vec3& centre, double reach, Touches& out) const {
    const double distance = (centre - point).dot(unit);
    if (distance < reach && distance > -reach) out.add(-unit, distance, 0);
  }
  void outline(const Vec3& low, const Vec3& high, Outline& out) const {
    const Vec3 middle = 0.5 * (low + high);
    const Vec3 centre = middle - unit * (middle - point).dot(unit);
    const double size = (high - low).norm();
    const Vec3 helper = std::abs(unit.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = unit.cross(helper).normalized() * size;
    const Vec3 v = unit.cross(u);
    std::vector<Vec3> face{centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      face = clip(face, axis, low[axis], -1);
      face = clip(face, axis, high[axis], 1);
    }
    if (face.size() >= 3) out.polygon(face);
  }
};

}  // namespace

SCREE_PLUGIN(scree::wall<Plane>("plane", "1.0.0", "unbounded plane with one active side"))
