#pragma once
/// The columns of a ball, as parameter types of a process. A `const Force&` parameter reads the column, a `Force&`
/// parameter writes it; what a process does not name is neither loaded nor allocated.
#include <scree/abi.h>
#include <scree/math.hpp>

namespace scree {

/// Centre at the time of the forces, m.
struct Position : Vec3 {
  static constexpr uint32_t column = SCREE_POSITION, words = 3;
};
/// Velocity half a step before the time of the forces, v(n - 1/2), m/s.
struct Velocity : Vec3 {
  static constexpr uint32_t column = SCREE_VELOCITY, words = 3;
};
/// Spin half a step before the time of the forces, rad/s.
struct Spin : Vec3 {
  static constexpr uint32_t column = SCREE_SPIN, words = 3;
};
/// Net force: the sum over the ball's contacts plus what earlier processes added, N.
struct Force : Vec3 {
  static constexpr uint32_t column = SCREE_FORCE, words = 3;
  SCREE_INLINE Force& operator=(const Vec3& o) {
    x = o.x, y = o.y, z = o.z;
    return *this;
  }
};
/// Net moment about the centre, N m.
struct Moment : Vec3 {
  static constexpr uint32_t column = SCREE_MOMENT, words = 3;
  SCREE_INLINE Moment& operator=(const Vec3& o) {
    x = o.x, y = o.y, z = o.z;
    return *this;
  }
};
/// m.
struct Radius {
  static constexpr uint32_t column = SCREE_RADIUS, words = 1;
  double value;
  SCREE_INLINE operator double() const { return value; }
};
/// kg.
struct Mass {
  static constexpr uint32_t column = SCREE_MASS, words = 1;
  double value;
  SCREE_INLINE operator double() const { return value; }
};
/// Moment of inertia about any axis through the centre, kg m2.
struct Inertia {
  static constexpr uint32_t column = SCREE_INERTIA, words = 1;
  double value;
  SCREE_INLINE operator double() const { return value; }
};

}  // namespace scree
