// The laws know no preferred axis, hand, numbering, rest frame or unit: a cloud of 60 colliding balls in a box, with
// friction, dashpots and gravity, must move alike when it is turned, mirrored, renumbered, set in motion or rescaled.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "scenes/cloud.hpp"

using namespace support;

namespace {

using Vector = Cloud::Vector;

constexpr double box = 0.1;  ///< m, to which differences of positions are compared

std::vector<BallState> after(const Cloud& cloud, uint64_t cycles) {
  SceneRun run(scene_of(cloud), balls_of(cloud));
  run.step(cycles);
  return states(run);
}

double worst_turned(const Cloud& cloud, double determinant, uint64_t cycles, std::size_t count) {
  const std::vector<BallState> plain = after(cloud, cycles);
  const std::vector<Matrix> all = cube_symmetries(determinant);
  REQUIRE(all.size() == count);
  double worst = 0;
  for (const Matrix& m : all) {
    const std::vector<BallState> other = after(turned(m, determinant, cloud), cycles);
    for (std::size_t k = 0; k < plain.size(); ++k)
      worst = std::max(worst, distance(turned(m, plain[k].position), other[k].position));
  }
  return worst / box;
}

}  // namespace

TEST_CASE("B7: the cloud collides, slides and sticks") {
  const Cloud cloud = random_cloud(7);
  SceneRun run(scene_of(cloud), balls_of(cloud));
  double met = 0, slid = 0, stuck = 0, pressed = 0;
  for (int k = 0; k < 50; ++k) {
    run.step(10);
    met = std::max(met, run.value("contacts.balls"));
    pressed = std::max(pressed, run.value("contacts.walls"));
    slid = std::max(slid, run.value("contacts.sliding"));
    stuck = std::max(stuck, run.value("contacts.count") - run.value("contacts.sliding"));
  }
  CHECK(met > 20);
  CHECK(pressed > 10);
  CHECK(slid > 3);
  CHECK(stuck > 3);
}

TEST_CASE("B7: the 24 turns of the cube give the same motion, turned") {
  Measure("B7 turns", "isotropy: no preferred axis; balls, planes and gravity turned together, 500 cycles")
      .check("largest distance, relative to the box", worst_turned(random_cloud(7), 1, 500, 24), 0, 1e-13);
}

TEST_CASE("B7: the 24 mirror images give the same motion, mirrored") {
  Measure("B7 mirror", "parity: spins are axial vectors; all improper symmetries of the cube, 500 cycles")
      .check("largest distance, relative to the box", worst_turned(random_cloud(11), -1, 500, 24), 0, 1e-13);
}

TEST_CASE("B7: renumbered balls move alike") {
  Measure measure("B7 renumbering", "numbers are names: ids permuted and file reversed, 300 cycles");
  const Cloud cloud = random_cloud(13);
  Cloud renumbered = cloud;
  const uint64_t n = cloud.bodies.size();
  const auto fresh = [n](uint64_t id) { return (id * 37 + 11) % n + 1; };  // 37 has no divisor with 60
  for (Cloud::Body& body : renumbered.bodies) body.id = fresh(body.id);
  std::reverse(renumbered.bodies.begin(), renumbered.bodies.end());
  const std::vector<BallState> plain = after(cloud, 300), other = after(renumbered, 300);
  double worst = 0;
  for (std::size_t k = 0; k < n; ++k)
    worst = std::max(worst, distance(plain[k].position, other[fresh(k + 1) - 1].position));
  measure.check("largest distance, relative to the box", worst / box, 0, 1e-12);
}

