// A law gives the same bits on every instruction set, with uniform and varying properties, with and without energies,
// and for any size of batch.

#include "laws/columns.hpp"
#include "support/catch.hpp"

namespace {
using namespace scree::test;
using scree::Vec3;
using scree::core::Isa;

const scree_contact_model& linear() {
  return built_plugins().open(scree::core::Kind::contact_model, "linear").contact_model();
}

/// Random contacts, seen again for `cycles` cycles with new motion: some slide, some stick, some are open.
void fill(Columns& columns, uint64_t seed) {
  Numbers random(seed);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    OneContact c = random_contact(random, 1e-5, 10);
    c.r1 = random.between(0.005, 0.02);
    c.r2 = random.between(0.005, 0.02);
    c.mass = random.between(1e-3, 1e-1);
    columns.put(i, c);
  }
}

struct Outcome {
  uint64_t hash = 0;
  std::size_t sliding = 0, sticking = 0;
};
Outcome run(Columns& columns, Isa isa, std::size_t size) {
  Outcome out;
  for (uint64_t cycle = 0; cycle < 20; ++cycle) {
    fill(columns, cycle);
    columns.run(isa, size);
    out.hash = out.hash * 31 + columns.hash();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const bool loaded = columns.force(i).squaredNorm() > 0;
      out.sliding += columns.sliding(i);
      out.sticking += loaded && !columns.sliding(i);
    }
  }
  return out;
}

Settings with_modes(double dp_mode, double lin_mode) {
  return {{"kn", 1e6},        {"ks", 4e5},          {"fric", 0.4},          {"dp_nratio", 0.2},
          {"dp_sratio", 0.1}, {"dp_mode", dp_mode}, {"lin_mode", lin_mode}, {"rgap", 2e-6}};
}

}  // namespace

TEST_CASE("linear gives the same bits on every instruction set and for every way of calling it") {
  for (const double lin_mode : {0.0, 1.0})
    for (const double dp_mode : {0.0, 1.0, 2.0, 3.0}) {
      const std::vector<double> rule = rule_of(linear(), with_modes(dp_mode, lin_mode));
      Columns reference(linear(), rule, 1001);
      const Outcome expected = run(reference, Isa::baseline, SCREE_BATCH);
      REQUIRE(expected.sliding > 1000);
      REQUIRE(expected.sticking > 1000);
      for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4}) {
        if (isa > scree::core::detect_isa()) {
          WARN("skipped: this CPU lacks " << scree::core::isa_name(isa));
          continue;
        }
        for (const bool varying : {false, true})
          for (const bool energy : {false, true})
            for (const std::size_t size : {1, 7, 8, 128}) {
              INFO(scree::core::isa_name(isa) << " varying " << varying << " energy " << energy << " size " << size
                                              << " dp_mode " << dp_mode << " lin_mode " << lin_mode);
              Columns columns(linear(), rule, 1001);
              columns.varying = varying;
              columns.energy = energy;
              CHECK(run(columns, isa, size).hash == expected.hash);
            }
      }
    }
}

TEST_CASE("linear carries code of its own for every instruction set") {
  for (int k = 0; k < 3; ++k) {
    CHECK(linear().uniform[k] != nullptr);
    for (int other = 0; other < k; ++other) CHECK(linear().uniform[k] != linear().uniform[other]);
  }
}

TEST_CASE("the law without shear gives the bits of the full law where nothing is tangential") {
  const std::vector<double> rule =
      rule_of(linear(), {{"kn", 1e6}, {"ks", 4e5}, {"fric", 0}, {"dp_nratio", 0.2}, {"dp_mode", 1}});
  REQUIRE(linear().needs(rule.data()) == SCREE_NORMAL_ONLY);
  for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4}) {
    if (isa > scree::core::detect_isa()) continue;
    for (const bool varying : {false, true}) {
      Columns full(linear(), rule, 1001), reduced(linear(), rule, 1001);
      reduced.normal_only = true;
      reduced.varying = varying;
      fill(full, 7);
      fill(reduced, 7);
      full.run(isa);
      reduced.run(isa);
      std::size_t loaded = 0;
      for (std::size_t i = 0; i < full.size(); ++i) {
        // Compared as numbers: a zero shear force turns -0 into 0.
        CHECK(full.force(i).x == reduced.force(i).x);
        CHECK(full.force(i).y == reduced.force(i).y);
        CHECK(full.force(i).z == reduced.force(i).z);
        loaded += full.force(i).squaredNorm() > 0;
      }
      CHECK(loaded > 500);
    }
  }
}

TEST_CASE("a rule needs shear, spin or turn only if something tangential can act") {
  const uint32_t full = linear().flags;
  CHECK(full == SCREE_NEEDS_TURN);
  const auto needs = [&](const Settings& settings) { return linear().needs(rule_of(linear(), settings).data()); };
  CHECK(needs({{"kn", 1}, {"ks", 1}}) == SCREE_NORMAL_ONLY);
  CHECK(needs({{"kn", 1}, {"ks", 0}, {"fric", 0.5}}) == SCREE_NORMAL_ONLY);
  CHECK(needs({{"kn", 1}, {"ks", 1}, {"fric", 0.5}}) == full);
  CHECK(needs({{"kn", 1}, {"ks", 1}, {"dp_sratio", 0.5}}) == full);
  CHECK(needs({{"kn", 1}, {"ks", 1}, {"lin_mode", 1}}) == full);
  // Given by modulus, ks is still zero when the kernel asks.
  CHECK(needs({{"emod", 1e9}, {"kratio", 2.5}, {"fric", 0.5}}) == full);
  CHECK(needs({{"emod", 1e9}, {"kratio", 2.5}}) == SCREE_NORMAL_ONLY);
}
