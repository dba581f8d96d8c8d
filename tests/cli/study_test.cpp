// `scree study`: orders it measures on scenes whose order is known, what it writes, and what it refuses.
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "support/catch.hpp"
#include "support/program.hpp"
#include "support/temporary_folder.hpp"

using support::ProgramEnd;
using support::scree;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A ball that stays on an elastic floor and swings about its rest: smooth, so the leapfrog is of order 2. Without
// gravity it starts at rest, pressed in by 0.1 mm between two floors that both keep touching it.
std::string oscillator(const std::string& more = "", const std::string& law = "kn: 100 kN/m, ks: 0") {
  return "scree: 1\n"
         "vars: {mass: \"4/3*pi*0.01^3*2500\", w: \"sqrt(2e5/mass)\"}\n"
         "walls:\n"
         "  low: {wall: plane, point: [0, 0, -0.0098], normal: [0, 0, 1]}\n"
         "  high: {wall: plane, point: [0, 0, 0.0098], normal: [0, 0, -1]}\n"
         "balls:\n"
         "  ball: {generator: file, path: ball.csv, density: 2500 kg/m3, velocity: [0, 0, 0.2]}\n"
         "contacts:\n"
         "  - {between: [ball, walls], model: linear, " +
         law +
         "}\n"
         "  - {between: [ball, ball], model: none}\n"
         "stages:\n"
         "  - swing: [run: 3 ms]\n" +
         more;
}

struct Folder {
  TemporaryFolder folder;
  ProgramEnd study(const std::string& text, std::vector<std::string> words = {}) const {
    write_text(folder / "ball.csv", "x,y,z,radius\n0,0,0,0.01\n");
    write_text(folder / "scene.yaml", text);
    words.insert(words.begin(), {"study", "scene.yaml", "-j", "1", "--repeats", "1"});
    return scree(words, folder.path());
  }
};

// The number after a text.
double after(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  return at == std::string::npos ? -1 : std::stod(text.substr(at + word.size()));
}

// A table without its columns of wall times.
std::string without_wall(const std::string& table) {
  std::string out, line;
  std::istringstream lines(table);
  while (std::getline(lines, line)) {
    for (int k = 0; k < 3; ++k) line.erase(line.rfind(','));
    out += line + "\n";
  }
  return out;
}

}  // namespace

TEST_CASE("a smooth scene converges with order 2, in trajectory and quantity", "[study]") {
  const Folder at;
  const ProgramEnd end =
      at.study(oscillator("expect:\n  - {quantity: balls.1.position.z, equals: \"0.2/w*sin(w*3e-3)\", within: 50 %,\n"
                          "     source: harmonic motion}\n"));
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  CHECK(after(end.out, "trajectory: order ") == Approx(2).margin(0.2));
  CHECK(after(end.out, "balls.1.position.z: order ") == Approx(2).margin(0.2));
  // Contacts that stay closed balance to rounding.
  CHECK(has(end.out, "energy.residual_share.peak: no order (fewer than three rungs have a small error"));
  CHECK(has(end.out, "For this scene the automatic step ("));
  CHECK(has(end.out, "half of it gives short trajectories within "));
  CHECK(has(end.out, "balls.1.position.z within "));
  const std::string report = read_text(at.folder / "scene.study/study.md");
  CHECK(has(report, "| automatic*2 | "));
  // Both walls at each evaluation of the forces.
  CHECK(has(report, "| automatic/16 | 2.655e-05 | 113 | 228 |"));
  CHECK(has(report, "| 0.8 sqrt(m/k) | "));
  CHECK(has(report, "harmonic motion"));
  CHECK_FALSE(has(report, "(off)"));
}

TEST_CASE("a dashpot is of order 1, and that is expected", "[study]") {
  const Folder at;
  const ProgramEnd end = at.study(oscillator("", "kn: 100 kN/m, ks: 0, dp_nratio: 0.1"));
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  CHECK(after(end.out, "trajectory: order ") == Approx(1).margin(0.4));
  CHECK_FALSE(has(end.out, "look for what is not smooth"));
}

TEST_CASE("two studies differ in wall time alone", "[study]") {
  const Folder at;
  const std::string text = oscillator("expect: [{quantity: balls.1.position.z, at_least: -1}]\n");
  REQUIRE(at.study(text, {"--quick", "--vary", "contacts.0.kn=5e4,2e5"}).code == 0);
  const std::string first = read_text(at.folder / "scene.study/study.csv");
  REQUIRE(at.study(text, {"--quick", "--vary", "contacts.0.kn=5e4,2e5"}).code == 0);
  CHECK(without_wall(first) == without_wall(read_text(at.folder / "scene.study/study.csv")));
  CHECK(without_wall(read_text(at.folder / "scene.study.1/study.csv")) == without_wall(first));
  CHECK(has(first, "contacts.0.kn=5e4,varied,"));
  for (const char* point : {"automaticx2", "automatic_2", "automatic_1", "contacts.0.kn=5e4"})
    CHECK(std::filesystem::exists(at.folder / (std::string("scene.study/") + point + "/summary.json")));
  CHECK_FALSE(std::filesystem::exists(at.folder / "scene.out"));
}

