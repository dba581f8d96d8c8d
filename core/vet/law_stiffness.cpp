#include <algorithm>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"

// The tangent that a law reports against finite differences of its forces, from states along random paths. A law whose
// tangent is larger than it says makes the automatic time step unstable.

namespace scree::core::vet {

namespace {

constexpr std::size_t contacts = 6;
constexpr uint32_t steps = 24;
enum Direction { normal, shear_1, shear_2, bend_1, bend_2, twist, direction_count };

/// Forces on piece 2 against displacements of piece 2, each one-sided: a law may be stiffer one way than the other.
struct Measured {
  double normal = 0, shear = 0, bending = 0, twist = 0;
};

/// Copies of one contact, each moved a little from where it is: one stays, two for each direction.
class Probe {
 public:
  Probe(const Case& c, Part part) : bench_(*c.model, part, 1 + 2 * direction_count, c.words) {
    bench_.dt = c.slow();
    std::fill(bench_.reach.begin(), bench_.reach.end(), c.reach);
    const double radius = c.r2 > 0 ? std::min(c.r1, c.r2) : c.r1;
    length_ = 1e-5 * c.depth;
    angle_ = length_ / radius;
  }
  Measured at(const Seen& seen, const Journey& journey, const LawBench& from, std::size_t i) {
    axes_ = {journey.normal(), journey.across(0), journey.across(1)};
    for (std::size_t k = 0; k < bench_.size(); ++k) {
      bench_.copy_state(k, from, i);
      bench_.put(k, moved(seen, k));
    }
    bench_.run();
    Measured m;
    m.normal = slope(normal);
    m.shear = std::max(slope(shear_1), slope(shear_2));
    m.bending = std::max(slope(bend_1), slope(bend_2));
    m.twist = slope(twist);
    return m;
  }

 private:
  static bool turns(std::size_t direction) { return direction >= bend_1; }
  const Vec3& axis(std::size_t direction) const {
    constexpr std::size_t which[] = {0, 1, 2, 1, 2, 0};
    return axes_[which[direction]];
  }
  Seen moved(Seen s, std::size_t k) const {
    s.velocity = s.spin = s.turn = {};
    if (k == 0) return s;
    const std::size_t direction = (k - 1) / 2;
    const double step = ((k - 1) % 2 == 0 ? 1 : -1) * (turns(direction) ? angle_ : length_);
    if (direction == normal) s.gap += step;
    (turns(direction) ? s.spin : s.velocity) = (step / bench_.dt) * axis(direction);
    return s;
  }
  double slope(std::size_t direction) const {
    const std::size_t k = 1 + 2 * direction;
    const auto answer = [&](std::size_t j) {
      return (turns(direction) ? bench_.moment(j) : bench_.force(j)).dot(axis(direction));
    };
    const double step = turns(direction) ? angle_ : length_;
    return std::max((answer(0) - answer(k)) / step, (answer(k + 1) - answer(0)) / step);
  }

