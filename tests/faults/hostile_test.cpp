// Plug-ins that pass the loader and misbehave while they run (wrong/hostile.cpp): each ends the run with a sentence
// that names it, with the documented exit code, and without a checkpoint from the broken state.
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "faults/started.hpp"
#include "support/catch.hpp"
#include "support/program.hpp"
#include "support/temporary_folder.hpp"

namespace {
namespace fs = std::filesystem;
using support::ProgramEnd;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The hostile library as a plug-in of every kind, a scene with it, and what became of the scene.
class Scene {
 public:
  Scene() {
    for (const char* kind : {"contact_model", "wall", "generator", "process", "writer"}) {
      fs::create_directories(here_ / ("plugins/" + std::string(kind)));
      fs::copy_file(support::binary_dir() + "/tests/hostile/hostile.so",
                    here_ / ("plugins/" + std::string(kind) + "/hostile.so"));
    }
    // A crash is expected: it need not leave a core file in the folder of the tests.
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
  }
  ProgramEnd run(const std::string& scene, std::vector<std::string> flags = {}) const {
    write_text(here_ / "scene.yaml", scene);
    flags.insert(flags.begin(), {"run", "scene.yaml", "--plugins", "plugins", "--no-color"});
    return support::scree(flags, here_.path());
  }
  ProgramEnd resume(std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"resume", "scene.out", "--plugins", "plugins", "--no-color"});
    return support::scree(flags, here_.path());
  }
  std::string file(const std::string& name) const { return here_ / name; }

 private:
  TemporaryFolder here_;
};

/// Four balls in a row; only balls 3 and 4 overlap by more than the law bears.
std::string row(int deed) {
  return R"(scree: 1
timestep: 0.1 ms
balls:
  sand: {generator: file, path: balls.csv, density: 2600}
contacts:
  - {name: grains, between: [sand, sand], model: hostile, kn: 1e4, from: 1.5e-4, deed: )" +
         std::to_string(deed) + "}\nstages:\n  - go: [cycle: 200]\n";
}
const char* const row_balls = "x,y,z,radius\n0,0,0,0.01\n0.0199,0,0,0.01\n0.0398,0,0,0.01\n0.0596,0,0,0.01\n";
/// Two balls that meet after about 100 cycles.
const char* const meeting = "x,y,z,radius,vx,vy,vz\n0,0,0,0.01,0,0,0\n0.021,0,0,0.01,-0.1,0,0\n";

/// One ball that lies on a wall.
std::string lying(const std::string& wall, const std::string& process, const std::string& record = "") {
  return "scree: 1\ntimestep: 0.1 ms\nwalls:\n  floor: " + wall + R"(
balls:
  sand: {generator: file, path: balls.csv, density: 2600}
contacts:
  - {name: grains, between: [sand, sand], model: linear, kn: 1e4, ks: 0}
  - {name: ground, between: [sand, floor], model: linear, kn: 1e4, ks: 0}
processes:
  pull: )" +
         process + "\n" + record + "stages:\n  - go: [cycle: 20]\n";
}
const char* const plane = "{wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}";
const char* const gravity = "{process: gravity, acceleration: [0, 0, -9.81]}";
std::string deed(const std::string& kind, int number) {
  return "{" + kind + ": hostile, deed: " + std::to_string(number) + "}";
}

struct Case {
  std::string name, scene, balls;
  int code;
  std::vector<std::string> says;
};

void check(const Case& one) {
  const Scene scene;
  write_text(scene.file("balls.csv"), one.balls);
  const ProgramEnd end = scene.run(one.scene);
  INFO(one.name << "\n" << end.err);
  CHECK(end.signal == 0);
  CHECK(end.code == one.code);
  for (const std::string& part : one.says) {
    INFO("wants: " << part);
    CHECK(has(end.err, part));
  }
  CHECK_FALSE(fs::exists(scene.file("scene.out/checkpoint/latest.scree")));
}

}  // namespace