TEST_CASE("B7: a moving observer sees the same motion") {
  Measure measure("B7 Galilei",
                  "Galilean invariance: balls and walls with 1.15 m/s more, 10 000 cycles, no local damping");
  Cloud cloud = random_cloud(19);
  // Slow balls, strong dashpots without switches and 0.1 s: in a lively gas every collision multiplies the rounding of
  // positions, 1e-17 m here, until any two runs differ.
  cloud.damping = 0.8;
  cloud.dp_mode = 0;
  cloud.timestep = 1e-5;
  for (Cloud::Body& body : cloud.bodies) body.velocity = times(body.velocity, 0.03);
  Cloud moving = cloud;
  const Vector wind{1, 0.5, -0.25};
  for (Cloud::Body& body : moving.bodies)
    for (std::size_t c = 0; c < 3; ++c) body.velocity[c] += wind[c];
  for (Cloud::Plane& plane : moving.planes) plane.velocity = wind;
  SceneRun still(scene_of(cloud), balls_of(cloud)), moved(scene_of(moving), balls_of(moving));
  constexpr uint64_t cycles = 10000;
  still.step(cycles);
  moved.step(cycles);
  const std::vector<BallState> plain = states(still), other = states(moved);
  double worst = 0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    Vector back = other[k].position;
    for (std::size_t c = 0; c < 3; ++c) back[c] -= wind[c] * moved.time();
    worst = std::max(worst, distance(plain[k].position, back));
  }
  measure.check("largest distance, relative to the box", worst / box, 0, 1e-10);
}

TEST_CASE("B7: scaling by a power of two changes no bit of a shape") {
  // Lengths and times twofold, the same density: velocities and stresses stay, spins and gravity halve, stiffness of a
  // contact doubles, forces are fourfold. Powers of two are exact in binary, so the numbers must agree bit for bit.
  for (const bool modulus : {false, true}) {
    Measure measure("B7 scaling",
                    "similarity: lengths and times x2, stresses x1, forces x4, bit for bit, 2000 automatic steps");
    Cloud cloud = random_cloud(19);
    cloud.timestep = 0;  // the automatic step must scale too
    if (modulus) cloud.emod = 3e6;
    Cloud large = cloud;
    for (Cloud::Body& body : large.bodies) {
      body.radius *= 2;
      body.position = times(body.position, 2);
      body.spin = times(body.spin, 0.5);
    }
    for (Cloud::Plane& plane : large.planes) plane.point = times(plane.point, 2);
    large.gravity = times(large.gravity, 0.5);
    large.kn *= 2;
    large.ks *= 2;
    SceneRun small_run(scene_of(cloud), balls_of(cloud)), large_run(scene_of(large), balls_of(large));
    small_run.step(2000);
    large_run.step(2000);
    const std::vector<BallState> a = states(small_run), b = states(large_run);
    double different = small_run.time() * 2 == large_run.time() ? 0 : 1;
    for (std::size_t k = 0; k < a.size(); ++k) {
      different += times(a[k].position, 2) != b[k].position;
      different += a[k].velocity != b[k].velocity;
      different += times(a[k].spin, 0.5) != b[k].spin;
      different += times(a[k].force, 4) != b[k].force;
    }
    CHECK(small_run.engine().rebuilds() > 1);
    measure.check(std::string("vectors that differ, of 240, with ") + (modulus ? "emod kratio" : "kn ks"), different, 0,
                  0);
  }
}

TEST_CASE("B7: action equals reaction") {
  Measure measure("B7 third law",
                  "Newton 1687: forces on balls without weight, plus those on walls, sum to zero, 200 instants");
  const Cloud cloud = random_cloud(23);
  SceneRun run(scene_of(cloud), balls_of(cloud));
  double worst = 0, contacts = 0;
  for (int k = 0; k < 200; ++k) {
    run.step(10);
    Vector sum{};
    for (const BallState& ball : states(run))
      for (std::size_t c = 0; c < 3; ++c) sum[c] += ball.force[c] - ball.mass * cloud.gravity[c];
    for (const auto& wall : run.engine().walls)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += wall.force[c];
    double sizes = 0;
    for (const auto& contact : run.quantities().instant().contacts())
      sizes += std::hypot(contact.force[0], contact.force[1], contact.force[2]);
    contacts += sizes > 0;
    if (sizes > 0) worst = std::max(worst, distance(sum, {}) / sizes);
  }
  REQUIRE(contacts > 190);
  measure.check("largest sum of forces over sum of |F|", worst, 0, 1e-12);
}
