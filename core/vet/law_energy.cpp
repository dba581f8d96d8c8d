#include <algorithm>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"

namespace scree::core::vet {

namespace {

constexpr std::size_t contacts = 8;
constexpr double missing_energy = 0.01;
constexpr double free_energy =
    1e-3;  // share of the energy moved; what is measured converges with the square of the step

/// Work and energies of one contact from birth to death.
struct Account {
  double work = 0;    ///< J, done by the motion of the pieces on the contact
  double moved = 0;   ///< J, sum of its sizes
  double start = 0;   ///< J, reported as stored at birth
  double strain = 0;  ///< J, reported as stored now
  double lost = 0;    ///< J, sum of the losses reported, what was stored at a separation included
  double given = 0;   ///< J, sum of the losses that are below zero
  /// J, work that is not accounted for, at the end of each leg of the path.
  std::array<double, Journey::legs> residual{};
};

/// A bond may be made in a contact that is loaded: what it stores before anything moves was not put in on the way.
void begin_loaded(Party& party, LawBench& bench, std::vector<Account>& all, std::vector<Vec3>& force) {
  const bool energies = bench.energy;
  const double dt = bench.dt;
  bench.energy = true;
  bench.dt = 0;
  party.rest();
  party.put(bench);
  bench.run();
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].start = all[i].strain = bench.energies(0, i);
    force[i] = bench.force(i);
  }
  bench.energy = energies;
  bench.dt = dt;
}

/// Force and moment at the middle of a step times displacement: exact to second order.
std::vector<Account> accounts(Party& party, uint32_t steps, double total_time, bool energies) {
  party.restart(steps);
  const auto bench = party.bench();
  bench->dt = total_time / steps;
  bench->energy = energies;
  std::vector<Account> all(party.seen.size());
  std::vector<Vec3> force(all.size()), moment(all.size());
  if (party.part == Part::bonded) begin_loaded(party, *bench, all, force);
  for (uint32_t step = 0; !party.done(); ++step) {
    party.step(bench->dt);
    party.put(*bench);
    bench->run();
    for (std::size_t i = 0; i < all.size(); ++i) {
      Account& a = all[i];
      const Vec3 f = bench->force(i), m = bench->moment(i);
      const Seen& s = party.seen[i];
      const double work = -0.5 * bench->dt * ((f + force[i]).dot(s.velocity) + (m + moment[i]).dot(s.spin));
      a.work += work;
      a.moved += std::abs(work);
      force[i] = f;
      moment[i] = m;
      if (!energies) continue;
      const bool dropped = party.part != Part::bonded && s.gap >= party.model_case.reach;
      if (dropped) a.lost += a.strain;
      a.strain = bench->energies(0, i);
      for (const std::size_t term : {1u, 2u, 3u}) {
        a.lost += bench->energies(term, i);
        a.given -= std::min(0.0, bench->energies(term, i));
      }
      a.residual[step / steps] = a.start + a.work - a.strain - a.lost;
    }
  }
  return all;
}

/// Worst cases, apart by whether every mode of the law is at its default. A mode that one has to ask for may be known
/// to make energy, as published laws do: that is a note.
struct ByMode {
  Worst usual, asked_for;
  Worst& of(const Case& c) { return c.usual ? usual : asked_for; }
  bool fails(double tolerance) const { return std::max(usual.figure(), asked_for.figure()) > tolerance; }
  Outcome judged(double tolerance, const std::string& next) const {
    if (usual.where().empty()) return asked_for.judged(tolerance, next);
    if (usual.figure() > tolerance || !(asked_for.figure() > tolerance)) return usual.judged(tolerance, next);
    return {Verdict::note, asked_for.where() + ": only where a mode is not at its default",
            "say in the page of the law which mode does so", asked_for.figure(), tolerance};
  }
};

