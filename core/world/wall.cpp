#include "core/world/wall.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/crash_note.hpp"
#include "core/base/error.hpp"

namespace scree::core {

namespace {
using V = std::array<double, 3>;

V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

V rotated(const std::array<double, 4>& q, double sign, const V& v) {
  const V axis{sign * q[1], sign * q[2], sign * q[3]};
  const V once = cross(axis, v);
  const V twice = cross(axis, once);
  return {v[0] + 2 * (q[0] * once[0] + twice[0]), v[1] + 2 * (q[0] * once[1] + twice[1]),
          v[2] + 2 * (q[0] * once[2] + twice[2])};
}

// A block of balls with a thousand touches each: more is a count that nobody meant.
constexpr uint32_t most_touches = 1u << 20;

double size(const V& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
}  // namespace

void Wall::refuse(const std::string& does) const {
  throw Refusal(Exit::plugin, "wall '" + name + "' (plug-in '" + plugin + "') " + does +
                                  ": report it to the plug-in's author, or use another wall");
}

uint32_t Wall::touch(uint32_t n, const double* x, const double* y, const double* z, const double* reach,
                     const scree_touches& out) const {
  const CrashNote before = crash_note.read();
  crash_note = {plugin.c_str(), name.c_str(), before.cycle, before.block};
  const uint32_t count = table->touch(geometry.get(), n, x, y, z, reach, &out);
  crash_note = before;
  if (count == UINT32_MAX) refuse("threw an exception while it was asked for touches");
  if (count > most_touches)
    refuse("gives " + std::to_string(count) + " touches for " + std::to_string(n) + " balls, more than any surface");
  for (uint32_t k = 0; k < std::min(count, out.capacity); ++k) {
    if (out.ball[k] >= n)
      refuse("gives a touch of ball " + std::to_string(out.ball[k]) + " of " + std::to_string(n) +
             " that it was asked about");
    const double square = out.nx[k] * out.nx[k] + out.ny[k] * out.ny[k] + out.nz[k] * out.nz[k];
    if (!(std::fabs(square - 1) <= 1e-6)) refuse("gives a normal that is not of length 1");
    if (!std::isfinite(out.distance[k])) refuse("gives a distance that is not a finite number");
  }
  return count;
}

std::array<double, 3> Wall::to_frame(const V& point) const {
  V relative{point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]};
  if (turned()) relative = rotated(turn, -1, relative);
  return {relative[0] + first_centre[0], relative[1] + first_centre[1], relative[2] + first_centre[2]};
}

std::array<double, 3> Wall::from_frame(const V& direction) const {
  return turned() ? rotated(turn, 1, direction) : direction;
}

std::array<double, 3> Wall::direction_to_frame(const V& direction) const {
  return turned() ? rotated(turn, -1, direction) : direction;
}

void Wall::drift(double dt) {
  for (int k = 0; k < 3; ++k) centre[static_cast<std::size_t>(k)] += velocity[static_cast<std::size_t>(k)] * dt;
  const double rate = size(spin);
  if (rate == 0) return;
  // tan of the half angle: exact for the finite rotation, and needs no sine whose bits differ between libraries.
  const double half = 0.5 * rate * dt;
  const double t = half * (1 + half * half / 3 * (1 + 2 * half * half / 5 * (1 + 17 * half * half / 42)));
  const double c = 1 / std::sqrt(1 + t * t), s = t * c / rate;
  const std::array<double, 4> p{c, s * spin[0], s * spin[1], s * spin[2]}, q = turn;
  turn = {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
  double norm = 0;
  for (double value : turn) norm += value * value;
  norm = 1 / std::sqrt(norm);
  for (double& value : turn) value *= norm;
}

double Wall::travel(double dt, double reach) const { return (size(velocity) + size(spin) * reach) * dt; }

}  // namespace scree::core
