// `scree study`: orders it measures on scenes whose order is known, what it writes, and what it refuses.
#include <cmath>
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

std::vector<std::string> parted(const std::string& line) {
  std::istringstream fields(line);
  std::vector<std::string> out;
  for (std::string field; std::getline(fields, field, ',');) out.push_back(field);
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
  CHECK_FALSE(has(end.out, "rotation"));
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

TEST_CASE("turns are compared where balls turn, and converge with order 2", "[study]") {
  const Folder at;
  // The shear springs of both floors hold the ball's spin, which swings without sliding.
  std::string text = oscillator("", "kn: 100 kN/m, ks: 5 kN/m, fric: 1000");
  text.replace(text.find("velocity: [0, 0, 0.2]"), 21, "spin: [0, 30, 0]");
  const ProgramEnd end = at.study(text);
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  CHECK(after(end.out, "rotation: order ") == Approx(2).margin(0.1));
  CHECK(has(end.out, "rotations within "));
  CHECK(has(read_text(at.folder / "scene.study/study.md"), "| rotation, rad | "));
  // Leapfrog of a harmonic swing with n steps: w0 sin(n p)/(w cos(p/2)), sin(p/2) = w dt/2; exactly w0 sin(w t)/w.
  const double radius = 0.01, lever = 0.0099, inertia = 0.4 * 4 / 3 * std::acos(-1.0) * std::pow(radius, 5) * 2500;
  const double w = std::sqrt(2 * 5e3 * lever * lever / inertia), t = 3e-3;
  const std::string table = read_text(at.folder / "scene.study/study.csv");
  std::istringstream lines(table);
  std::string line;
  unsigned seen = 0;
  while (std::getline(lines, line)) {
    if (!has(line, ",ladder,") || !has(line, ",rotation,")) continue;
    const std::vector<std::string> fields = parted(line);
    const double n = std::stod(fields[4]), p = 2 * std::asin(w * t / n / 2);
    const double wrong = 30 / w * std::abs(std::sin(n * p) / std::cos(p / 2) - std::sin(w * t));
    INFO(line);
    CHECK(std::stod(fields[12]) == Approx(wrong).epsilon(0.02).margin(std::stod(fields[11])));
    ++seen;
  }
  CHECK(seen == 9);
}

TEST_CASE("the drift of the energy residual is measured over the cycles of long runs", "[study]") {
  const Folder at;
  std::string text = oscillator("expect: [{quantity: balls.1.position.z, at_least: -1}]\n");
  text.replace(text.find("run: 3 ms"), 9, "run: 100 ms");
  const ProgramEnd end = at.study(text, {"--rungs", "2"});
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  const std::string table = read_text(at.folder / "scene.study/study.csv");
  INFO(table);
  const std::size_t rung = table.find("automatic/1.41,ladder,");
  REQUIRE(rung != std::string::npos);
  // Contacts that stay closed balance to rounding, so nothing may drift.
  const std::string row = "energy.residual_share per 1e6 cycles,";
  REQUIRE(table.find(row, rung) != std::string::npos);
  CHECK(std::abs(std::stod(table.substr(table.find(row, rung) + row.size()))) < 1e-6);
  CHECK(has(read_text(at.folder / "scene.study/study.md"), "Drift of the energy residual in 1e6 cycles"));
}

TEST_CASE("a quick study runs the beginning of a scene and compares its energy balance alone", "[study]") {
  const Folder at;
  std::string text = oscillator("expect: [{quantity: balls.1.position.z, at_least: -1}]\n");
  text.replace(text.find("run: 3 ms"), 9,
               "run: 1 s, add: {walls: {late: {wall: plane, point: [0, 0, -1], normal: [0, 0, 1]}}}, run: 9 s");
  const ProgramEnd end = at.study(text, {"--quick"});
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  const std::string report = read_text(at.folder / "scene.study/study.md"), first = "over the first ";
  INFO(report);
  // 500 steps of 0.42 ms are more than 2 % of 10 s.
  REQUIRE(has(report, first));
  const double span = std::stod(report.substr(report.find(first) + first.size()));
  CHECK(span == Approx(500 * after(report, "The least automatic step was ")).epsilon(0.01));
  CHECK(has(report, " of 10 s"));
  CHECK(has(end.out, "energy.residual_share.peak: "));
  CHECK_FALSE(has(end.out, "trajectory"));
  CHECK_FALSE(has(end.out, "balls.1.position.z"));
  CHECK_FALSE(has(report, "Nothing touched"));
  const std::string table = read_text(at.folder / "scene.study/study.csv");
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    if (has(line, "numerical_stop")) continue;
    INFO(line);
    CHECK(std::stod(parted(line).at(5)) == Approx(span).epsilon(0.01));
  }
}

TEST_CASE("a quick study of a flight says that it knows nothing of contacts", "[study]") {
  const Folder at;
  std::string text = oscillator();
  text.replace(text.find("[0, 0, -0.0098]"), 15, "[0, 0, -1]");
  text.replace(text.find("[0, 0, 0.0098]"), 14, "[0, 0, 1]");
  // The cycles of `solve` are a guard, not a length.
  text.replace(text.find("run: 3 ms"), 9, "run: 100 s, solve: {unbalanced: 1e-5, at_most: 200000000 cycles}");
  const ProgramEnd end = at.study(text, {"--quick"});
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  const std::string report = read_text(at.folder / "scene.study/study.md");
  INFO(report);
  CHECK(has(report, "over the first 2 s of the scene of 100 s"));
  CHECK(has(report, "Nothing touched in the part of the scene"));
}

// Two walls with F = (4/3) E* sqrt(R d^3), so that k = 2 E* sqrt(R) (sqrt(d1) + sqrt(d2)); d1 + d2 = 0.4 mm, and the
// ball is thrown against one of them at 0.2 m/s. The least step is that of the middle, where the sum of roots is
// largest.
TEST_CASE("the usual step knows the overlap with walls", "[study]") {
  const Folder at;
  std::string text = oscillator();
  text.replace(text.find("model: linear, kn: 100 kN/m, ks: 0"), 34,
               "model: hertz_mindlin, shear: 1 GPa, poiss: 0.25, dp_nratio: 0, fric: 0");
  const ProgramEnd end = at.study(text, {"--rungs", "2"});
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  const std::string report = read_text(at.folder / "scene.study/study.md");
  INFO(report);
  const double effective = 1e9 / (1 - 0.25);
  const double mass = 4.0 / 3 * 3.14159265358979 * 1e-6 * 2500,
               k = 2 * effective * std::sqrt(0.01) * 2 * std::sqrt(2e-4);
  // Steps are lowered a little, to fill the stage with whole ones.
  CHECK(after(report, "| 0.8 sqrt(m/k) | ") == Approx(0.8 * std::sqrt(mass / k)).epsilon(0.02));
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
