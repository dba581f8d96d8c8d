#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "support/measure.hpp"
#include "support/scene_run.hpp"

/// A cloud of balls in a box of planes as plain data, so that a test can turn, mirror, renumber or scale all of it.
struct Cloud {
  using Vector = support::Triple;
  struct Body {
    uint64_t id;
    double radius;
    Vector position, velocity, spin;
  };
  struct Plane {
    Vector point, normal, velocity;
  };
  std::vector<Body> bodies;
  std::vector<Plane> planes;
  Vector gravity{};
  double kn = 1e5, ks = 5e4, emod = 0;  ///< emod instead of the two where it is not 0
  double timestep = 0;                  ///< s, 0: automatic
  double damping = 0.2;                 ///< share of critical, normal, between balls
  int dp_mode = 2;                      ///< between balls
  double bonds = 0;                     ///< Pa, strength of parallel bonds between grains; 0: none
};
using Matrix = std::array<Cloud::Vector, 3>;

inline double distance(const Cloud::Vector& a, const Cloud::Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

inline Cloud::Vector times(const Cloud::Vector& v, double s) { return {s * v[0], s * v[1], s * v[2]}; }

inline Cloud::Vector turned(const Matrix& m, const Cloud::Vector& v) {
  Cloud::Vector out{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      if (m[r][c] != 0) out[r] += m[r][c] * v[c];  // exact for signed permutations
  return out;
}

/// Spins are axial vectors: a mirror also reverses them.
inline Cloud turned(const Matrix& m, double determinant, Cloud cloud) {
  for (Cloud::Body& body : cloud.bodies) {
    body.position = turned(m, body.position);
    body.velocity = turned(m, body.velocity);
    body.spin = times(turned(m, body.spin), determinant);
  }
  for (Cloud::Plane& plane : cloud.planes) plane = {turned(m, plane.point), turned(m, plane.normal), {}};
  cloud.gravity = turned(m, cloud.gravity);
  return cloud;
}

/// All balls in the order of their ids, from 1.
inline std::vector<support::BallState> states(support::SceneRun& run) {
  std::vector<support::BallState> all;
  for (uint64_t id = 1; id <= run.engine().balls.size(); ++id) all.push_back(run.ball(id));
  return all;
}

/// Signed permutations of the axes with the given determinant: 24 turns or 24 mirror images of the cube.
inline std::vector<Matrix> cube_symmetries(double determinant) {
  std::vector<Matrix> all;
  std::array<std::size_t, 3> order{0, 1, 2};
  double parity[] = {1, -1, -1, 1, 1, -1};  // of the permutations in lexicographic order
  std::size_t k = 0;
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Matrix m{};
      double product = parity[k];
      for (std::size_t r = 0; r < 3; ++r) {
        const double sign = (signs >> r & 1u) != 0 ? -1 : 1;
        m[r][order[r]] = sign;
        product *= sign;
      }
      if (product == determinant) all.push_back(m);
    }
    ++k;
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

inline std::string text_of(const Cloud::Vector& v, const char* between = ", ") {
  return support::digits(v[0]) + between + support::digits(v[1]) + between + support::digits(v[2]);
}

inline std::string balls_of(const Cloud& cloud) {
  std::string text = "id,radius,x,y,z,vx,vy,vz,wx,wy,wz\n";
  for (const Cloud::Body& body : cloud.bodies)
    text += std::to_string(body.id) + "," + support::digits(body.radius) + "," + text_of(body.position, ",") + "," +
            text_of(body.velocity, ",") + "," + text_of(body.spin, ",") + "\n";
  return text;
}

/// Friction and both dashpots everywhere; grains among themselves otherwise than at walls.
inline std::string scene_of(const Cloud& cloud) {
  using support::digits;
  const std::string springs = cloud.emod > 0 ? "emod: " + digits(cloud.emod) + ", kratio: 2"
                                             : "kn: " + digits(cloud.kn) + ", ks: " + digits(cloud.ks);
  std::string text = "scree: 1\n";
  if (cloud.timestep > 0) text += "timestep: " + digits(cloud.timestep) + "\n";
  if (!cloud.planes.empty()) text += "walls:\n";
  for (std::size_t k = 0; k < cloud.planes.size(); ++k)
    text += "  side_" + std::string(1, static_cast<char>('a' + k)) + ": {wall: plane, point: [" +
            text_of(cloud.planes[k].point) + "], normal: [" + text_of(cloud.planes[k].normal) + "], velocity: [" +
            text_of(cloud.planes[k].velocity) + "]}\n";
  text += "balls:\n  grains: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n";
  const std::string cement = ", pb_kn: 1e8, pb_ks: 4e7, pb_ten: " + digits(cloud.bonds) +
                             ", pb_coh: " + digits(cloud.bonds) + ", pb_fa: 30 deg";
  text += "  - {name: grains, between: [grains, grains], model: " +
          (cloud.bonds > 0 ? "parallel_bond, " + springs + cement : "linear, " + springs) +
          ", fric: 0.4, dp_nratio: " + digits(cloud.damping) +
          ", dp_sratio: 0.1, dp_mode: " + std::to_string(cloud.dp_mode) + "}\n";
  if (!cloud.planes.empty())
    text +=
        "  - {between: [grains, walls], model: linear, " + springs + ", fric: 0.3, dp_nratio: 0.1, dp_sratio: 0.2}\n";
  text += "processes:\n  gravity: {process: gravity, acceleration: [" + text_of(cloud.gravity) + "]}\n";
  if (cloud.bonds > 0) text += "stages:\n  - glue: [bond: {rule: grains, gap: 0.5 mm}]\n";
  return text;
}

/// 60 balls of 9.8 to 11.4 mm on shaken sites of a cubic lattice of 22 mm, in a box around them: close enough to meet
/// many times within a few milliseconds. Some overlap a little from the start.
inline Cloud random_cloud(uint64_t seed) {
  const auto draw = [&seed](double low, double high) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * std::ldexp(static_cast<double>(seed >> 11), -53);
  };
  constexpr double spacing = 0.022, side = 4 * spacing;
  Cloud cloud;
  cloud.gravity = {0.5, -0.25, -9.81};
  cloud.timestep = 2e-5;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      Cloud::Plane plane{};
      plane.point[axis] = sign > 0 ? 0 : side;
      plane.normal[axis] = sign;
      cloud.planes.push_back(plane);
    }
  while (cloud.bodies.size() < 60) {
    const std::size_t site = cloud.bodies.size();
    const std::size_t index[] = {site % 4, site / 4 % 4, site / 16};
    Cloud::Body body{site + 1, draw(0.0098, 0.0114), {}, {}, {}};
    for (std::size_t c = 0; c < 3; ++c)
      body.position[c] = spacing * (static_cast<double>(index[c]) + 0.5) + draw(-0.001, 0.001);
    bool free = true;
    for (const Cloud::Body& other : cloud.bodies)
      free = free && std::hypot(body.position[0] - other.position[0], body.position[1] - other.position[1],
                                body.position[2] - other.position[2]) > 0.98 * (body.radius + other.radius);
    if (!free) continue;
    for (std::size_t c = 0; c < 3; ++c) body.velocity[c] = draw(-1, 1), body.spin[c] = draw(-40, 40);
    cloud.bodies.push_back(body);
  }
  return cloud;
}