Outcome gives_nothing(const Subject& subject, Part wanted) {
  ByMode worst;
  uint64_t seed = 8200;
  for_cases(subject, 40, 81, [&](const Case& c, Part part) {
    if (part != wanted) return;
    Party party(c, part, contacts, ++seed, false);
    const double time = 100 * c.slow();
    const std::vector<Account> coarse = accounts(party, 60, time, false), fine = accounts(party, 120, time, false);
    std::vector<Account> finest;
    for (std::size_t i = 0; i < contacts; ++i) {
      if (!(fine[i].moved > 0)) continue;
      // What is left of a gain when steps get shorter: an error of integration goes away, a law that gives does not.
      const double limit = 2 * fine[i].work - coarse[i].work, start = fine[i].start;
      double gain = std::max(0.0, -start - std::max(limit, fine[i].work)) / fine[i].moved;
      if (gain > free_energy) {
        // Crossing a jump of the force errs by a share of a step, at random; that goes away more slowly.
        if (finest.empty()) finest = accounts(party, 1920, time, false);
        gain = std::min(gain, std::max(0.0, -start - finest[i].work) / finest[i].moved);
      }
      worst.of(c).see(std::isnan(fine[i].work) ? NAN : gain, [&] {
        return fmt::format("{:.4g} J given back beyond what was put in, of {:.4g} J moved on path {}; {}, {}",
                           -start - fine[i].work, fine[i].moved, i, part_name(part), c.text);
      });
    }
  });
  return worst.judged(free_energy,
                      "a contact may store and lose energy, never make it: look at how remembered forces change "
                      "when the stiffness does (an unloading contact must scale its shear force down)");
}

Outcome balanced(const Subject& subject, Part wanted) {
  ByMode worst, given;
  uint64_t seed = 8400;
  for_cases(subject, 40, 83, [&](const Case& c, Part part) {
    if (part != wanted) return;
    Party party(c, part, contacts, ++seed, true);
    const double time = 400 * c.dt;
    const std::vector<Account> coarse = accounts(party, 80, time, true), fine = accounts(party, 160, time, true);
    std::vector<Account> finest;
    for (std::size_t i = 0; i < contacts; ++i) {
      const Account &a = coarse[i], &b = fine[i];
      const double scale = std::max(b.moved, std::abs(b.lost));
      if (!(scale > 0)) continue;
      given.of(c).see(b.given / scale, [&] {
        return fmt::format("losses of {:.3g} J below zero on path {}; {}, {}", -b.given, i, part_name(part), c.text);
      });
      for (std::size_t leg = 0; leg < Journey::legs; ++leg) {
        const double missing = b.residual[leg], limit = 2 * missing - a.residual[leg];
        // What is left when steps get shorter.
        double left = std::min(std::abs(limit), std::abs(missing)) / scale;
        if (left > missing_energy) {
          // A bond that breaks a step earlier or later errs by a share of a step, at random; that goes away more
          // slowly.
          if (finest.empty()) finest = accounts(party, 1280, time, true);
          left = std::min(left, std::abs(finest[i].residual[leg]) / scale);
        }
        worst.of(c).see(std::isnan(limit) ? limit : left, [&] {
          return fmt::format("{:.4g} J are missing after leg {} of path {}, of {:.4g} J moved; {}, {}", missing,
                             leg + 1, i, b.moved, part_name(part), c.text);
        });
      }
    }
  });
  // The trapezoid of a step in which a spring unloads and slides may come out below zero, by the square of the step.
  if (given.fails(1e-4))
    return given.judged(1e-4, "friction, dashpot and break are what was lost in this step, never below zero");
  return worst.judged(missing_energy,
                      "'energy' must account for all work: strain stored now; friction, dashpot and break lost in "
                      "this step");
}

}  // namespace

Outcome nothing_back(const Subject& subject) { return gives_nothing(subject, Part::touch); }

Outcome nothing_back_bonded(const Subject& subject) {
  if (parts(subject.component->contact_model()).size() == 1) throw Skipped("the law has no bond");
  return gives_nothing(subject, Part::bonded);
}

Outcome energy_balance(const Subject& subject) {
  if (subject.component->contact_model().uniform_energy[0] == nullptr) throw Skipped("the law keeps no energies");
  return balanced(subject, Part::touch);
}

Outcome energy_balance_bonded(const Subject& subject) {
  const scree_contact_model& model = subject.component->contact_model();
  if (parts(model).size() == 1) throw Skipped("the law has no bond");
  // The table does not say whether the bonded law keeps energies: one that does writes them.
  const Case c = cases(model, 1).front();
  LawBench bench(model, Part::bonded, 1, c.words);
  bench.dt = c.dt;
  bench.energy = true;
  Seen s = c.seen();
  s.gap = -c.depth;
  s.velocity = (-c.depth / c.dt) * s.normal;
  bench.put(0, s);
  bench.mark_energies();
  bench.run();
  if (!bench.energies_written()) throw Skipped("the bonded law keeps no energies");
  return balanced(subject, Part::bonded);
}

}  // namespace scree::core::vet
