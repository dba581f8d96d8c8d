#pragma once
/// Walls: the geometry of a surface that balls touch. One plain struct, described by its settings, in its own frame:
/// where the wall is, how it moves and what acts on it belong to the program.
///
///     void touch(const Vec3& centre, double reach, Touches& out) const;
///         Adds every piece of the surface that lies nearer to the centre than `reach` (m). [any thread]
///     void outline(const Vec3& low, const Vec3& high, Outline& out) const;        optional
///         Its polygons for pictures; an unbounded surface is cut to the box. [one thread]
///     double area() const;                                                         optional
///         m2; leave it out when the surface is unbounded.
///     static constexpr bool flat = true;                                           optional
///         Every patch is a plane.
#include <scree/abi.h>
#include <scree/math.hpp>
#include <scree/object.hpp>
#include <scree/plugin.hpp>

#include <span>
#include <vector>

namespace scree {

/// Collects the touches of a ball with a wall.
class Touches {
 public:
  explicit Touches(const scree_touches& out) : out_(out) {}

  /// `normal`: unit vector from the ball to the wall. `distance`: of the centre from the surface along it, m; negative
  /// once the centre is behind the surface. `patch` names the smooth piece that is touched: contact state stays with
  /// it, so it must not change while the ball rolls along the piece.
  SCREE_INLINE void add(const Vec3& normal, double distance, uint32_t patch) {
    if (count_ < out_.capacity) {
      out_.ball[count_] = ball_;
      out_.patch[count_] = patch;
      out_.nx[count_] = normal.x;
      out_.ny[count_] = normal.y;
      out_.nz[count_] = normal.z;
      out_.distance[count_] = distance;
    }
    ++count_;
  }

  /// For the adapter: the ball that the next touches belong to, and how many touches there were.
  void next_ball(uint32_t ball) { ball_ = ball; }
  uint32_t count() const { return count_; }

 private:
  const scree_touches out_;
  uint32_t ball_ = 0, count_ = 0;
};

/// Collects the polygons of a wall.
class Outline {
 public:
  Outline(void* sink, void (*take)(void*, uint32_t, const double*)) : sink_(sink), take_(take) {}
  /// One plane face by its corners, in order, seen from the side of the balls counterclockwise.
  void polygon(std::span<const Vec3> corners) {
    std::vector<double> xyz;
    for (const Vec3& c : corners) xyz.insert(xyz.end(), {c.x, c.y, c.z});
    take_(sink_, static_cast<uint32_t>(corners.size()), xyz.data());
  }

 private:
  void* sink_;
  void (*take_)(void*, uint32_t, const double*);
};

namespace wall_adapter {

template <class T>
uint32_t touch(const void* self, uint32_t n, const double* x, const double* y, const double* z, const double* reach,
               const scree_touches* out) {
  const T& wall = *static_cast<const T*>(self);
  Touches touches(*out);
  try {
    for (uint32_t i = 0; i < n; ++i) {
      touches.next_ball(i);
      wall.touch(Vec3{x[i], y[i], z[i]}, reach[i], touches);
    }
  } catch (...) {
    return UINT32_MAX;
  }
  return touches.count();
}

template <class T>
scree_wall make_table() {
  static_assert(
      requires(const T& t, const Vec3& c, Touches& out) { t.touch(c, 1.0, out); },
      "scree: a wall needs 'void touch(const Vec3& centre, double reach, Touches& out) const'");
  scree_wall table{};
  table.struct_size = sizeof table;
  if constexpr (requires { T::flat; }) table.flags = T::flat ? uint32_t{SCREE_WALL_FLAT} : 0u;
  table.object = object_table<T>();
  table.touch = &touch<T>;
  if constexpr (requires(const T& t, const Vec3& v, Outline& out) { t.outline(v, v, out); })
    table.outline = [](const void* self, const double low[3], const double high[3], void* sink,
                       void (*polygon)(void*, uint32_t, const double*)) {
      Outline out(sink, polygon);
      static_cast<const T*>(self)->outline(vec3(low), vec3(high), out);
    };
  if constexpr (requires(const T& t) { t.area(); })
    table.area = [](const void* self) -> double { return static_cast<const T*>(self)->area(); };
  return table;
}

}  // namespace wall_adapter

/// One wall for SCREE_PLUGIN. `name` is what a scene writes after `wall:`.
template <class T>
constexpr scree_component wall(const char* name, const char* version, const char* doc = "") {
  return {SCREE_WALL, 0, name, version, doc, []() -> const void* {
            static const scree_wall table = wall_adapter::make_table<T>();
            return &table;
          }};
}

}  // namespace scree
