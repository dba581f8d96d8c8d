#include "core/vet/journey.hpp"

#include <algorithm>

namespace scree::core::vet {

Vec3 rotated(const Vec3& t, const Vec3& a) {
  const Vec3 b = t.cross(a);
  return a + (1.0 / (1.0 + 0.25 * t.squaredNorm())) * (b + 0.5 * t.cross(b));
}

Journey::Journey(const Case& c, Part part, uint64_t seed, bool turning) : piece_(c.seen()) {
  Numbers random(seed);
  const double radius = c.r2 > 0 ? std::min(c.r1, c.r2) : c.r1, apart = c.reach + 0.1 * c.depth;
  const double slip = c.depth * random.spread(0.1, 2), angle = 2 * c.depth / radius;
  const bool bonded = part == Part::bonded;
  points_[0][0] = points_[legs][0] = bonded ? 0.0 : apart;
  for (uint32_t k = 1; k < legs; ++k) {
    Point& p = points_[k];
    const bool far = random.chance(bonded ? 0.5 : 0.15);
    p[0] = far ? random.between(0, bonded ? c.depth : apart) : -c.depth * random.between(0.05, 1);
    for (std::size_t w = 1; w < 3; ++w) p[w] = random.between(-slip, slip);
    for (std::size_t w = 3; w < 6; ++w) p[w] = random.between(-angle, angle);
  }
  if (random.chance(0.4)) go_round(c.depth, random);
  if (turning)
    for (Vec3& turn : turns_) turn = random.vector(0.8);
  start_[0] = random.direction();
  start_[1] = start_[0].cross(random.direction()).normalized();
  start_[2] = start_[0].cross(start_[1]);
  restart(1);
}

void Journey::go_round(double depth, Numbers& random) {
  // Loads across the normal at one overlap and unloads at another: the loop that tells what a changing stiffness does.
  const double deep = -depth * random.between(0.6, 1), shallow = deep * random.between(0.3, 0.6);
  // Little enough to stick at the smaller overlap with usual friction.
  const double slip = -shallow * random.between(0.1, 0.5);
  const bool in_first = random.chance(0.5);
  const double first = in_first ? deep : shallow, second = in_first ? shallow : deep;
  const double gaps[] = {first, first, second, second, shallow};
  for (uint32_t k = 1; k < legs; ++k) {
    Point& p = points_[k];
    const bool loaded = k == 2 || k == 3;
    p[0] = gaps[k - 1];
    for (std::size_t w = 1; w < p.size(); ++w) p[w] = 0;
    if (loaded) p[1] = slip;
    if (loaded && random.chance(0.5)) p[3 + random.below(3)] = slip / (piece_.r1 + piece_.r2);
  }
}

void Journey::restart(uint32_t steps_per_leg) {
  steps_ = steps_per_leg;
  step_ = 0;
  frame_ = start_;
  at_ = points_[0];
}

Journey::Point Journey::place(uint32_t step) const {
  const uint32_t leg = std::min(step / steps_, legs - 1);
  const double t = static_cast<double>(step - leg * steps_) / steps_;
  // Speed goes to zero at every point, so that velocities are continuous.
  const double share = t * t * (3 - 2 * t);
  Point p;
  for (std::size_t w = 0; w < p.size(); ++w) p[w] = points_[leg][w] + share * (points_[leg + 1][w] - points_[leg][w]);
  return p;
}

void Journey::turn_frame(uint32_t leg, Vec3& turn) {
  const Vec3 part = turns_[leg] / steps_;
  const Vec3 tilt = part.x * frame_[1] + part.y * frame_[2];
  for (Vec3& axis : frame_) axis = rotated(tilt, axis);
  const Vec3 spin = part.z * frame_[0];
  frame_[1] = rotated(spin, frame_[1]);
  frame_[0] = frame_[0].normalized();
  frame_[1] = (frame_[1] - frame_[1].dot(frame_[0]) * frame_[0]).normalized();
  frame_[2] = frame_[0].cross(frame_[1]);
  turn = tilt + spin;
}

Seen Journey::next(double dt) {
  const uint32_t leg = std::min(step_ / steps_, legs - 1);
  const Point before = at_;
  at_ = place(++step_);
  Seen s = piece_;
  turn_frame(leg, s.turn);
  const auto rate = [&](std::size_t w) { return (at_[w] - before[w]) / dt; };
  s.normal = frame_[0];
  s.gap = at_[0];
  s.velocity = rate(0) * frame_[0] + rate(1) * frame_[1] + rate(2) * frame_[2];
  s.spin = rate(5) * frame_[0] + rate(3) * frame_[1] + rate(4) * frame_[2];
  return s;
}

Seen Journey::still() const {
  Seen s = piece_;
  s.normal = frame_[0];
  s.gap = at_[0];
  return s;
}

Party::Party(const Case& c, Part of, std::size_t count, uint64_t seed, bool turning) : model_case(c), part(of) {
  Numbers random(seed);
  for (std::size_t i = 0; i < count; ++i) journeys.emplace_back(c, of, random.bits(), turning);
  seen.resize(count);
}

void Party::restart(uint32_t steps_per_leg) {
  for (Journey& journey : journeys) journey.restart(steps_per_leg);
}

void Party::step(double dt) {
  for (std::size_t i = 0; i < journeys.size(); ++i) seen[i] = journeys[i].next(dt);
}

void Party::rest() {
  for (std::size_t i = 0; i < journeys.size(); ++i) seen[i] = journeys[i].still();
}

void Party::put(LawBench& bench) const {
  for (std::size_t i = 0; i < seen.size(); ++i) bench.put(i, seen[i]);
}

std::unique_ptr<LawBench> Party::bench() const {
  auto bench = std::make_unique<LawBench>(*model_case.model, part, seen.size(), model_case.words);
  std::fill(bench->reach.begin(), bench->reach.end(), model_case.reach);
  return bench;
}

}  // namespace scree::core::vet
