// Cases 48, 51 and D60: the same bits on every instruction set, any number of threads and any pattern of restarts. The
// reference is the run that was left alone.
#include "core/base/isa.hpp"
#include "core/base/philox.hpp"
#include "core/run/state.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

constexpr uint64_t cycles = 1200;

uint64_t hash_after(unsigned threads, int isa) {
  lab::Lab here;
  const auto simulation = here.make(lab::flow, threads, isa);
  lab::run(*simulation, cycles);
  CHECK(simulation->engine.contacts.active() > 500);
  CHECK(simulation->engine.rebuilds() > 3);
  return simulation->engine.state_hash();
}

uint64_t reference() {
  static const uint64_t hash = hash_after(1, 0);
  return hash;
}

/// A run that is saved, thrown away and loaded again, with another number of threads each time.
class Interrupted {
 public:
  explicit Interrupted(const std::string& text) : simulation_(here_.make(text)) {}
  Simulation& operator*() { return *simulation_; }
  void restart(unsigned threads, int isa) {
    const std::string path = here_.folder() / "state.scree";
    {
      ArchiveWriter out(path);
      save_state(*simulation_, out);
      REQUIRE(out.commit());
    }
    const ArchiveReader in(path);
    simulation_ = std::make_unique<Simulation>(saved_scene(in, here_.catalogue()), here_.catalogue(), threads, isa);
    load_state(*simulation_, in);
  }

 private:
  lab::Lab here_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace

TEST_CASE("48 OK: every instruction set gives the same bits") {
  std::string seen = "baseline";
  for (const Isa isa : {Isa::v3, Isa::v4}) {
    if (isa > detect_isa()) {
      WARN("skipped: this CPU lacks " << isa_name(isa));
      seen += std::string(", ") + isa_name(isa) + " skipped (the CPU lacks it)";
      continue;
    }
    INFO(isa_name(isa));
    CHECK(hash_after(1, static_cast<int>(isa)) == reference());
    seen += std::string(", ") + isa_name(isa) + " equal";
  }
  lab::measured("48", seen);
}

TEST_CASE("48 OK: a run that changes its instruction set on the way gives the same bits") {
  Interrupted run(lab::flow);
  const int best = static_cast<int>(detect_isa());
  for (int part = 0; part < 12; ++part) {
    lab::run(*run, cycles / 12);
    run.restart(1, part % (best + 1));
  }
  lab::run(*run, 0);
  CHECK((*run).engine.state_hash() == reference());
}

TEST_CASE("D60 OK: one, two, three and four threads give the same bits") {
  for (unsigned threads = 2; threads <= 4; ++threads) {
    INFO(threads << " threads");
    CHECK(hash_after(threads, static_cast<int>(detect_isa())) == reference());
  }
  lab::measured("D60", "1, 2, 3 and 4 threads: equal bits after " + std::to_string(cycles) + " cycles, 2100 balls");
}

TEST_CASE("51 OK: a hundred restarts at random cycles, threads 1 2 3, give the same bits") {
  Interrupted run(lab::flow);
  const Random random(51, "restarts");
  const int isa = static_cast<int>(detect_isa());
  uint64_t done = 0;
  unsigned restarts = 0;
  while (done < cycles) {
    const auto some = static_cast<uint64_t>(24 * random.uniform(restarts, 0));
    const uint64_t now = std::min(cycles - done, some);
    for (uint64_t k = 0; k < now; ++k) (*run).engine.advance();
    // Sometimes the forces of the present time are saved too, as at the end of an action.
    if (restarts % 2 == 1) (*run).engine.forces();
    done += now;
    run.restart(1 + restarts % 3, isa);
    ++restarts;
  }
  lab::run(*run, 0);
  CHECK(restarts >= 100);
  CHECK((*run).engine.state_hash() == reference());
  lab::measured("51", std::to_string(restarts) + " restarts in " + std::to_string(cycles) + " cycles: equal bits");
}

TEST_CASE("51 OK: a restart at each of fifty cycles in a row gives the same bits") {
  Interrupted run(lab::flow);
  lab::run(*run, 700);
  for (unsigned k = 0; k < 50; ++k) {
    run.restart(1 + k % 3, static_cast<int>(detect_isa()));
    (*run).engine.advance();
  }
  lab::run(*run, cycles - 750);
  CHECK((*run).engine.state_hash() == reference());
}
