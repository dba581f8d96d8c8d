// Runs that go wrong on the way: too much overlap, too much speed, no room on the disk.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "faults/started.hpp"
#include "support/catch.hpp"

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A ball that is shot at the floor; what happens depends on its speed.
std::string shot(const std::string& velocity, const std::string& stages, const std::string& more = "") {
  return "scree: 1\n" + more +
         "walls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n"
         "balls:\n  sand: {generator: lattice, kind: sc, radius: 10 mm, spacing: 22 mm,\n"
         "         box: [[0, 0, 1 mm], [44 mm, 44 mm, 45 mm]], density: 2600, velocity: [0, 0, " +
         velocity +
         "]}\n"
         "contacts:\n  - {name: ground, between: [sand, [sand, floor]], model: linear, kn: 1e5, ks: 1e5, fric: 0.5}\n"
         "stages:\n  - fall: [" +
         stages + "]\n";
}

support::ProgramEnd run(const TemporaryFolder& folder, const std::string& scene) {
  write_text(folder / "scene.yaml", scene);
  return support::scree({"run", "scene.yaml", "--no-color"}, folder.path());
}

nlohmann::json summary(const TemporaryFolder& folder) {
  return nlohmann::json::parse(read_text(folder / "scene.out/summary.json"));
}

}  // namespace

TEST_CASE("overlap beyond the limit is exit 5, with the worst balls and what to change") {
  // At rest m v^2 = kn d^2: half a radius at 15.2 m/s.
  const TemporaryFolder folder;
  const support::ProgramEnd end = run(folder, shot("-25", "cycle: 100000", "timestep: 2e-5\n"));
  INFO(end.err);
  CHECK(end.code == 5);
  for (const char* part : {"cycle ", "wall 'floor'", "of the smaller radius (limit 0.5)", "rule 'ground'", "'linear'",
                           "the stable limit", "failure.csv", "overlap_limit"}) {
    INFO("wants: " << part);
    CHECK(has(end.err, part));
  }
  const std::string failure = read_text(folder / "scene.out/failure.csv");
  CHECK(has(failure, "id,group,x,y,z,radius,vx,vy,vz,fx,fy,fz\n"));
  CHECK(has(failure, ",sand,"));
  CHECK(summary(folder).at("status") == "numerical_stop");
  CHECK(summary(folder).at("exit_code") == 5);
  // The same shot below the limit goes on.
  const TemporaryFolder slower;
  CHECK(run(slower, shot("-10", "cycle: 2000", "timestep: 2e-5\n")).code == 0);
}

TEST_CASE("a stop names the last good checkpoint") {
  const TemporaryFolder folder;
  const support::ProgramEnd end =
      run(folder, shot("-1", "cycle: 20, save: before, set: {balls.sand.velocity: [0, 0, -25]}, cycle: 100000",
                       "timestep: 2e-5\n"));
  INFO(end.err);
  CHECK(end.code == 5);
  CHECK(std::filesystem::exists(folder / "scene.out/before.scree"));
}

namespace {

/// The N of "cycle N:".
uint64_t cycle_of(const std::string& message) {
  const std::size_t at = message.find("cycle ");
  return at == std::string::npos ? 0 : std::stoull(message.substr(at + 6));
}

/// Begins from the state of the stop in `folder` without a limit on overlaps.
support::ProgramEnd branch(const TemporaryFolder& folder, const std::string& stages) {
  write_text(folder / "branch.yaml",
             "scree: 1\nstart: {state: scene.out/stopped}\noverlap_limit: 10\ntimestep: 1e-7\n"
             "walls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n"
             "contacts:\n  - {name: ground, between: [balls, [balls, floor]], model: linear, kn: 1e5, ks: 1e5, fric: "
             "0.5}\nrecord:\n  now: {writer: csv, every: 1 cycles, quantities: [cycle, "
             "balls.1.position.z]}\nstages:\n  - go: [" +
                 stages + "]\n");
  return support::scree({"run", "branch.yaml", "--no-color"}, folder.path());
}

}  // namespace