TEST_CASE("hostile laws: what is thrown or is no number names plug-in, rule, contact and cycle") {
  const std::string who = "under rule 'grains' (contact model 'hostile')";
  const std::vector<Case> all = {
      {"throws in prepare", row(1), row_balls, 3, {"scene.yaml:6:", "grains", "this law likes no kn"}},
      {"throws in derive",
       row(2),
       row_balls,
       3,
       {"scene.yaml:6:", "its 'derive' threw an exception for a contact of radii 0.010000 and 0.010000 m"}},
      {"throws in law",
       row(10),
       row_balls,
       4,
       {"cycle 0: contact model 'hostile' of rule 'grains' threw an exception for the contact of balls 3 and 4: report "
        "it to the plug-in's author"}},
      {"throws an int", row(11), row_balls, 4, {"for the contact of balls 3 and 4"}},
      {"NaN",
       row(12),
       row_balls,
       5,
       {"cycle 0: the force between balls 3 and 4 " + who + " is not a finite number, (", "nan", "failure.csv"}},
      {"1e308",
       row(13),
       row_balls,
       5,
       {"cycle 0: the force between balls 3 and 4 " + who + " is too large to compute with, (1e+308, 0, 0) N"}},
      {"infinite moment",
       row(14),
       row_balls,
       5,
       {"cycle 0: the moment between balls 3 and 4 " + who + " is not a finite number, (inf, ", "N m"}}};
  for (const Case& one : all) check(one);
}

TEST_CASE("hostile laws at a wall: ball and wall are named") {
  const std::string balls = "x,y,z,radius\n0,0,0.5,0.01\n0,0,0.0097,0.01\n";
  const auto scene = [](int number) {
    std::string text = lying(plane, gravity);
    const std::string rule = "between: [sand, floor], model: linear, kn: 1e4, ks: 0";
    return text.replace(text.find(rule), rule.size(),
                        "between: [sand, floor], model: hostile, kn: 1e4, deed: " + std::to_string(number));
  };
  check(
      {"throws", scene(10), balls, 4, {"rule 'ground' threw an exception for the contact of ball 2 and wall 'floor'"}});
  check({"NaN", scene(12), balls, 5, {"the force between ball 2 and wall 'floor' under rule 'ground'"}});
  check({"1e308", scene(13), balls, 5, {"ball 2 and wall 'floor'", "is too large to compute with, (0, 0, -1e+308) N"}});
  check({"moment", scene(14), balls, 5, {"the moment between ball 2 and wall 'floor'"}});
}

TEST_CASE("hostile walls, generators, processes and writers are named") {
  const std::string balls = "x,y,z,radius\n0,0,0.0099,0.01\n", author = "report it to the plug-in's author";
  const std::string wall = "wall 'floor' (plug-in 'hostile') ";
  const auto record = [](int number) {
    return "record:\n  tape: {writer: hostile, every: 5, deed: " + std::to_string(number) + "}\n";
  };
  const auto pour = [](int number) {
    std::string text = lying(plane, gravity);
    const std::string old = "generator: file, path: balls.csv";
    return text.replace(text.find(old), old.size(), "generator: hostile, deed: " + std::to_string(number));
  };
  const auto at_wall = [&](int number) { return lying(deed("wall", number), gravity); };
  const auto process = [&](int number) { return lying(plane, deed("process", number)); };
  const std::vector<Case> all = {
      {"touch throws", at_wall(1), balls, 4, {wall + "threw an exception while it was asked for touches", author}},
      {"count grows", at_wall(2), balls, 4, {wall + "gives more touches each time it is asked for the same balls"}},
      {"no such ball", at_wall(3), balls, 4, {wall + "gives a touch of ball 4000000 of 1 that it was asked about"}},
      {"NaN distance", at_wall(4), balls, 4, {wall + "gives a distance that is not a finite number"}},
      {"long normal", at_wall(5), balls, 4, {wall + "gives a normal that is not of length 1"}},
      {"too many", at_wall(6), balls, 4, {wall + "gives 3000001 touches for 1 balls, more than any surface"}},
      {"NaN normal", at_wall(7), balls, 4, {wall + "gives a normal that is not of length 1"}},
      {"NaN position", pour(1), balls, 3, {"scene.yaml:6:", "balls 'sand': a ball has a position that is not finite"}},
      {"negative radius", pour(2), balls, 3, {"balls 'sand': ball at (0, 0, 2) m with radius -0.01 m"}},
      {"generator throws", pour(3), balls, 3, {"balls 'sand': it threw something that is not a std::exception"}},
      {"NaN force", process(1), balls, 5, {"cycle 0:", "ball 1 is not a finite number", "process 'pull'"}},
      {"NaN velocity", process(2), balls, 5, {"cycle 0:", "ball 1 is not a finite number", "process 'pull'"}},
      {"step throws", process(3), balls, 4, {"process 'pull' stopped the run at cycle 1: this wind likes no cycle"}},
      {"NaN wall", process(4), balls, 5, {"cycle 1: process 'pull' gave wall 'floor' a velocity or spin that is not"}},
      {"prepare throws", process(5), balls, 3, {"scene.yaml:11:", "process 'pull': this wind likes no scene"}},
      {"open throws", lying(plane, gravity, record(1)), balls, 3, {"record 'tape': this scribe likes no file"}},
      {"frame throws",
       lying(plane, gravity, record(2)),
       balls,
       6,
       {"record 'tape' could not write its frame of cycle 0"}},
      {"close throws", lying(plane, gravity, record(3)), balls, 6, {"record 'tape' could not be closed"}}};
  for (const Case& one : all) check(one);
}

