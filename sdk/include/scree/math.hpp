#pragma once
/// Vectors and the few functions a law needs. Everything here vectorises and gives the same bits on every instruction
/// set; nothing throws, and what is not a number stays so.
#include <cmath>
#include <cstddef>

#define SCREE_INLINE inline __attribute__((always_inline))

namespace scree {

using std::abs;
using std::sqrt;

/// Larger of two by value; a NaN in either operand is passed on, so it never looks like "no contact".
SCREE_INLINE double max(double a, double b) { return a != a ? a : (b != b ? b : (a > b ? a : b)); }
/// Smaller of two by value; passes NaN on, like max.
SCREE_INLINE double min(double a, double b) { return a != a ? a : (b != b ? b : (a < b ? a : b)); }

/// Three doubles with Eigen's spelling. Plain data: may be a member of a law, of its State and of settings.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  SCREE_INLINE double dot(const Vec3& o) const { return x * o.x + y * o.y + z * o.z; }
  SCREE_INLINE Vec3 cross(const Vec3& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  SCREE_INLINE double squaredNorm() const { return dot(*this); }
  SCREE_INLINE double norm() const { return std::sqrt(squaredNorm()); }
  /// Unit vector; the zero vector stays zero.
  SCREE_INLINE Vec3 normalized() const {
    const double n = norm();
    const double s = n > 0 ? 1.0 / n : 0.0;
    return {x * s, y * s, z * s};
  }
  SCREE_INLINE double& operator[](std::size_t k) { return (&x)[k]; }
  SCREE_INLINE double operator[](std::size_t k) const { return (&x)[k]; }
  SCREE_INLINE Vec3& operator+=(const Vec3& o) { return *this = {x + o.x, y + o.y, z + o.z}; }
  SCREE_INLINE Vec3& operator-=(const Vec3& o) { return *this = {x - o.x, y - o.y, z - o.z}; }
  SCREE_INLINE Vec3& operator*=(double s) { return *this = {x * s, y * s, z * s}; }
};
SCREE_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
SCREE_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
SCREE_INLINE Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
SCREE_INLINE Vec3 operator*(const Vec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
SCREE_INLINE Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
SCREE_INLINE Vec3 operator/(const Vec3& a, double s) { return {a.x / s, a.y / s, a.z / s}; }

}  // namespace scree
