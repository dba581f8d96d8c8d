#pragma once
/// What a contact law sees of one contact, and what it answers.
///
/// Signs: `normal` points from piece 1 to piece 2; forces and moments are those on piece 2; piece 1 gets the opposite.
/// Piece 1 has the lower id; in a wall contact it is the ball. All values are SI.
#include <scree/abi.h>
#include <scree/math.hpp>

namespace scree {

/// The pieces of a new contact, for `derive` and `reach`.
struct Pair {
  double r1;      ///< radius of piece 1, m, above 0
  double r2;      ///< radius of piece 2, m; 0 is a wall, which is flat
  double mass;    ///< effective mass m1 m2 / (m1 + m2), kg; a wall counts as infinite
  uint32_t form;  ///< the form of input the scene used, in the order of `either`; 0 in `reach`
  bool wall() const { return r2 == 0; }
};

/// One contact without anything tangential: the view of `law_normal`.
class NormalContact {
 public:
  Vec3 normal;  ///< unit vector from piece 1 to piece 2
  double gap;   ///< m, negative when the pieces overlap
  double dt;    ///< s, of the motion that led here; 0 after a start or an edit
  double mass;  ///< effective mass, kg, above 0

  /// Rate of the gap, m/s: positive while the pieces separate.
  SCREE_INLINE double opening() const { return velocity_.dot(normal); }
  /// Coefficient of a dashpot that is `ratio` of critical beside a spring of stiffness `k`: 2 ratio sqrt(mass k), N
  /// s/m.
  SCREE_INLINE double dashpot(double ratio, double k) const { return 2.0 * ratio * std::sqrt(mass * k); }

  /// For the adapter.
  SCREE_INLINE void set_velocity(const Vec3& velocity) { velocity_ = velocity; }

 protected:
  Vec3 velocity_;  // of piece 2 relative to piece 1 at the contact point, m/s
};

/// One contact.
class Contact : public NormalContact {
 public:
  double r1;  ///< radius of piece 1, m
  double r2;  ///< radius of piece 2, m; 0 is a wall, which is flat

  /// Tangential velocity of piece 2 relative to piece 1 at the contact point, m/s.
  SCREE_INLINE Vec3 slip_rate() const { return velocity_ - velocity_.dot(normal) * normal; }
  /// Tangential displacement over the motion that led here, m: slip_rate() times dt.
  SCREE_INLINE Vec3 slip() const { return dt * slip_rate(); }

  /// A remembered tangential vector, turned with the contact (tilt of the normal and mean spin about it) and laid back
  /// into the tangential plane. Needs a State or Bond that holds a Vec3.
  SCREE_INLINE Vec3 turned(const Vec3& v) const {
    const Vec3 a = rotate(turn_, v);
    return a - a.dot(normal) * normal;
  }
  /// The same for a vector that may also have a part along the normal, which stays along the normal. The turn is the
  /// tilt followed by the spin about the new normal, so the old normal lands on the new one.
  SCREE_INLINE Vec3 carried(const Vec3& v) const {
    const double spin = turn_.dot(normal);
    return rotate(turn_ + (0.5 * spin) * normal.cross(turn_), v);
  }

  /// For the adapter.
  SCREE_INLINE void set_turn(const Vec3& turn) { turn_ = turn; }

 private:
  /// Exact rotation by the vector t = 2 tan(angle/2) axis (Cayley): no trigonometry, keeps the length.
  SCREE_INLINE static Vec3 rotate(const Vec3& t, const Vec3& a) {
    const Vec3 b = t.cross(a);
    return a + (1.0 / (1.0 + 0.25 * t.squaredNorm())) * (b + 0.5 * t.cross(b));
  }
  Vec3 turn_;
};

/// A contact for a law that also reads spins; the kernel then keeps them.
class SpinContact : public Contact {
 public:
  Vec3 spin;  ///< angular velocity of piece 2 relative to piece 1, rad/s

  /// Relative rotation about the normal over the motion that led here, rad.
  SCREE_INLINE double twist() const { return dt * spin.dot(normal); }
  /// Relative rotation about axes in the tangential plane over the motion that led here, rad.
  SCREE_INLINE Vec3 bend() const { return dt * (spin - spin.dot(normal) * normal); }
};

/// The answer of `law_normal`.
struct NormalResponse {
  double force = 0;  ///< along the normal on piece 2, N: positive pushes the pieces apart
};

/// The answer of a law.
struct Response {
  Vec3 force;            ///< on piece 2 at the contact point, N
  bool sliding = false;  ///< the friction limit holds the shear force
};

/// The answer of a law that also transmits a moment.
struct MomentResponse : Response {
  Vec3 moment;  ///< on piece 2, beyond that of the force about its centre, N m
};

/// Tangent stiffness of one contact, from which the stable step is computed: too small a value makes a run unstable.
struct Stiffness {
  double normal = 0;         ///< N/m
  double shear = 0;          ///< N/m
  double bending = 0;        ///< N m/rad
  double twist = 0;          ///< N m/rad
  double dashpot = 0;        ///< share of critical damping, normal
  double dashpot_shear = 0;  ///< share of critical damping, shear
};

/// Energies of one contact, asked for only when a scene traces them.
struct Energies {
  double strain = 0;    ///< stored now, J
  double friction = 0;  ///< lost to slip over the motion that led here, J, not negative
  double dashpot = 0;   ///< lost to dashpots over the motion that led here, J, not negative
  double broken = 0;    ///< stored in a bond that broke just now, J
};

}  // namespace scree
