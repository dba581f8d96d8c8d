// g++ and clang++ turn a law into code that gives the same bits, on every instruction set, bonded or not.
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "laws/columns.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

namespace {
using namespace scree::test;
using scree::Vec3;
using scree::core::Catalogue;
using scree::core::Isa;
using scree::core::Kind;
using scree::core::SearchPath;

std::vector<std::string> compilers() {
  std::vector<std::string> found;
  for (const char* compiler : {"gxx", "clangxx"})
    if (std::filesystem::exists(std::filesystem::path(support::binary_dir()) / "tests" / compiler / "contact_model"))
      found.push_back(compiler);
  return found;
}
Catalogue& built_by(const std::string& compiler) {
  static std::map<std::string, std::unique_ptr<Catalogue>> open;
  auto& catalogue = open[compiler];
  if (!catalogue)
    catalogue = std::make_unique<Catalogue>(
        SearchPath{{}, {std::filesystem::path(support::binary_dir()) / "tests" / compiler}});
  return *catalogue;
}
const scree_contact_model& model_of(const std::string& compiler, const std::string& name) {
  return built_by(compiler).open(Kind::contact_model, name).contact_model();
}

struct Outcome {
  uint64_t hash = 0;
  uint32_t breaks = 0;
};
/// Cycles of random motion; overlaps large enough to slide and strains large enough to break some bonds.
Outcome run(const scree_contact_model& model, const Settings& settings, bool bonded, bool varying, Isa isa,
            std::size_t size) {
  std::vector<double> rule = rule_of(model, settings);
  const scree_pair pair{sizeof(scree_pair), 0, 0.01, 0.015, 0.01};
  if (model.prepare) REQUIRE(model.prepare(rule.data(), 0, nullptr) == 0);
  if (model.derive) model.derive(rule.data(), 0, &pair);
  Columns columns(model, rule, 301);
  columns.bonded = bonded;
  columns.varying = varying;
  Outcome out;
  for (uint64_t cycle = 0; cycle < 20; ++cycle) {
    Numbers random(cycle);
    for (std::size_t i = 0; i < columns.size(); ++i) columns.put(i, random_contact(random, 2e-5, 50));
    out.breaks += columns.run(isa, size);
    out.hash = out.hash * 31 + columns.hash();
  }
  return out;
}

struct Law {
  std::string name;
  Settings settings;
  bool bonded;
};
const std::vector<Law> laws = {
    {"linear",
     {{"kn", 1e6}, {"ks", 4e5}, {"fric", 0.4}, {"dp_nratio", 0.1}, {"dp_sratio", 0.1}, {"dp_mode", 3}},
     false},
    {"hertz_mindlin", {{"shear", 1e9}, {"poiss", 0.25}, {"fric", 0.4}, {"dp_nratio", 0.1}}, false},
    {"capillary", {{"kn", 1e6}, {"pull", 2.0}, {"range", 1e-5}}, false},
    {"parallel_bond",
     {{"kn", 1e6}, {"ks", 4e5}, {"fric", 0.4}, {"pb_kn", 1e11}, {"pb_ks", 4e10}, {"pb_ten", 6e6}, {"pb_coh", 2e6}},
     true},
};

}  // namespace

TEST_CASE("both compilers, every instruction set and every way of calling give the same bits") {
  const std::vector<std::string> built = compilers();
  if (built.size() < 2) WARN("skipped: only one compiler is installed");
  for (const Law& law : laws) {
    const Outcome expected =
        run(model_of(built.front(), law.name), law.settings, law.bonded, false, Isa::baseline, 128);
    if (law.bonded) CHECK((expected.breaks > 10 && expected.breaks < 301));
    for (const std::string& compiler : built)
      for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4}) {
        if (isa > scree::core::detect_isa()) continue;
        for (const bool varying : {false, true})
          for (const std::size_t size : {1, 7, 128}) {
            INFO(law.name << " " << compiler << " " << scree::core::isa_name(isa) << " varying " << varying << " size "
                          << size);
            const Outcome got = run(model_of(compiler, law.name), law.settings, law.bonded, varying, isa, size);
            CHECK(got.hash == expected.hash);
            CHECK(got.breaks == expected.breaks);
          }
      }
  }
}

