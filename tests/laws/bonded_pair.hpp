#pragma once
// One bonded contact of two balls, moved by displacements; with an account of the work done on it.
#include <cmath>

#include "laws/columns.hpp"

namespace scree::test {

class BondedPair {
 public:
  BondedPair(const scree_contact_model& model, const std::vector<double>& rule, double gap = 0)
      : columns(model, rule, 1) {
    columns.bonded = columns.energy = true;
    contact.gap = gap;
  }
  /// Moves and turns piece 2 in one cycle, the normal being z.
  void move(const Vec3& displacement, const Vec3& rotation = {}) {
    contact.velocity = displacement / columns.dt;
    contact.spin = rotation / columns.dt;
    contact.gap += displacement.z;
    const Vec3 force = columns.force(0), moment = columns.moment(0);
    columns.put(0, contact);
    breaks += columns.run();
    work -= 0.5 * ((force + columns.force(0)).dot(displacement) + (moment + columns.moment(0)).dot(rotation));
    lost += columns.energies(1, 0) + columns.energies(2, 0) + columns.energies(3, 0);
    broken += columns.energies(3, 0);
  }
  Vec3 force() const { return columns.force(0); }
  Vec3 moment() const { return columns.moment(0); }
  double strain() const { return columns.energies(0, 0); }

  Columns columns;
  OneContact contact;
  uint32_t breaks = 0;
  double work = 0, lost = 0, broken = 0;
};

/// Largest change of the load, as seen by the pair, while it is carried round as a rigid body: the balls orbit each
/// other about y and spin with it, or spin about the line between them. Velocities are those of a leapfrog: the chord
/// over a step, at the normal of its end.
inline double change_in_turns(BondedPair pair, int turns, int steps, bool about_normal) {
  const double angle = 2 * std::acos(-1.0) / steps, length = pair.contact.r1 + pair.contact.r2 + pair.contact.gap;
  const Vec3 force = pair.force(), moment = pair.moment();
  double worst = 0;
  for (int k = 1; k <= turns * steps; ++k) {
    const double a = k * angle, tangent = 2 * std::tan(angle / 2);
    const Vec3 ex = about_normal ? Vec3{std::cos(a), std::sin(a), 0} : Vec3{std::cos(a), 0, -std::sin(a)};
    const Vec3 ez = about_normal ? Vec3{0, 0, 1} : Vec3{std::sin(a), 0, std::cos(a)}, ey = ez.cross(ex);
    if (about_normal) {
      pair.contact.turn = tangent * ez;
    } else {
      const Vec3 before{std::sin(a - angle), 0, std::cos(a - angle)}, chord = length * (ez - before);
      pair.contact.turn = tangent * ey;
      pair.contact.velocity = (chord - (angle * length) * ey.cross(ez)) / pair.columns.dt;
    }
    pair.contact.normal = ez;
    if (about_normal) pair.contact.velocity = {};
    pair.contact.spin = {};
    pair.columns.put(0, pair.contact);
    pair.breaks += pair.columns.run();
    const auto local = [&](const Vec3& v) { return Vec3{v.dot(ex), v.dot(ey), v.dot(ez)}; };
    worst = std::max(worst, (local(pair.force()) - force).norm() / force.norm());
    if (moment.norm() > 0) worst = std::max(worst, (local(pair.moment()) - moment).norm() / moment.norm());
  }
  return pair.breaks == 0 ? worst : 1;
}

}  // namespace scree::test
