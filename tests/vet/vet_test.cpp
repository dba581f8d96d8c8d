// Seeded defects, each found by the check that is meant for it; sound plug-ins, which no check finds fault with.
#include "core/vet/vet.hpp"

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/isa.hpp"
#include "core/vet/isolated.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/program.hpp"
#include "support/sanitizer.hpp"

namespace {

using scree::core::Exit;
using scree::core::Refusal;
using scree::core::vet::ChildEnd;
using scree::core::vet::isolated;
using scree::core::vet::Outcome;
using scree::core::vet::Row;
using scree::core::vet::Verdict;
using Json = nlohmann::json;

std::filesystem::path library(const std::string& name) {
  return std::filesystem::path(support::binary_dir()) / "tests/vet" / (name + ".so");
}
std::vector<Row> rows(const std::string& name, const std::string& component, const std::string& check = "",
                      double limit = 60) {
  return scree::core::vet::vet(library(name), {check, component, limit}, [](const Row&) {});
}
/// The outcome of one check of one component.
Outcome outcome(const std::string& name, const std::string& component, const std::string& check, double limit = 60) {
  const std::vector<Row> made = rows(name, component, check, limit);
  REQUIRE(made.size() == 1);
  return made.front().outcome;
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct Seeded {
  const char *component, *check;
};

}  // namespace

TEST_CASE("sound plug-ins of every kind fail no check") {
  std::map<std::string, std::size_t> checks;
  for (const auto& [name, component] : {std::pair{"laws", "sound"},
                                        {"curved", "sound"},
                                        {"curved", "sound_glue"},
                                        {"objects", "sound_wall"},
                                        {"objects", "sound_process"},
                                        {"objects", "sound_generator"},
                                        {"objects", "sound_writer"}})
    for (const Row& row : rows(name, component)) {
      INFO(name << ": " << row.component << ": " << row.check << ": " << row.outcome.found);
      CHECK(row.outcome.verdict != Verdict::fail);
      CHECK(row.outcome.verdict != Verdict::note);
      ++checks[row.component];
    }
  CHECK(checks["contact_model sound"] >= 25);
  CHECK(checks.size() == 6);
}

TEST_CASE("each seeded defect of a law is found by the check that is meant for it") {
  for (const Seeded& seeded : std::initializer_list<Seeded>{{"asymmetric", "exchange"},
                                                            {"lab_axis", "frame_turn"},
                                                            {"not_turned", "turns_along"},
                                                            {"understated", "stiffness"},
                                                            {"hidden_dashpot", "dashpot_share"},
                                                            {"soft_unloading", "nothing_back"},
                                                            {"jump", "continuity"},
                                                            {"short_reach", "reach"},
                                                            {"counts", "no_global_state"},
                                                            {"allocates", "no_allocation"},
                                                            {"zero_over_zero", "extremes"},
                                                            {"neighbour", "batch_sizes"},
                                                            {"neighbour", "repeatable"},
                                                            {"wrong_energy", "energy_balance"},
                                                            {"gives_friction", "energy_balance"},
                                                            {"throws", "extremes"},
                                                            {"crashes", "extremes"},
                                                            {"denormals_off", "float_mode"},
                                                            {"swallows_nan", "nan_passes"},
                                                            {"other_normal", "normal_only"},
                                                            {"derives_again", "inputs"}}) {
    INFO(seeded.component << " by " << seeded.check);
    const Outcome found = outcome("laws", seeded.component, seeded.check);
    CHECK(found.verdict == Verdict::fail);
    CHECK(!found.found.empty());
    CHECK(!found.next.empty());
    // The same check finds no fault with the law that the wrong one was made from.
    CHECK(outcome("laws", "sound", seeded.check).verdict == Verdict::pass);
  }
}

TEST_CASE("defects of nonlinear laws and of bonds are found") {
  for (const Seeded& seeded : {Seeded{"no_rescale", "nothing_back"}, Seeded{"soft_bond", "stiffness_bonded"},
                               Seeded{"never_lets_go", "bond_breaks_once"}}) {
    INFO(seeded.component << " by " << seeded.check);
    CHECK(outcome("curved", seeded.component, seeded.check).verdict == Verdict::fail);
  }
  CHECK(outcome("curved", "sound_glue", "bond_breaks_once").verdict == Verdict::pass);
  // A mode that has to be asked for may make energy: hz_mode 0 and 2.
  for (const char* check : {"nothing_back", "energy_balance"}) {
    const auto end = support::scree({"vet", "hertz_mindlin", "--check", check});
    CHECK(end.code == 0);
    CHECK(has(end.out, "only where a mode is not at its default"));
  }
  CHECK(outcome("laws", "overstated", "stiffness_generous").verdict == Verdict::note);
}

TEST_CASE("defects of walls, processes, generators and writers are found") {
  for (const Seeded& seeded :
       {Seeded{"long_normal", "touches"}, Seeded{"wrong_distance", "slope"}, Seeded{"near_sighted", "wall_reach"},
        Seeded{"allocating_process", "no_allocation"}, Seeded{"zero_over_zero", "extremes"},
        Seeded{"leaking_process", "given_back"}, Seeded{"counting_generator", "repeatable"}, Seeded{"goes_on", "stops"},
        Seeded{"deaf_writer", "full_disk"}, Seeded{"repeating_writer", "resume"}}) {
    INFO(seeded.component << " by " << seeded.check);
    const Outcome found = outcome("objects", seeded.component, seeded.check);
    // The allocator of a sanitizer does not tell how much is taken.
    const bool untold = (address_sanitizer || thread_sanitizer) && std::string(seeded.check) == "given_back";
    CHECK(found.verdict == (untold ? Verdict::skip : Verdict::fail));
    CHECK(!found.found.empty());
  }
}

TEST_CASE("a library that is built wrongly is found out") {
  CHECK(outcome("own_path_vetted", "", "search_paths").verdict == Verdict::fail);
  CHECK(has(outcome("own_path_vetted", "", "search_paths").found, "/opt/other"));
  CHECK(has(outcome("talkative", "", "exported_symbols").found, "chatter besides scree_plugin"));
  CHECK(has(outcome("starts", "", "start_up").found, "loading it changed the environment"));
  // Contraction matters only where an instruction set has the instruction.
  if (scree::core::detect_isa() > scree::core::Isa::baseline)
    CHECK(outcome("contracted", "small", "instruction_sets").verdict == Verdict::fail);
}

TEST_CASE("crashes, endless loops and aborts are results") {
  CHECK(has(outcome("laws", "crashes", "extremes").found, "crashed: SIGSEGV"));
  CHECK(has(outcome("laws", "endless", "extremes", 1).found, "did not come to an end within 1 s"));
  CHECK(has(outcome("laws", "throws", "extremes").found, "the law threw an exception"));
  CHECK(has(outcome("dies", "", "opens").found, "crashed: SIGABRT"));
  // What can be told without loading it is still told, and nothing else is tried.
  const std::vector<Row> all = rows("dies", "");
  CHECK(all.front().outcome.verdict == Verdict::pass);
  CHECK(all.back().component == "library");
}

TEST_CASE("a child process: what it returns, how it ended") {
  const ChildEnd good = isolated([] { return std::string(100000, 'x'); }, 10);
  CHECK(good.finished);
  CHECK(good.bytes == std::string(100000, 'x'));
  const ChildEnd left = isolated([]() -> std::string { std::_Exit(7); }, 10);
  CHECK(!left.finished);
  CHECK(left.code == 7);
  const ChildEnd killed = isolated([]() -> std::string { return ::raise(SIGKILL), ""; }, 10);
  CHECK(killed.signal == SIGKILL);
  const ChildEnd late = isolated(
      []() -> std::string {
        for (;;) ::pause();
      },
      0.2);
  CHECK(late.timed_out);
}

TEST_CASE("an outcome goes through a pipe as it is") {
  const Outcome out{Verdict::fail, "force 3 N", "turn it", 1.5e-7, std::nan("")};
  const Outcome back = Outcome::unpacked(out.packed());
  CHECK(back.verdict == out.verdict);
  CHECK(back.found == out.found);
  CHECK(back.next == out.next);
  CHECK(back.figure == out.figure);
  CHECK(std::isnan(back.tolerance));
  CHECK_THROWS(Outcome::unpacked("4"));
  CHECK_THROWS(
      Outcome::unpacked("9\x1f\x1f\x1f"
                        "0\x1f"
                        "0\x1f"));
}

TEST_CASE("scree vet: exit codes, JSON, and what is no check, no component and no file") {
  const auto good = support::scree({"vet", library("laws").string(), "--component", "sound", "--check", "exchange"});
  CHECK(good.code == 0);
  CHECK(has(good.out, "pass  exchange"));
  CHECK(has(good.out, "1 checks: 1 passed"));
  const auto bad =
      support::scree({"vet", library("laws").string(), "--component", "asymmetric", "--check", "exchange", "--json"});
  CHECK(bad.code == 4);
  const Json json = Json::parse(bad.out);
  CHECK(json["passed"] == false);
  CHECK(json["checks"][0]["verdict"] == "fail");
  CHECK(json["checks"][0]["figure"].get<double>() > 1e-4);
  CHECK(has(json["checks"][0]["found"].get<std::string>(), "kn="));
  const auto check = support::scree({"vet", library("laws").string(), "--check", "exchagne"});
  CHECK(check.code == 2);
  CHECK(has(check.err, "did you mean 'exchange'?"));
  const auto component = support::scree({"vet", library("laws").string(), "--component", "sonud"});
  CHECK(component.code == 2);
  CHECK(has(component.err, "did you mean 'sound'?"));
  CHECK(support::scree({"vet", "linear", "--check", "exported_symbols"}).code == 0);
  CHECK(has(support::scree({"vet", "linaer"}).err, "there is no file and no plug-in 'linaer'"));
  CHECK(support::scree({"vet", "/nowhere/springs.so"}).code == 4);
  CHECK(support::scree({"vet"}).code == 2);
  CHECK(support::scree({"vet", library("laws").string(), "--limit", "soon"}).code == 2);
  CHECK(has(support::scree({"vet", "--list"}).out, "frame_turn"));
}

TEST_CASE("a file that is no library is a result as well") {
  const TemporaryFolder folder;
  write_text(folder / "notes.so", "kn: 1e6\n");
  const auto end = support::scree({"vet", folder / "notes.so"});
  CHECK(end.code == 4);
  CHECK(has(end.out, "not a shared library"));
}

namespace {
/// No check of any library in the folders of kinds below `folder` fails; returns how many libraries there are.
std::size_t all_pass(const std::filesystem::path& folder) {
  std::size_t libraries = 0;
  for (const auto& kind : std::filesystem::directory_iterator(folder))
    for (const auto& file : std::filesystem::directory_iterator(kind)) {
      ++libraries;
      for (const Row& row : scree::core::vet::vet(file.path(), {"", "", 120}, [](const Row&) {})) {
        INFO(file.path() << ": " << row.component << ": " << row.check << ": " << row.outcome.found);
        CHECK(row.outcome.verdict != Verdict::fail);
      }
    }
  return libraries;
}
}  // namespace

TEST_CASE("every built-in library passes vet") { CHECK(all_pass(support::plugin_dir()) >= 10); }

TEST_CASE("the sketches of nonlinear, bonded and attracting laws pass vet") {
  const std::filesystem::path folder = std::filesystem::path(support::binary_dir()) / "tests/gxx";
  if (std::filesystem::exists(folder))
    CHECK(all_pass(folder) >= 4);
  else
    WARN("skipped: g++ is not installed");
}