TEST_CASE("a stop saves the state of its cycle, which another scene can begin from") {
  const TemporaryFolder folder;
  const std::string path = folder / "scene.out/stopped.scree";
  const support::ProgramEnd end = run(folder, shot("-25", "cycle: 100000", "timestep: 2e-5\n"));
  INFO(end.err);
  CHECK(end.code == 5);
  CHECK(has(end.err, "stopped.scree"));
  CHECK(has(end.err, "no checkpoint was saved before"));
  REQUIRE(std::filesystem::exists(path));
  const support::ProgramEnd looked = branch(folder, "cycle: 1000");
  INFO(looked.err);
  CHECK(looked.code == 0);
  CHECK(nlohmann::json::parse(read_text(folder / "branch.out/summary.json")).at("cycles") == cycle_of(end.err) + 1000);
  // Its first row is of that cycle, and has ball 1 where failure.csv has it.
  const std::string rows = read_text(folder / "branch.out/now.csv");
  const std::string failure = read_text(folder / "scene.out/failure.csv");
  const std::string row = "\n" + std::to_string(cycle_of(end.err)) + ",";
  const std::size_t at = rows.find(row);
  INFO(rows.substr(0, 400) << failure);
  REQUIRE(at != std::string::npos);
  const std::size_t line_end = rows.find('\n', at + 1), comma = rows.rfind(',', line_end);
  const std::string z = rows.substr(comma + 1, line_end - comma - 1);
  CHECK(z.size() > 3);
  CHECK(has(failure, "," + z + ","));
}

TEST_CASE("a stop after a drift saves the whole of the new time") {
  const TemporaryFolder folder;
  // 0.5 m from the floor and from each other: nothing touches before the ball is too fast for the step.
  const support::ProgramEnd end = run(folder, shot("-600", "cycle: 100000", "timestep: 2e-5\noverlap_limit: 1e9\n"));
  INFO(end.err);
  CHECK(end.code == 5);
  CHECK(has(end.err, "of its radius in one cycle"));
  REQUIRE(std::filesystem::exists(folder / "scene.out/stopped.scree"));
  CHECK(summary(folder).at("cycles") == cycle_of(end.err));
  const support::ProgramEnd looked = branch(folder, "cycle: 10");
  INFO(looked.err);
  CHECK(looked.code == 0);
  CHECK(nlohmann::json::parse(read_text(folder / "branch.out/summary.json")).at("cycles") == cycle_of(end.err) + 10);
}

TEST_CASE("a state that is not finite is not saved, and the checkpoint before it stays") {
  // 1e308 N on a ball of 1e-2 kg is finite; what it does to the velocity is not.
  const TemporaryFolder folder;
  write_text(folder / "scene.yaml",
             shot("-1", "cycle: 20, cycle: 20, apply: {balls: sand, force: [1e308, 1e308, 0]}, cycle: 100"));
  REQUIRE(support::scree({"run", "scene.yaml", "--no-color", "-n", "20"}, folder.path()).code == 0);
  const std::string checkpoint = folder / "scene.out/checkpoint/latest.scree", before = read_text(checkpoint);
  write_text(folder / "scene.out/stopped.scree", "of an earlier stop");
  const support::ProgramEnd end = support::scree({"resume", "scene.out", "--no-color"}, folder.path());
  INFO(end.err);
  CHECK(end.code == 5);
  CHECK(has(end.err, "not a finite number"));
  CHECK(has(end.err, "the broken state is not saved"));
  CHECK(has(end.err, "last good checkpoint: scene.out/checkpoint/latest.scree"));
  CHECK_FALSE(std::filesystem::exists(folder / "scene.out/stopped.scree"));
  CHECK(read_text(checkpoint) == before);
}

TEST_CASE("a ball that crosses half its radius in one cycle is exit 5") {
  const TemporaryFolder folder;
  const support::ProgramEnd end = run(folder, shot("-1e6", "cycle: 100000"));
  INFO(end.err);
  CHECK(end.code == 5);
  CHECK((has(end.err, "of its radius in one cycle") || has(end.err, "of the smaller radius")));
  CHECK(has(end.err, "timestep"));
}

TEST_CASE("a full disk spoils neither the run nor what was written before") {
  const std::string scene = shot("-1", "cycle: 4000, save: end",
                                 "record:\n  history: {writer: csv, every: 1 cycles, quantities: [kinetic_energy]}\n");
  const TemporaryFolder whole;
  REQUIRE(run(whole, scene).code == 0);
  const std::string rows = read_text(whole / "scene.out/history.csv");

  const TemporaryFolder folder;
  write_text(folder / "scene.yaml", scene);
  support::Started started({"run", "scene.yaml", "--no-color"}, folder.path(), 20000);
  const support::ProgramEnd end = started.wait();
  INFO(end.err);
  CHECK(end.code == 6);
  CHECK(has(end.err, "history.csv"));
  CHECK(has(end.err, "File too large"));
  const std::string cut = read_text(folder / "scene.out/history.csv");
  CHECK(cut.size() > 10000);
  CHECK(cut.size() <= 20000);
  CHECK(cut.back() == '\n');
  CHECK(rows.compare(0, cut.size(), cut) == 0);
  // The run itself went to its end, with the same bits.
  CHECK(summary(folder).at("cycles") == 4000);
  CHECK(summary(folder).at("state_hash") == summary(whole).at("state_hash"));
}
