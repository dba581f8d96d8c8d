#include <algorithm>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"

namespace scree::core::vet {

namespace {

constexpr std::size_t contacts = 131;  // a whole batch and a rest
constexpr uint32_t steps = 4;

/// One way of calling a law.
struct Way {
  Isa isa = Isa::baseline;
  std::size_t batch = SCREE_BATCH;
  bool varying = false, energy = false, backwards = false;
  std::string text() const {
    return fmt::format("{}, batches of {}, {} properties{}{}", isa_name(isa), batch, varying ? "varying" : "uniform",
                       energy ? ", with energies" : "", backwards ? ", in the opposite order" : "");
  }
};

/// Everything that the law wrote on the way, contact by contact (FNV-1a).
std::vector<uint64_t> traced(Party& party, const Way& way) {
  party.restart(steps);
  const auto bench = party.bench();
  bench->dt = party.model_case.dt;
  bench->isa = way.isa;
  bench->batch = way.batch;
  bench->varying = way.varying;
  bench->energy = way.energy;
  std::vector<uint64_t> hash(contacts, 0xcbf29ce484222325u);
  while (!party.done()) {
    party.step(party.model_case.dt);
    const auto slot = [&](std::size_t i) { return way.backwards ? contacts - 1 - i : i; };
    for (std::size_t i = 0; i < contacts; ++i) bench->put(slot(i), party.seen[i]);
    bench->run();
    const std::vector<uint64_t> bits = bench->bits();
    const std::size_t words = bits.size() / contacts;
    for (std::size_t i = 0; i < contacts; ++i)
      for (std::size_t w = 0; w < words; ++w) hash[i] = (hash[i] ^ bits[slot(i) * words + w]) * 0x100000001b3u;
  }
  return hash;
}

std::vector<Isa> usable_sets() {
  std::vector<Isa> list;
  for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4})
    if (isa <= detect_isa()) list.push_back(isa);
  return list;
}

/// Compares every way of `ways` with the first; the figure is the number of contacts that differ.
Outcome same_bits(const Subject& subject, const std::vector<Part>& wanted, const std::vector<Way>& ways,
                  const std::string& next) {
  Worst worst;
  for_cases(subject, 8, 41, [&](const Case& c, Part part) {
    if (std::find(wanted.begin(), wanted.end(), part) == wanted.end()) return;
    Party party(c, part, contacts, 42, true);
    const std::vector<uint64_t> first = traced(party, ways.front());
    for (std::size_t k = 1; k < ways.size(); ++k) {
      const std::vector<uint64_t> other = traced(party, ways[k]);
      std::size_t differ = 0, where = 0;
      for (std::size_t i = contacts; i-- > 0;)
        if (first[i] != other[i]) ++differ, where = i;
      worst.see(static_cast<double>(differ), [&] {
        return fmt::format("contact {} (and {} more) has other bits with {} than with {}; {}, {}", where, differ - 1,
                           ways[k].text(), ways.front().text(), part_name(part), c.text);
      });
    }
  });
  return worst.judged(0, next);
}

/// The same on each instruction set by itself: that they agree with each other is another check.
Outcome on_every_set(const Subject& subject, const std::vector<Part>& wanted, std::vector<Way> ways,
                     const std::string& next) {
  Outcome outcome;
  for (const Isa isa : usable_sets()) {
    for (Way& way : ways) way.isa = isa;
    outcome = same_bits(subject, wanted, ways, next);
    if (outcome.verdict != Verdict::pass) break;
  }
  return outcome;
}

const std::vector<Part> any_part = {Part::touch, Part::bonded};
const char* const keep_bits =
    "no function of the C library but sqrt, no fast-math, no contraction; build with scree_add_plugin()";

}  // namespace

Outcome batch_sizes(const Subject& subject) {
  return on_every_set(
      subject, {Part::touch},
      {{Isa::baseline, 128},
       {Isa::baseline, 8},
       {Isa::baseline, 7},
       {Isa::baseline, 1},
       {Isa::baseline, 128, false, false, true}},
      "a contact's answer must not depend on its place in the batch or on its neighbours: keep nothing between "
      "contacts");
}

Outcome instruction_sets(const Subject& subject) {
  const std::vector<Isa> sets = usable_sets();
  if (sets.size() == 1) throw Skipped("this CPU has the baseline instruction set only");
  std::vector<Way> ways;
  for (const Isa isa : sets) ways.push_back({isa, SCREE_BATCH, false, false});
  Outcome outcome = same_bits(subject, any_part, ways, keep_bits);
  if (outcome.verdict == Verdict::pass && sets.size() == 2) outcome.found = "this CPU lacks v4, which was not checked";
  return outcome;
}

Outcome varying_properties(const Subject& subject) {
  return on_every_set(subject, {Part::touch}, {{}, {Isa::baseline, SCREE_BATCH, true, false}},
                      "a property must act the same whether it is one value for the rule or one for each contact: read "
                      "it from the struct only");
}

Outcome energy_variant(const Subject& subject) {
  if (subject.component->contact_model().uniform_energy[0] == nullptr) throw Skipped("the law keeps no energies");
  return on_every_set(subject, {Part::touch},
                      {{}, {Isa::baseline, SCREE_BATCH, false, true}, {Isa::baseline, SCREE_BATCH, true, true}},
                      "keeping an account of energy must not change the motion: 'energy' may only read");
}

Outcome bonded_variants(const Subject& subject) {
  if (parts(subject.component->contact_model()).size() == 1) throw Skipped("the law has no bond");
  std::vector<Way> ways;
  for (const bool varying : {false, true})
    for (const std::size_t size : {128u, 7u, 1u})
      for (const bool energy : {false, true}) ways.push_back({Isa::baseline, size, varying, energy});
  return on_every_set(subject, {Part::bonded}, ways,
                      "a bonded contact's answer must not depend on how the law is called");
}

Outcome normal_only_variant(const Subject& subject) {
  const scree_contact_model& model = subject.component->contact_model();
  if (model.needs == nullptr) throw Skipped("the law has no variant without tangential part");
  Worst worst;
  for (const Case& c : cases(model, 256, 51)) {
    if ((model.needs(c.words.data()) & SCREE_NORMAL_ONLY) == 0) continue;
    Party party(c, Part::touch, 16, 52, true), same(c, Part::normal_only, 16, 52, true);
    party.restart(10);
    same.restart(10);
    const auto full = party.bench();
    LawBench reduced(model, Part::normal_only, 16, c.words);
    reduced.reach = full->reach;
    full->dt = reduced.dt = c.dt;
    while (!party.done()) {
      party.step(c.dt);
      party.put(*full);
      party.put(reduced);
      for (const Isa isa : usable_sets()) {
        reduced.isa = isa;
        reduced.run();
      }
      full->run();
      for (std::size_t i = 0; i < 16; ++i) {
        // As numbers: a shear force of zero turns -0 into 0.
        const Vec3 a = full->force(i), b = reduced.force(i), m = full->moment(i);
        const bool same_force = a.x == b.x && a.y == b.y && a.z == b.z && m.squaredNorm() == 0;
        worst.see(same_force ? 0 : 1, [&] {
          return fmt::format(
              "force ({:.17g}, {:.17g}, {:.17g}) N, without tangential part ({:.17g}, {:.17g}, {:.17g}) N; {}", a.x,
              a.y, a.z, b.x, b.y, b.z, text_of(c, Part::touch, party.seen[i]));
        });
      }
    }
  }
  return worst.judged(0,
                      "where 'normal_only' says yes, 'law_normal' must give the force of 'law', and 'law' nothing "
                      "tangential");
}

}  // namespace scree::core::vet