TEST_CASE("the flags of a model follow from the types that its law takes") {
  const std::string compiler = compilers().front();
  CHECK(model_of(compiler, "capillary").flags == 0);
  CHECK(model_of(compiler, "capillary").state_words == 0);
  CHECK(model_of(compiler, "hertz_mindlin").flags == (SCREE_NEEDS_TURN | SCREE_NONLINEAR));
  const scree_contact_model& bond = model_of(compiler, "parallel_bond");
  CHECK(bond.flags == (SCREE_NEEDS_SPIN | SCREE_NEEDS_TURN | SCREE_GIVES_MOMENT | SCREE_CAN_BOND));
  CHECK(bond.state_words == 3);
  CHECK(bond.bond_words == 9);
  REQUIRE(bond.state_count == 3);
  CHECK(bond.states[1].word == 6);  // after the words of State, and mode, pull and twist
  CHECK(bond.states[2].word == 3);
}

TEST_CASE("a bond carries pull and moment until its strength is reached, and breaks once") {
  // A = pi Rb^2, I = A Rb^2/4; a pull of d gives the stress pb_kn d, so it breaks at d = pb_ten / pb_kn.
  const scree_contact_model& model = model_of(compilers().front(), "parallel_bond");
  std::vector<double> rule =
      rule_of(model, {{"kn", 0}, {"ks", 0}, {"pb_kn", 1e11}, {"pb_ks", 4e10}, {"pb_ten", 1e6}, {"pb_coh", 1e9}});
  const scree_pair pair{sizeof(scree_pair), 0, 0.01, 0.01, 0.01};
  model.derive(rule.data(), 0, &pair);
  Columns columns(model, rule, 1);
  columns.bonded = true;
  OneContact c;
  c.gap = 1e-5;
  c.velocity = {0, 0, 0.09};  // 0.9e-6 m a cycle, strength at 1e-5 m
  const double area = std::acos(-1.0) * 1e-4;
  for (int cycle = 1; cycle <= 13; ++cycle) {
    columns.put(0, c);
    const uint32_t breaks = columns.run();
    const double stress = 1e11 * 0.9e-6 * cycle;
    CHECK(breaks == (cycle == 12 ? 1u : 0u));
    CHECK(columns.event(0) == (cycle == 12 ? 1.0 : 0.0));
    CHECK(columns.force(0).z == Approx(stress < 1e6 ? -stress * area : 0.0).epsilon(1e-12));
  }
  Columns bent(model, rule, 1);
  bent.bonded = true;
  c.velocity = {};
  c.spin = {1, 0, 2};
  bent.put(0, c);
  bent.run();
  const double inertia = 0.25 * area * 1e-4;
  CHECK(bent.moment(0).x == Approx(-1e11 * inertia * 1e-5).epsilon(1e-12));
  CHECK(bent.moment(0).z == Approx(-4e10 * 2 * inertia * 2e-5).epsilon(1e-12));
  double kn = 0, bending = 0;
  bent.stiffness({sizeof(scree_stiffness), 1, &kn, nullptr, &bending, nullptr, nullptr, nullptr});
  CHECK(kn == Approx(1e11 * area).epsilon(1e-14));
  CHECK(bending == Approx(1e11 * inertia).epsilon(1e-14));
}

TEST_CASE("a refusal of prepare reaches the host as text") {
  const scree_contact_model& model = model_of(compilers().front(), "hertz_mindlin");
  std::vector<double> rule = rule_of(model, {{"shear", 1e9}, {"poiss", 0.5}});
  char why[24];
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  CHECK(model.prepare(rule.data(), 0, &refusal) != 0);
  CHECK(std::string(why) == "an incompressible ball ");
}

TEST_CASE("Hertz and Mindlin: static numbers of one pair") {
  // r = 1 mm, G = 30 GPa, nu = 0.25, 1 N: overlap 8.892233e-7 m, kn 1.686865e6 and ks 1.445885e6 N/m.
  const scree_contact_model& model = model_of(compilers().front(), "hertz_mindlin");
  std::vector<double> rule = rule_of(model, {{"shear", 30e9}, {"poiss", 0.25}, {"fric", 0.5}});
  REQUIRE(model.prepare(rule.data(), 0, nullptr) == 0);
  const scree_pair pair{sizeof(scree_pair), 0, 1e-3, 1e-3, 0.01};
  model.derive(rule.data(), 0, &pair);
  Columns columns(model, rule, 1);
  OneContact c;
  c.gap = -8.892233e-7;
  columns.put(0, c);
  columns.run();
  CHECK(columns.force(0).z == Approx(1.0).epsilon(1e-6));
  double kn = 0, ks = 0;
  columns.stiffness({sizeof(scree_stiffness), 1, &kn, &ks, nullptr, nullptr, nullptr, nullptr});
  CHECK(kn == Approx(1.686865e6).epsilon(1e-6));
  CHECK(ks == Approx(1.445885e6).epsilon(1e-6));
}
