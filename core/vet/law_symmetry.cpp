#include <algorithm>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"

// State is never transformed here: both sides of a comparison live through the same path from birth, so that nothing
// need be known of what the words of a state mean.

namespace scree::core::vet {

namespace {

constexpr double tight = 1e-12;  // a few hundred roundings
constexpr std::size_t contacts = 8;
constexpr uint32_t steps = 30;

/// Largest force and moment so far, for each contact: what a difference is measured by. What slip adds in one step
/// counts too, since a law that caps a nearly cancelled sum keeps the roundings of its larger part.
class Sizes {
 public:
  Sizes(const Case& c, std::size_t count) : lever_(1e-4 * (c.r1 + c.r2)), force_(count, 0.0), moment_(count, 0.0) {}
  void see(LawBench& bench, const std::vector<Seen>& seen) {
    for (std::size_t i = 0; i < force_.size(); ++i) {
      const Tangent k = bench.tangent(i);
      force_[i] = std::max({force_[i], bench.force(i).norm(), k.shear * seen[i].velocity.norm() * bench.dt});
      moment_[i] = std::max({moment_[i], bench.moment(i).norm(), k.bending * seen[i].spin.norm() * bench.dt});
    }
  }
  double share(std::size_t i, const Vec3& force, const Vec3& moment) const {
    // A moment that is rounding alone is measured by the force.
    return std::max(part(force, force_[i]), part(moment, std::max(moment_[i], lever_ * force_[i])));
  }

 private:
  static double part(const Vec3& difference, double size) {
    const double d = difference.norm();
    return d == 0 ? 0.0 : d / size;
  }
  double lever_;
  std::vector<double> force_, moment_;
};

std::string two(const Vec3& a, const Vec3& b) {
  return fmt::format("force ({:.9g}, {:.9g}, {:.9g}) N against ({:.9g}, {:.9g}, {:.9g}) N", a.x, a.y, a.z, b.x, b.y,
                     b.z);
}

/// A rotation by a random angle, and what it does to what a law sees.
class Turned {
 public:
  explicit Turned(Numbers& random) : turn_(random.spread(0.5, 20) * random.direction()) {}
  Vec3 operator()(const Vec3& v) const { return rotated(turn_, v); }
  Seen operator()(Seen s) const {
    for (Vec3* v : {&s.normal, &s.velocity, &s.spin, &s.turn}) *v = rotated(turn_, *v);
    return s;
  }
  /// Vectors among the properties are those of the scene and turn with it.
  Case operator()(Case c) const {
    for (uint32_t k = 0; k < c.model->property_count; ++k) {
      const scree_property& p = c.model->properties[k];
      if (p.type != SCREE_VECTOR) continue;
      double* w = &c.words[p.word];
      const Vec3 v = (*this)(Vec3{w[0], w[1], w[2]});
      w[0] = v.x, w[1] = v.y, w[2] = v.z;
    }
    return c;
  }

 private:
  Vec3 turn_;
};

}  // namespace

Outcome exchange(const Subject& subject) {
  Worst worst;
  for_cases(subject, 32, 11, [&](const Case& c, Part part) {
    if (c.r2 == 0) return;  // a wall is always piece 2
    Party party(c, part, contacts, 12, true);
    party.restart(steps);
    const auto here = party.bench();
    LawBench there(*c.model, part, contacts, c.exchanged().words);
    there.reach = here->reach;
    here->dt = there.dt = c.dt;
    Sizes sizes(c, contacts);
    while (!party.done()) {
      party.step(c.dt);
      party.put(*here);
      for (std::size_t i = 0; i < contacts; ++i) {
        Seen s = party.seen[i];
        for (Vec3* v : {&s.normal, &s.velocity, &s.spin}) *v = -*v;
        std::swap(s.r1, s.r2);
        there.put(i, s);
      }
      here->run();
      there.run();
      sizes.see(*here, party.seen);
      for (std::size_t i = 0; i < contacts; ++i)
        worst.see(sizes.share(i, here->force(i) + there.force(i), here->moment(i) + there.moment(i)), [&] {
          return two(here->force(i), -there.force(i)) + " with the pieces exchanged; " +
                 text_of(c, part, party.seen[i]);
        });
    }
  });
  return worst.judged(tight,
                      "force and moment on piece 2 must be those on piece 1, reversed (Newton's third law): use "
                      "'normal', 'r1' and 'r2' so that exchanging the pieces only changes the sign");
}

Outcome frame_turn(const Subject& subject) {
  Worst worst;
  Numbers random(21);
  for_cases(subject, 32, 22, [&](const Case& c, Part part) {
    Party party(c, part, contacts, 23, true);
    party.restart(steps);
    const Turned turned(random);
    const auto here = party.bench();
    LawBench there(*c.model, part, contacts, turned(c).words);
    there.reach = here->reach;
    here->dt = there.dt = c.dt;
    Sizes sizes(c, contacts);
    while (!party.done()) {
      party.step(c.dt);
      party.put(*here);
      for (std::size_t i = 0; i < contacts; ++i) there.put(i, turned(party.seen[i]));
      here->run();
      there.run();
      sizes.see(*here, party.seen);
      for (std::size_t i = 0; i < contacts; ++i)
        worst.see(sizes.share(i, turned(here->force(i)) - there.force(i), turned(here->moment(i)) - there.moment(i)),
                  [&] {
                    return two(turned(here->force(i)), there.force(i)) + " in a turned frame; " +
                           text_of(c, part, party.seen[i]);
                  });
    }
  });
  return worst.judged(tight,
                      "the force must not depend on the axes of the scene (objectivity): build it from 'normal', "
                      "slip, spin and remembered vectors, never from single components");
}

Outcome turns_along(const Subject& subject) {
  Worst worst;
  for_cases(subject, 16, 31, [&](const Case& c, Part part) {
    Party still(c, part, contacts, 32, false), turning(c, part, contacts, 32, true);
    still.restart(8 * steps);
    turning.restart(8 * steps);
    const auto here = still.bench(), there = turning.bench();
    here->dt = there->dt = c.dt;
    Sizes sizes(c, contacts);
    const auto local = [](const Journey& j, const Vec3& v) {
      return Vec3{v.dot(j.normal()), v.dot(j.across(0)), v.dot(j.across(1))};
    };
    while (!still.done()) {
      still.step(c.dt);
      turning.step(c.dt);
      still.put(*here);
      turning.put(*there);
      here->run();
      there->run();
      sizes.see(*here, still.seen);
      for (std::size_t i = 0; i < contacts; ++i) {
        const Journey &a = still.journeys[i], &b = turning.journeys[i];
        const Vec3 force = local(a, here->force(i)), other = local(b, there->force(i));
        worst.see(sizes.share(i, force - other, local(a, here->moment(i)) - local(b, there->moment(i))), [&] {
          return two(force, other) + " (normal and two shears) when the pair turns as a whole; " +
                 text_of(c, part, turning.seen[i]);
        });
      }
    }
  });
  return worst.judged(1e-5,
                      "a pair that turns as a whole must keep its forces: pass every remembered vector through "
                      "'c.turned(...)' or 'c.carried(...)' before it is used");
}

}  // namespace scree::core::vet
