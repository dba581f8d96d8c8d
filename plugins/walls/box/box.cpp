#include <scree/wall.hpp>

#include <array>
#include <stdexcept>
#include <string>

namespace {

using namespace scree;

constexpr std::array<const char*, 6> face_names{"left", "right", "front", "back", "bottom", "top"};

/// Six rectangles seen from inside, some of them left open. Face 2k lies at the low end of axis k, face 2k+1 at the
/// high end.
struct Box {
  Vec3 low, high;
  std::vector<std::string> open;
  std::array<bool, 6> closed{true, true, true, true, true, true};

  static void describe(Settings<Box>& settings) {
    settings.vector("low", &Box::low, "m", "lower corner").required();
    settings.vector("high", &Box::high, "m", "upper corner").required();
    settings.texts("open", &Box::open, "faces that are left out: left right (x), front back (y), bottom top (z)")
        .choices("left right front back bottom top");
  }
  void check() {
    for (std::size_t k = 0; k < 3; ++k)
      if (!(low[k] < high[k]))
        throw std::runtime_error(std::string("'low' must lie below 'high': along ") + "xyz"[k] + " they are " +
                                 shortest(low[k]) + " and " + shortest(high[k]));
    bool any = false;
    for (std::size_t f = 0; f < 6; ++f) {
      closed[f] = true;
      for (const std::string& name : open) closed[f] = closed[f] && name != face_names[f];
      any = any || closed[f];
    }
    if (!any) throw std::runtime_error("all six faces are open: leave at least one closed, or leave the wall out");
  }

  double bound(std::size_t face) const { return face % 2 == 0 ? low[face / 2] : high[face / 2]; }
  /// How far a point lies outside the plane of a face; negative inside.
  double beyond(const Vec3& p, std::size_t face) const {
    return face % 2 == 0 ? low[face / 2] - p[face / 2] : p[face / 2] - high[face / 2];
  }
  bool within(const Vec3& p, std::size_t axis) const { return p[axis] >= low[axis] && p[axis] <= high[axis]; }
  static Vec3 outward(std::size_t face) {
    Vec3 n;
    n[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
    return n;
  }

  void touch(const Vec3& centre, double reach, Touches& out) const {
    // Most balls are far inside; they cost six comparisons.
    if (centre.x - low.x >= reach && high.x - centre.x >= reach && centre.y - low.y >= reach &&
        high.y - centre.y >= reach && centre.z - low.z >= reach && high.z - centre.z >= reach)
      return;
    bool past_open = false;
    for (std::size_t f = 0; f < 6; ++f) {
      const double distance = -beyond(centre, f);
      past_open = past_open || (!closed[f] && distance < 0);
      if (!closed[f] || !(distance < reach && distance > -reach)) continue;
      const std::size_t a = (f / 2 + 1) % 3, b = (f / 2 + 2) % 3;
      if (within(centre, a) && within(centre, b)) out.add(outward(f), distance, static_cast<uint32_t>(f));
    }
    if (!past_open) return;
    touch_edges(centre, reach, out);
    touch_corners(centre, reach, out);
  }

  /// The rim: edges between a closed and an open face, for a ball beyond the open one. Patches 6 to 17.
  void touch_edges(const Vec3& centre, double reach, Touches& out) const {
    for (std::size_t e = 0; e < 12; ++e) {
      const std::size_t along = e / 4, a = (along + 1) % 3, b = (along + 2) % 3;
      const std::size_t face_a = 2 * a + e % 2, face_b = 2 * b + (e / 2) % 2;
      if (closed[face_a] == closed[face_b] || !within(centre, along)) continue;
      const std::size_t open_face = closed[face_a] ? face_b : face_a, wall_face = closed[face_a] ? face_a : face_b;
      if (beyond(centre, open_face) <= 0) continue;
      Vec3 nearest = centre;
      nearest[a] = bound(face_a);
      nearest[b] = bound(face_b);
      add_point(centre, nearest, outward(wall_face), reach, static_cast<uint32_t>(6 + e), out);
    }
  }

  /// Ends of the rim: a corner acts when no edge that ends there comes nearer. Patches 18 to 25.
  void touch_corners(const Vec3& centre, double reach, Touches& out) const {
    for (std::size_t c = 0; c < 8; ++c) {
      const std::array<std::size_t, 3> face{c % 2, 2 + (c / 2) % 2, 4 + c / 4};
      bool rim = false, nearest = true;
      Vec3 normal;
      for (std::size_t along = 0; along < 3; ++along) {
        const std::size_t fa = face[(along + 1) % 3], fb = face[(along + 2) % 3];
        if (closed[fa] == closed[fb]) continue;
        rim = true;
        normal = outward(closed[fa] ? fa : fb);
        nearest = nearest && beyond(centre, face[along]) > 0 && beyond(centre, closed[fa] ? fb : fa) > 0;
      }
      if (!rim || !nearest) continue;
      const Vec3 corner{bound(face[0]), bound(face[1]), bound(face[2])};
      add_point(centre, corner, normal, reach, static_cast<uint32_t>(18 + c), out);
    }
  }

  static void add_point(const Vec3& centre, const Vec3& point, const Vec3& fallback, double reach, uint32_t patch,
                        Touches& out) {
    const Vec3 way = point - centre;
    const double distance = way.norm();
    if (distance < reach) out.add(distance > 0 ? way / distance : fallback, distance, patch);
  }

  double area() const {
    double sum = 0;
    for (std::size_t f = 0; f < 6; ++f) {
      const std::size_t a = (f / 2 + 1) % 3, b = (f / 2 + 2) % 3;
      if (closed[f]) sum += (high[a] - low[a]) * (high[b] - low[b]);
    }
    return sum;
  }

  void outline(const Vec3&, const Vec3&, Outline& out) const {
    for (std::size_t f = 0; f < 6; ++f) {
      if (!closed[f]) continue;
      const std::size_t k = f / 2, a = (k + 1) % 3, b = (k + 2) % 3;
      std::array<Vec3, 4> corner{low, low, low, low};
      for (Vec3& p : corner) p[k] = bound(f);
      // Counterclockwise from inside: axes a, b, k are right-handed, and inside looks along +k at a low face.
      const std::size_t first = f % 2 == 0 ? a : b, second = f % 2 == 0 ? b : a;
      corner[1][first] = corner[2][first] = high[first];
      corner[2][second] = corner[3][second] = high[second];
      out.polygon(corner);
    }
  }
};

}  // namespace

SCREE_PLUGIN(scree::wall<Box>("box", "1.0.0", "box seen from inside, with faces left open at will"))