TEST_CASE("a crash names plug-in, rule, contact and checkpoint, saves nothing, and dies of its signal") {
  struct Crash {
    int deed, signal;
  };
  for (const Crash& one : {Crash{21, SIGSEGV}, Crash{22, SIGSEGV}, Crash{23, SIGABRT}, Crash{24, SIGFPE}}) {
    const Scene scene;
    write_text(scene.file("balls.csv"), meeting);
    std::string text = row(one.deed);
    text.replace(text.find("from: 1.5e-4"), 12, "from: 0");
    CHECK(scene.run(text, {"-n", "50"}).code == 0);
    const std::string latest = scene.file("scene.out/checkpoint/latest.scree"), before = read_text(latest);
    REQUIRE_FALSE(before.empty());
    const ProgramEnd end = scene.resume();
    INFO(one.deed << "\n" << end.err);
    CHECK(end.signal == one.signal);
    CHECK(has(end.err, "in plug-in 'hostile', used as 'grains', cycle 10"));
    CHECK(has(end.err, "first contact of the batch: balls 1 and 2"));
    CHECK(has(end.err, "nothing was saved now, the last good checkpoint is scene.out/checkpoint/latest.scree"));
    CHECK(read_text(latest) == before);
    CHECK_FALSE(fs::exists(scene.file("scene.out/checkpoint/previous.scree")));
  }
}

namespace {
/// So many balls that do not touch that the bad pair lies in the second block, which the second thread has.
std::string two_blocks(int number) {
  std::string text = row(number);
  const std::string sand = "sand: {generator: file, path: balls.csv, density: 2600}";
  text.replace(text.find(sand), sand.size(),
               sand +
                   "\n  dust: {generator: lattice, kind: sc, radius: 0.001, spacing: 0.01, "
                   "box: [[-0.5, -0.5, -0.5], [-0.36, -0.39, -0.39]], density: 2600}");
  text.replace(text.find("0.1 ms"), 6, "0.02 ms");
  const std::string between = "between: [sand, sand]";
  return text.replace(text.find(between), between.size(), "between: [balls, balls]");
}
}  // namespace

TEST_CASE("a crash on a helper thread is told as well") {
  const Scene scene;
  write_text(scene.file("balls.csv"), row_balls);
  const ProgramEnd end = scene.run(two_blocks(21), {"-j", "2"});
  INFO(end.err);
  CHECK(end.signal == SIGSEGV);
  CHECK(has(end.err, "in plug-in 'hostile', used as 'grains', cycle 0, block 1, first contact of the batch: balls "));
  CHECK(has(end.err, "there is no checkpoint"));
}

