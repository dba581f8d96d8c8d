// Signals, kills and a second run in the same folder. What comes out must be what the undisturbed run gives: the same
// hash, and the same history without a gap or a row twice.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "faults/started.hpp"
#include "support/catch.hpp"

namespace {

using support::ProgramEnd;
using support::Started;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Bouncing and rubbing balls, long enough to be disturbed.
const char* const shake = R"(scree: 1
seed: 4
walls:
  room: {wall: box, low: [0, 0, 0], high: [0.06, 0.06, 0.06], spin: [0, 0, 0]}
balls:
  gas: {generator: random, radius: [4 mm, 6 mm], count: 40, box: [[0, 0, 0], [0.06, 0.06, 0.06]], density: 2600, velocity: [1, 2, -3]}
contacts:
  - {name: all, between: [balls, [balls, walls]], model: linear, kn: 1e5, ks: 5e4, fric: 0.2}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
stages:
  - shake: [cycle: 100000]
  - calm: [set: {contacts.all.fric: 0.5}, cycle: 500]
record:
  history: {writer: csv, every: 500 cycles, quantities: [kinetic_energy, walls.room.force.z]}
)";

struct Job {
  TemporaryFolder folder;
  Job() { write_text(folder / "shake.yaml", shake); }
  std::string hash() const {
    return nlohmann::json::parse(read_text(folder / "shake.out/summary.json")).at("state_hash");
  }
  std::string history() const { return read_text(folder / "shake.out/history.csv"); }
  bool has_checkpoint() const { return std::filesystem::exists(folder / "shake.out/checkpoint/latest.scree"); }
  ProgramEnd resume(const std::string& threads) const {
    return support::scree({"resume", "shake.out", "-j", threads}, folder.path());
  }
};

struct Undisturbed {
  std::string hash, history;
};

const Undisturbed& undisturbed() {
  static const Undisturbed result = [] {
    const Job job;
    const ProgramEnd end = support::scree({"run", "shake.yaml", "-j", "1"}, job.folder.path());
    INFO(end.err);
    REQUIRE(end.code == 0);
    return Undisturbed{job.hash(), job.history()};
  }();
  return result;
}

void check_same(const Job& job) {
  CHECK(job.hash() == undisturbed().hash);
  CHECK(job.history() == undisturbed().history);
}

void pause(long milliseconds) {
  const timespec time{0, milliseconds * 1000000};
  ::nanosleep(&time, nullptr);
}

}  // namespace

TEST_CASE("SIGINT and SIGTERM save, and the resumed run has the same bits") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Job job;
    Started run({"run", "shake.yaml"}, job.folder.path());
    REQUIRE(run.says("stage 'shake'"));
    pause(30);
    run.send(signal);
    const ProgramEnd end = run.wait();
    INFO(end.err << end.out);
    REQUIRE(end.code == 128 + signal);
    CHECK(has(end.err + end.out, "scree resume shake.out"));
    CHECK(job.has_checkpoint());
    const ProgramEnd again = job.resume("2");
    INFO(again.err);
    REQUIRE(again.code == 0);
    check_same(job);
  }
}

TEST_CASE("a run that is interrupted again and again has the same bits") {
  const Job job;
  {
    Started run({"run", "shake.yaml"}, job.folder.path());
    REQUIRE(run.says("stage 'shake'"));
    pause(20);
    run.send(SIGINT);
    REQUIRE(run.wait().code == 130);
  }
  for (int again = 0; again < 4; ++again) {
    Started run({"resume", "shake.out", "-j", std::to_string(1 + again % 3)}, job.folder.path());
    REQUIRE(run.says("goes on from cycle"));
    pause(30);
    run.send(SIGINT);
    const int code = run.wait().code;
    REQUIRE((code == 130 || code == 0));
    if (code == 0) return check_same(job);
  }
  REQUIRE(job.resume("1").code == 0);
  check_same(job);
}

TEST_CASE("SIGUSR1 saves and the run goes on as if nothing had been") {
  const Job job;
  Started run({"run", "shake.yaml"}, job.folder.path());
  REQUIRE(run.says("stage 'shake'"));
  run.send(SIGUSR1);
  REQUIRE(run.says("saved "));
  run.send(SIGUSR1);
  const ProgramEnd end = run.wait();
  INFO(end.err);
  REQUIRE(end.code == 0);
  CHECK(job.has_checkpoint());
  check_same(job);
}