  LawBench bench_;
  std::array<Vec3, 3> axes_{};
  double length_ = 0, angle_ = 0;
};

/// Visits states along random paths and hands over what is reported there and what is measured.
template <class Visit>
void visit_states(const Subject& subject, Part wanted, uint64_t seed, Visit visit) {
  for_cases(subject, 40, seed, [&](const Case& c, Part part) {
    if (part != wanted) return;
    Party party(c, part, contacts, seed + 1, true);
    party.restart(steps);
    const auto bench = party.bench();
    bench->dt = c.slow();
    Probe probe(c, part);
    for (uint32_t k = 0; !party.done(); ++k) {
      party.step(bench->dt);
      party.put(*bench);
      bench->run();
      if (k % 5 != 4) continue;
      for (std::size_t i = 0; i < contacts; ++i) {
        const Seen& s = party.seen[i];
        // Within a step of the probe from the end of reach the pair may be dropped, which is no tangent of the law.
        if (part == Part::touch && s.gap > c.reach - 1e-3 * c.depth) continue;
        visit(c, part, s, bench->tangent(i), probe.at(s, party.journeys[i], *bench, i));
      }
    }
  });
}

struct Compared {
  const char* name;
  double reported, measured;
  const char* unit;
};
std::array<Compared, 4> compared(const Tangent& t, const Measured& m) {
  return {{{"normal", t.normal, m.normal, "N/m"},
           {"shear", t.shear, m.shear, "N/m"},
           {"bending", t.bending, m.bending, "N m/rad"},
           {"twist", t.twist, m.twist, "N m/rad"}}};
}

/// How far the measured value lies above the reported one, as a share.
double excess(const Compared& c, double scale) {
  if (!std::isfinite(c.reported) || c.reported < 0) return std::numeric_limits<double>::infinity();
  const double above = c.measured - c.reported;
  return above <= 1e-7 * scale ? 0.0 : c.reported > 0 ? above / c.reported : std::numeric_limits<double>::infinity();
}

constexpr const char* understated =
    "'stiffness' must not be less than the slope of the force: the stable time step follows from it";

Outcome compare(const Subject& subject, Part part, std::size_t first, std::size_t last, uint64_t seed) {
  Worst worst;
  visit_states(subject, part, seed, [&](const Case& c, Part of, const Seen& s, const Tangent& t, const Measured& m) {
    const auto list = compared(t, m);
    const double radius = c.r2 > 0 ? std::min(c.r1, c.r2) : c.r1;
    for (std::size_t k = first; k < last; ++k) {
      // Rounding of a force of this size shows as a slope even where there is none.
      const double scale = std::max(c.stiffness, t.normal) * (k < 2 ? 1 : radius * radius);
      worst.see(excess(list[k], scale), [&] {
        return fmt::format("{} stiffness {:.6g} {} reported, {:.6g} measured; {}", list[k].name, list[k].reported,
                           list[k].unit, list[k].measured, text_of(c, of, s));
      });
    }
  });
  return worst.judged(0.01, understated);
}

}  // namespace

Outcome stiffness_touch(const Subject& subject) { return compare(subject, Part::touch, 0, 2, 61); }

Outcome stiffness_rotation(const Subject& subject) {
  if ((subject.component->contact_model().flags & SCREE_GIVES_MOMENT) == 0) throw Skipped("the law gives no moment");
  return compare(subject, Part::touch, 2, 4, 63);
}

Outcome stiffness_bonded(const Subject& subject) {
  if (parts(subject.component->contact_model()).size() == 1) throw Skipped("the law has no bond");
  return compare(subject, Part::bonded, 0, 4, 65);
}

Outcome stiffness_generous(const Subject& subject) {
  // Largest reported over largest measured for one rule: a state that happens to be soft does not count.
  struct Most {
    std::array<double, 4> reported{}, measured{};
    std::string text;
  };
  std::vector<Most> all;
  const Case* last = nullptr;
  for (const Part part : parts(subject.component->contact_model()))
    visit_states(subject, part, 67, [&](const Case& c, Part of, const Seen&, const Tangent& t, const Measured& m) {
      if (&c != last) all.push_back({{}, {}, std::string(part_name(of)) + ", " + c.text});
      last = &c;
      const auto list = compared(t, m);
      for (std::size_t k = 0; k < list.size(); ++k) {
        all.back().reported[k] = std::max(all.back().reported[k], list[k].reported);
        all.back().measured[k] = std::max(all.back().measured[k], list[k].measured);
      }
    });
  Worst worst;
  for (const Most& most : all)
    if (most.measured[0] > 0)
      worst.see(most.reported[0] / most.measured[0], [&] {
        return fmt::format(
            "normal stiffness up to {:.4g} N/m reported, up to {:.4g} N/m measured: the time step is {:.1f} "
            "times shorter than it need be; {}",
            most.reported[0], most.measured[0], std::sqrt(most.reported[0] / most.measured[0]), most.text);
      });
  Outcome outcome = worst.judged(3, "report the tangent itself, if no part of the law needs more");
  if (outcome.verdict == Verdict::fail) outcome.verdict = Verdict::note;
  return outcome;
}

Outcome dashpot_share(const Subject& subject) {
  Worst worst;
  for_cases(subject, 40, 71, [&](const Case& c, Part part) {
    LawBench bench(*c.model, part, 3, c.words);
    std::fill(bench.reach.begin(), bench.reach.end(), c.reach);
    Numbers random(72);
    for (const bool shear : {false, true}) {
      Seen s = c.seen();
      s.normal = random.direction();
      s.gap = -c.depth;
      const Vec3 along = shear ? s.normal.cross(random.direction()).normalized() : s.normal;
      const double speed = 1e-4 * c.depth / c.dt;
      const auto put = [&] {
        for (std::size_t k = 0; k < 3; ++k) {
          Seen moved = s;
          moved.velocity = (k == 0 ? 0.0 : k == 1 ? speed : -speed) * along;
          bench.put(k, moved);
          for (std::size_t w = 0; w < bench.state_words(); ++w) bench.set_state(w, k, 0);
        }
      };
      // A step of length zero: nothing moves, so that what changes with velocity is the dashpot.
      bench.dt = 0;
      put();
      bench.run();
      const Tangent t = bench.tangent(0);
      const double ratio = shear ? t.dashpot_shear : t.dashpot_normal, k = shear ? t.shear : t.normal;
      const double reported = 2 * ratio * std::sqrt(c.mass * k);
      const double up = (bench.force(0) - bench.force(1)).dot(along) / speed,
                   down = (bench.force(2) - bench.force(0)).dot(along) / speed, measured = std::max(up, down);
      const double noise = 1e-6 * std::sqrt(c.mass * std::max(c.stiffness, t.normal));
      const Compared pair{shear ? "shear" : "normal", reported, measured <= noise ? 0 : measured, "N s/m"};
      worst.see(excess(pair, noise), [&] {
        return fmt::format("{} dashpot {:.6g} N s/m reported (share {:.4g}), {:.6g} measured; {}", pair.name, reported,
                           ratio, measured, text_of(c, part, s));
      });
    }
  });
  return worst.judged(0.01,
                      "report the dashpots in 'stiffness' as shares of critical damping, not less than they are: "
                      "they shorten the stable time step");
}

}  // namespace scree::core::vet