TEST_CASE("other kinds crash under their own names") {
  const std::string balls = "x,y,z,radius\n0,0,0.0099,0.01\n";
  const Scene scene;
  write_text(scene.file("balls.csv"), balls);
  const ProgramEnd ball = scene.run(lying(plane, deed("process", 6)));
  INFO(ball.err);
  CHECK(ball.signal == SIGABRT);
  CHECK(has(ball.err, "in plug-in 'hostile', used as 'pull', cycle 0"));
  const ProgramEnd frame =
      scene.run(lying(plane, gravity, "record:\n  tape: {writer: hostile, every: 5, deed: 4}\n"), {"-o", "frame.out"});
  INFO(frame.err);
  CHECK(frame.signal == SIGSEGV);
  CHECK(has(frame.err, "in plug-in 'hostile', used as 'tape', cycle 0"));
}

TEST_CASE("an endless law ends the run after its time of patience, from any thread") {
  for (const std::string threads : {"1", "2"}) {
    const Scene scene;
    write_text(scene.file("balls.csv"), row_balls);
    const ProgramEnd end = scene.run(two_blocks(20), {"-j", threads, "--patience", "0.5"});
    INFO(end.err);
    CHECK(end.signal == 0);
    CHECK(end.code == 4);
    CHECK(has(end.err,
              "cycle 0 did not come to an end within 0.5 s: stuck in plug-in 'hostile', used as 'grains', cycle "
              "0, block 1, first contact of the batch: balls "));
    CHECK(has(end.err, "nothing was saved now, there is no checkpoint"));
    CHECK(has(end.err, "--patience"));
    CHECK(has(read_text(scene.file("scene.out/log.txt")), "did not come to an end"));
    CHECK_FALSE(fs::exists(scene.file("scene.out/checkpoint/latest.scree")));
  }
}

TEST_CASE("after an endless law the checkpoint of before is named and good") {
  const Scene scene;
  write_text(scene.file("balls.csv"), meeting);
  std::string text = row(20);
  text.replace(text.find("from: 1.5e-4"), 12, "from: 0");
  CHECK(scene.run(text, {"-n", "50"}).code == 0);
  const std::string latest = scene.file("scene.out/checkpoint/latest.scree"), before = read_text(latest);
  const ProgramEnd end = scene.resume({"--patience", "0.5"});
  INFO(end.err);
  CHECK(end.code == 4);
  CHECK(has(end.err, "the last good checkpoint is scene.out/checkpoint/latest.scree"));
  CHECK(read_text(latest) == before);
  CHECK(scene.resume({"-n", "20"}).code == 0);
}

TEST_CASE("an endless process ends the run as well") {
  const std::string balls = "x,y,z,radius\n0,0,0.0099,0.01\n";
  const Scene scene;
  write_text(scene.file("balls.csv"), balls);
  const ProgramEnd ball = scene.run(lying(plane, deed("process", 20)), {"--patience", "0.5"});
  INFO(ball.err);
  CHECK(ball.code == 4);
  CHECK(has(ball.err, "stuck in plug-in 'hostile', used as 'pull', cycle 0"));
}

TEST_CASE("a run that was stopped for longer than its patience goes on") {
  const Scene scene;
  write_text(scene.file("balls.csv"), row_balls);
  std::string text = row(0);
  text.replace(text.find("cycle: 200"), 10, "cycle: 100000000");
  write_text(scene.file("scene.yaml"), text);
  support::Started run({"run", "scene.yaml", "--plugins", "plugins", "--patience", "0.3", "--time-limit", "2"},
                       fs::path(scene.file("scene.yaml")).parent_path());
  REQUIRE(run.says("stage 'go'"));
  run.send(SIGSTOP);
  const timespec longer{0, 800000000};
  ::nanosleep(&longer, nullptr);
  run.send(SIGCONT);
  const ProgramEnd end = run.wait();
  INFO(end.err);
  CHECK(end.code == 75);
}
