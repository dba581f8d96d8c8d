#include <algorithm>
#include <cstring>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"
#include "core/vet/purity.hpp"

// A law must be a pure function of what it is handed: it runs on any thread, is called again for output, and may be
// evaluated on two machines.

namespace scree::core::vet {

namespace {

constexpr std::size_t contacts = 32;
constexpr uint32_t steps = 6;

const void* code_of(const scree_contact_model& model) { return reinterpret_cast<const void*>(model.uniform[0]); }

std::vector<Isa> usable_sets() {
  std::vector<Isa> list;
  for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4})
    if (isa <= detect_isa()) list.push_back(isa);
  return list;
}

/// Drives contacts through their journeys on every instruction set and hands over each bench before the law runs.
template <class Visit>
void each_batch(const Subject& subject, uint64_t seed, Visit visit) {
  for_cases(subject, 8, seed, [&](const Case& c, Part part) {
    Party party(c, part, contacts, seed + 1, true);
    for (const Isa isa : usable_sets())
      for (const bool varying : {false, true}) {
        party.restart(steps);
        const auto bench = party.bench();
        bench->dt = c.dt;
        bench->isa = isa;
        bench->varying = varying;
        while (!party.done()) {
          party.step(c.dt);
          party.put(*bench);
          visit(c, part, *bench);
        }
      }
  });
}

/// Law and stiffness of a bench, ready to be called without anything of ours in between.
class Call {
 public:
  Call(const scree_contact_model& model, LawBench& bench)
      : model_(model), rule_(bench.rule()), law_(bench.law()), batch_(bench.prepared(0, bench.size())) {}
  void operator()() {
    law_(rule_, &batch_);
    const scree_stiffness out{sizeof(scree_stiffness), batch_.n, k_[0], k_[1], k_[2], k_[3], k_[4], k_[5]};
    model_.stiffness(rule_, &batch_, &out);
  }

 private:
  const scree_contact_model& model_;
  const void* rule_;
  scree_law law_;
  scree_batch batch_;
  double k_[6][contacts] = {};
};

template <class Run>
void each_call(const Subject& subject, uint64_t seed, const Run& run) {
  each_batch(subject, seed, [&](const Case& c, Part part, LawBench& bench) {
    Call call(*c.model, bench);
    run(call, [&] { return std::string(part_name(part)) + ", " + c.text; });
  });
}

}  // namespace

Outcome state_round_trip(const Subject& subject) {
  if (subject.component->contact_model().state_words + subject.component->contact_model().bond_words == 0)
    throw Skipped("the law remembers nothing");
  Worst worst;
  for_cases(subject, 12, 101, [&](const Case& c, Part part) {
    Party party(c, part, contacts, 102, true);
    party.restart(steps);
    const auto bench = party.bench();
    bench->dt = c.dt;
    for (uint32_t k = 0; !party.done(); ++k) {
      party.step(c.dt);
      // The same words in other memory and in another order, as after a checkpoint or a rebuild of the list.
      const auto other = party.bench();
      other->dt = c.dt;
      for (std::size_t i = 0; i < contacts; ++i) {
        other->copy_state(contacts - 1 - i, *bench, i);
        other->put(contacts - 1 - i, party.seen[i]);
      }
      party.put(*bench);
      bench->run();
      other->run();
      for (std::size_t i = 0; i < contacts; ++i) {
        const std::size_t j = contacts - 1 - i;
        const Vec3 a = bench->force(i), b = other->force(j), m = bench->moment(i), n = other->moment(j);
        bool same = std::memcmp(&a, &b, sizeof a) == 0 && std::memcmp(&m, &n, sizeof m) == 0;
        for (std::size_t w = 0; w < bench->state_words(); ++w) {
          const double x = bench->state(w, i), y = other->state(w, j);
          same = same && std::memcmp(&x, &y, sizeof x) == 0;
        }
        worst.see(same ? 0 : 1, [&] {
          return fmt::format(
              "step {}: force ({:.17g}, {:.17g}, {:.17g}) N, from the copied state ({:.17g}, {:.17g}, {:.17g}) "
              "N; {}",
              k, a.x, a.y, a.z, b.x, b.y, b.z, text_of(c, part, party.seen[i]));
        });
      }
    }
  });
  return worst.judged(0, "everything a contact remembers must be in State and Bond: a checkpoint saves nothing else");
}

Outcome repeatable(const Subject& subject) {
  Worst worst;
  const scree_contact_model& model = subject.component->contact_model();
  const std::vector<Case> others = cases(model, 8, 104);
  std::size_t turn = 0;
  for_cases(subject, 12, 105, [&](const Case& c, Part part) {
    Party party(c, part, contacts, 106, true);
    party.restart(steps);
    const auto bench = party.bench(), again = party.bench();
    bench->dt = again->dt = c.dt;
    while (!party.done()) {
      party.step(c.dt);
      party.put(*bench);
      for (std::size_t i = 0; i < contacts; ++i) again->copy_state(i, *bench, i);
      party.put(*again);
      bench->run();
      // Something else in between, with another rule.
      const Case& other = others[turn++ % others.size()];
      LawBench between(model, part, 3, other.words);
      Seen s = other.seen();
      s.gap = -other.depth;
      between.put(1, s);
      between.run();
      again->run();
      worst.see(bench->bits() == again->bits() ? 0 : 1, [&] {
        return "a second call with the same inputs gives other bits; " + std::string(part_name(part)) + ", " + c.text;
      });
    }
  });
  return worst.judged(
      0, "a law may depend on nothing but its arguments: no static variable, clock, file or random number");
}

Outcome law_allocates(const Subject& subject) {
  return nothing_allocated(code_of(subject.component->contact_model()),
                           [&](const auto& run) { each_call(subject, 111, run); });
}

Outcome law_global_state(const Subject& subject) {
  return nothing_kept(code_of(subject.component->contact_model()),
                      [&](const auto& run) { each_call(subject, 113, run); });
}

Outcome law_float_mode(const Subject& subject) {
  return mode_kept([&](const auto& run) { each_call(subject, 115, run); });
}

Outcome law_trespass(const Subject& subject) {
  Worst worst;
  each_batch(subject, 117, [&](const Case& c, Part part, LawBench& bench) {
    bench.run();
    const std::string trespass = bench.trespass();
    worst.see(trespass.empty() ? 0 : 1, [&] { return trespass + "; " + std::string(part_name(part)) + ", " + c.text; });
  });
  return worst.judged(0, "write n values of the arrays that are marked 'out' in abi.h, and nothing else");
}

}  // namespace scree::core::vet
