#include <algorithm>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"

namespace scree::core::vet {

namespace {

/// The largest change of force in one step on a way in and out again, and where it was.
struct Jump {
  double size = 0, most = 0;              ///< N; largest force met
  double gap = 0, before = 0, after = 0;  ///< m; normal force on either side, N
};

std::vector<Jump> jumps(const std::vector<Case>& all, uint32_t steps) {
  LawBench bench(*all.front().model, Part::touch, all.size(), all.front().words);
  bench.varying = true;
  bench.dt = 1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bench.set_words(i, all[i].words);
    bench.reach[i] = all[i].reach;
  }
  std::vector<Jump> found(all.size());
  std::vector<Vec3> force(all.size());
  for (uint32_t k = 1; k <= 2 * steps; ++k) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Case& c = all[i];
      const double apart = c.reach + 0.1 * c.depth, way = apart + c.depth, one = way / steps;
      Seen s = c.seen();
      const bool in = k <= steps;
      s.gap = in ? apart - k * one : -c.depth + (k - steps) * one;
      s.velocity = (in ? -one : one) * s.normal + (0.3 * one) * Vec3{1, 0, 0};
      bench.put(i, s);
    }
    bench.run();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Vec3 now = bench.force(i);
      const double change = (now - force[i]).norm();
      if (change > found[i].size || std::isnan(change)) {
        const double apart = all[i].reach + 0.1 * all[i].depth, one = (apart + all[i].depth) / steps;
        found[i] = {change, found[i].most, k <= steps ? apart - k * one : -all[i].depth + (k - steps) * one, force[i].z,
                    now.z};
      }
      found[i].most = std::max(found[i].most, now.norm());
      force[i] = now;
    }
  }
  return found;
}

}  // namespace

Outcome continuity(const Subject& subject) {
  const std::vector<Case> all = cases(subject.component->contact_model(), 64, 91);
  const std::vector<Jump> coarse = jumps(all, 500), fine = jumps(all, 8000);
  Worst push, pull;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Jump& j = fine[i];
    // Sixteen times shorter steps make a slope change sixteen times less, and a square root four times; a jump stays.
    const bool jump = std::isnan(j.size) || (j.size > 0.5 * coarse[i].size && j.size > 1e-5 * j.most);
    const bool pushes = std::max(j.before, j.after) > 0.01 * j.size;
    (jump && !pushes ? pull : push).see(jump ? j.size / j.most : 0.0, [&] {
      return fmt::format("the force jumps from {:.6g} to {:.6g} N at gap {:.6g} m; {}", j.before, j.after, j.gap,
                         all[i].text);
    });
  }
  if (pull.figure() > 0 && push.figure() == 0)
    return {Verdict::note, pull.where() + ": a pull that comes or goes at once",
            "where that is the physics of the law, say so in its page: at a jump no time step is stable by proof",
            pull.figure(), 1e-5};
  return push.judged(1e-5,
                     "the force must begin at zero at touch and have no jump: a jump is a stiffness without bound, "
                     "for which no time step is stable");
}

Outcome reach_honest(const Subject& subject) {
  Worst worst;
  for (const Case& c : cases(subject.component->contact_model(), 64, 93)) {
    if (!(c.reach >= 0) || !std::isfinite(c.reach))
      return failed(fmt::format("'reach' is {} m; {}", c.reach, c.text),
                    "give the gap up to which the law runs, 0 or more");
    LawBench bench(*c.model, Part::touch, 3, c.words);
    bench.dt = 1;
    std::fill(bench.reach.begin(), bench.reach.end(), std::numeric_limits<double>::infinity());
    Seen s = c.seen();
    const double near = 1e-9 * (c.reach + c.depth);
    for (std::size_t k = 0; k < 3; ++k) {
      s.gap = k == 0 ? -c.depth : k == 1 ? c.reach - near : c.reach + near;
      bench.put(k, s);
    }
    bench.run();
    const double inside = bench.force(1).norm(), beyond = bench.force(2).norm();
    const double scale = std::max(bench.force(0).norm(), c.stiffness * c.depth);
    // A law that stops by itself at its reach is no matter of the reach: see the check of continuity.
    worst.see(scale > 0 ? std::min(inside, beyond) / scale : 0.0, [&] {
      return fmt::format("the law still gives {:.4g} N at its reach of {:.4g} m, where the kernel stops calling it; {}",
                         beyond, c.reach, c.text);
    });
  }
  return worst.judged(1e-6, "return the gap at which the force of the law ends");
}

Outcome bond_breaks_once(const Subject& subject) {
  const scree_contact_model& model = subject.component->contact_model();
  if (parts(model).size() == 1) throw Skipped("the law has no bond");
  Worst worst;
  std::size_t broken = 0;
  for (const Case& c : cases(model, 64, 95)) {
    constexpr std::size_t n = 8;
    LawBench bench(model, Part::bonded, n, c.words);
    bench.dt = c.slow();
    Numbers random(96);
    std::vector<Vec3> pull, spin;
    for (std::size_t i = 0; i < n; ++i) {
      pull.push_back(random.direction());
      spin.push_back(random.vector(0.1 / c.r1));
    }
    std::vector<double> gap(n, 0.0);
    std::vector<int> events(n, 0);
    // Each step goes half as far again as the one before, until nothing could hold.
    double step = 1e-4 * c.depth;
    for (int k = 0; k < 60 && step < c.r1; ++k, step *= 1.5) {
      for (std::size_t i = 0; i < n; ++i) {
        Seen s = c.seen();
        s.velocity = (step / bench.dt) * pull[i];
        s.velocity.z = std::abs(s.velocity.z);
        s.spin = (step / bench.dt) * spin[i];
        gap[i] += s.velocity.z * bench.dt;
        s.gap = gap[i];
        bench.put(i, s);
      }
      bench.run();
      for (std::size_t i = 0; i < n; ++i) {
        const double event = bench.event(i);
        if (event != 0) ++events[i];
        const bool known = event == 0 || event == 1 || event == 2;
        const bool holds = events[i] > 0 && gap[i] > c.reach && bench.force(i).norm() + bench.moment(i).norm() > 0;
        worst.see(!known || events[i] > 1 || holds ? 1 : 0, [&] {
          return fmt::format("event {:g}, {} so far, force ({:.4g}, {:.4g}, {:.4g}) N at a gap of {:.4g} m; {}", event,
                             events[i], bench.force(i).x, bench.force(i).y, bench.force(i).z, gap[i], c.text);
        });
      }
    }
    broken += static_cast<std::size_t>(std::count_if(events.begin(), events.end(), [](int e) { return e > 0; }));
  }
  if (broken == 0) throw Skipped("no bond broke with the strengths that were tried");
  Outcome outcome = worst.judged(0,
                                 "'broken' is 0, 1 (tension) or 2 (shear), stays what it is, and a broken bond of a "
                                 "pair that is apart gives no force");
  if (outcome.verdict == Verdict::pass) outcome.found = fmt::format("{} bonds broke", broken);
  return outcome;
}

}  // namespace scree::core::vet
