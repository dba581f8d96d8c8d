// Turning remembered vectors with a contact, against Rodrigues' formula.
#include <scree/contact.hpp>

#include <cmath>

#include "laws/columns.hpp"
#include "support/catch.hpp"

namespace {
using scree::Contact;
using scree::Vec3;
using scree::test::Numbers;

Vec3 rodrigues(const Vec3& axis, double angle, const Vec3& a) {
  return std::cos(angle) * a + std::sin(angle) * axis.cross(a) + (1 - std::cos(angle)) * axis.dot(a) * axis;
}

}  // namespace

TEST_CASE("a remembered vector turns exactly with the contact") {
  Numbers random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 old_normal = random.vector(1).normalized(), axis = old_normal.cross(random.vector(1)).normalized();
    const double tilt = random.between(0, 0.5), spin = random.between(-0.5, 0.5);
    Contact c{};
    c.normal = rodrigues(axis, tilt, old_normal);
    c.set_turn(2 * std::tan(tilt / 2) * axis + 2 * std::tan(spin / 2) * c.normal);
    const auto exact = [&](const Vec3& a) { return rodrigues(c.normal, spin, rodrigues(axis, tilt, a)); };

    const Vec3 any = random.vector(1), tangential = any - any.dot(old_normal) * old_normal;
    CHECK((c.carried(any) - exact(any)).norm() <= 1e-14);
    CHECK((c.carried(old_normal) - c.normal).norm() <= 1e-14);
    // `turned` adds the two turns instead of composing them: the difference is of second order in the step.
    CHECK(std::abs(c.turned(tangential).dot(c.normal)) <= 1e-15);
    CHECK((c.turned(tangential) - exact(tangential)).norm() <= 0.5 * tilt * std::abs(spin) * tangential.norm());
    c.set_turn(2 * std::tan(tilt / 2) * axis);
    CHECK((c.turned(tangential) - rodrigues(axis, tilt, tangential)).norm() <= 1e-14);
  }
}

TEST_CASE("slip, opening and dashpot of a contact") {
  Contact c{};
  c.normal = {0, 0, 1};
  c.dt = 0.5;
  c.mass = 4;
  c.set_velocity({1, 2, 3});
  CHECK(c.opening() == 3);
  CHECK((c.slip_rate() - Vec3{1, 2, 0}).norm() == 0);
  CHECK((c.slip() - Vec3{0.5, 1, 0}).norm() == 0);
  CHECK(c.dashpot(0.25, 9) == 3);  // 2 ratio sqrt(m k)
}