TEST_CASE("after kill -9 a run goes on from its last checkpoint") {
  const Job job;
  {
    Started run({"run", "shake.yaml"}, job.folder.path());
    REQUIRE(run.says("stage 'shake'"));
    pause(20);
    run.send(SIGUSR1);
    REQUIRE(run.says("saved "));
    pause(20);
    run.send(SIGKILL);
    REQUIRE(run.wait().signal == SIGKILL);
  }
  const ProgramEnd refused = support::scree({"run", "shake.yaml"}, job.folder.path());
  CHECK(refused.code == 6);
  CHECK(has(refused.err, "scree resume"));
  const ProgramEnd end = job.resume("3");
  INFO(end.err);
  REQUIRE(end.code == 0);
  check_same(job);
}

TEST_CASE("a second run in the folder of a running one is exit 9 and harms nothing") {
  const Job job;
  Started run({"run", "shake.yaml"}, job.folder.path());
  REQUIRE(run.says("stage 'shake'"));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "shake.yaml"}, std::vector<std::string>{"resume", "shake.out"}}) {
    const ProgramEnd second = support::scree(words, job.folder.path());
    INFO(second.err);
    CHECK(second.code == 9);
    CHECK(has(second.err, "shake.out"));
    CHECK(has(second.err, "in use"));
  }
  REQUIRE(run.wait().code == 0);
  check_same(job);
}

TEST_CASE("a run that is cut short by -n or --stage is not judged and goes on") {
  const Job job;
  write_text(job.folder / "shake.yaml",
             std::string(shake) + "expect:\n  - {quantity: cycle, equals: 100500, within: 0.1}\n");
  const ProgramEnd first = support::scree({"run", "shake.yaml", "-n", "30000"}, job.folder.path());
  INFO(first.err);
  REQUIRE(first.code == 0);
  CHECK(has(first.err, "scree resume shake.out"));
  REQUIRE(support::scree({"resume", "shake.out", "-n", "7001", "-j", "2"}, job.folder.path()).code == 0);
  const auto summary = nlohmann::json::parse(read_text(job.folder / "shake.out/summary.json"));
  CHECK(summary.at("cycles") == 37001);
  CHECK_FALSE(summary.contains("expectations"));
  const ProgramEnd end = job.resume("1");
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  CHECK(has(end.out, "passed"));
  check_same(job);
  const ProgramEnd stage = support::scree({"run", "shake.yaml", "--stage", "shake", "-o", "staged"}, job.folder.path());
  REQUIRE(stage.code == 0);
  REQUIRE(support::scree({"resume", "staged"}, job.folder.path()).code == 0);
  CHECK(read_text(job.folder / "staged/history.csv") == undisturbed().history);
}

TEST_CASE("a run with fragments and files of its own folder resumes from any working directory") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scenes/parts");
  std::filesystem::create_directories(folder / "elsewhere");
  write_text(folder / "scenes/parts/floor.yaml",
             "walls: {floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}}\n"
             "contacts: [{name: all, between: [balls, [balls, walls]], model: linear, kn: 1e4, ks: 0}]\n");
  write_text(folder / "scenes/parts/more.yaml", "- {cycle: 40}\n");
  write_text(folder / "scenes/first.csv", "x,y,z,radius\n0,0,0.0102,0.01\n");
  write_text(folder / "scenes/later.csv", "x,y,z,radius\n0.1,0,0.0103,0.01\n");
  write_text(folder / "scenes/job.yaml",
             "scree: 1\ninclude: parts/floor.yaml\n"
             "balls: {first: {generator: file, path: first.csv, density: 2600, velocity: [0, 0, -1]}}\n"
             "stages:\n  - go: [cycle: 40, add: {balls: {later: {generator: file, path: later.csv, density: 2600}}},\n"
             "         include: parts/more.yaml]\n"
             "record: {history: {writer: csv, every: 5 cycles, quantities: [kinetic_energy]}}\n");
  const ProgramEnd whole = support::scree({"run", "job.yaml"}, folder / "scenes");
  INFO(whole.err);
  REQUIRE(whole.code == 0);
  REQUIRE(support::scree({"run", "scenes/job.yaml", "-n", "20", "-o", "scenes/cut.out"}, folder.path()).code == 0);
  // All that `resume` needs of the fragments is in the checkpoint.
  std::filesystem::remove_all(folder / "scenes/parts");
  const ProgramEnd end = support::scree({"resume", "../scenes/cut.out"}, folder / "elsewhere");
  INFO(end.err);
  CHECK(end.code == 0);
  const auto result = [&](const std::string& name) {
    return nlohmann::json::parse(read_text(folder / ("scenes/" + name + ".out/summary.json")));
  };
  CHECK(result("job").at("balls") == 2);
  CHECK(result("cut").at("state_hash") == result("job").at("state_hash"));
  CHECK(read_text(folder / "scenes/cut.out/history.csv") == read_text(folder / "scenes/job.out/history.csv"));
}