TEST_CASE("a step that fails is a result and the study goes on", "[study]") {
  const Folder at;
  // Twice the automatic step is above the stable limit; over many periods the ball leaves or is lost.
  std::string text = oscillator("expect: [{quantity: balls.1.position.z, between: [-1, 1]}]\n");
  text.replace(text.find("run: 3 ms"), 9, "run: 100 ms");
  const ProgramEnd end = at.study(text, {"--quick"});
  INFO(end.err << end.out);
  CHECK(end.code == 0);
  const std::string table = read_text(at.folder / "scene.study/study.csv");
  CHECK(has(table, "automatic*2,beyond,"));
  CHECK(has(table, "numerical_stop"));
  CHECK(has(table, "automatic/4,ladder,"));
}

TEST_CASE("the worst of many phases shows the order of an impact", "[study]") {
  const std::string scenes = support::source_dir() + "/tests/verify/study/";
  const TemporaryFolder folder;
  const ProgramEnd end = scree({"study", scenes + "co1_pairs.yaml", "-j", "1", "--repeats", "1"}, folder.path());
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  CHECK(after(end.out, "trajectory: order ") == Approx(2).margin(0.2));
  CHECK(after(end.out, "least_peak: order ") == Approx(2).margin(0.2));
  CHECK(after(end.out, "restitution: order ") == Approx(2.5).margin(0.2));
  CHECK(after(end.out, "energy.residual_share.peak: order ") == Approx(2).margin(0.3));
  CHECK(has(read_text(folder / "co1_pairs.study/study.md"), "| 0.8 sqrt(m/k) | "));
}

TEST_CASE("a run that collisions govern states the error of an impact", "[study]") {
  const std::string scene = support::source_dir() + "/tests/verify/study/box_30.yaml";
  const TemporaryFolder folder;
  REQUIRE(scree({"run", scene, "-j", "1", "--quiet", "-o", "out"}, folder.path()).code == 0);
  const std::string summary = read_text(folder / "out/summary.json");
  CHECK(has(summary, "speed after one undamped impact"));
  // Below that of 0.3 of the limit of a pair, to which collisions are held.
  CHECK(after(summary, "\"estimate\": ") == Approx(0.02).margin(0.0052));
}

TEST_CASE("Ctrl-C ends a study, and what is finished is kept", "[study]") {
  const TemporaryFolder folder;
  const std::string scene = support::source_dir() + "/tests/verify/study/box_30.yaml";
  // So many rungs would take days.
  const std::string line = "timeout -s INT --preserve-status 3 '" + support::binary_dir() + "/bin/scree' study '" +
                           scene + "' -j 1 --rungs 40 --repeats 1 -o '" + folder.path() + "/s' > /dev/null 2> '" +
                           folder.path() + "/err'";
  const int status = std::system(line.c_str());
  INFO(read_text(folder / "err"));
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 130);
  CHECK(has(read_text(folder / "err"), "stopped by a signal"));
  CHECK(has(read_text(folder / "s/study.md"), "stopped before its end"));
  CHECK(has(read_text(folder / "s/study.csv"), "automatic,automatic,"));
}

TEST_CASE("scenes that cannot be studied are refused with the reason", "[study]") {
  const Folder at;
  std::string still = oscillator();
  still.replace(still.find("[run: 3 ms]"), 11, "[]");
  const ProgramEnd nothing = at.study(still);
  CHECK(nothing.code == 3);
  CHECK(has(nothing.err, "no stage runs a cycle"));
  std::string own = oscillator();
  own.replace(own.find("[run: 3 ms]"), 11, "[set: {timestep: 1e-6}, run: 3 ms]");
  const ProgramEnd sets = at.study(own);
  CHECK(sets.code == 3);
  CHECK(has(sets.err, "sets the timestep itself"));
  const ProgramEnd vary = at.study(oscillator(), {"--vary", "seed"});
  CHECK(vary.code == 2);
  CHECK(has(vary.err, "--vary key=value,value"));
  const ProgramEnd step = at.study(oscillator(), {"--vary", "timestep=1,2"});
  CHECK(step.code == 2);
  CHECK(has(step.err, "varies it anyhow") + has(step.err, "varies anyhow") > 0);
  CHECK(at.study(oscillator(), {"--rungs", "1"}).code == 2);
  const ProgramEnd unknown = at.study(oscillator(), {"--quantity", "balls.1.positoin.z"});
  CHECK(unknown.code == 3);
  CHECK(has(unknown.err, "balls.1.positoin.z"));
  CHECK_FALSE(std::filesystem::exists(at.folder / "scene.out"));
}
