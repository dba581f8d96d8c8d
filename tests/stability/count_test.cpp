// Cases D58 and D59: long counts of cycles, and scenes with next to nothing in them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "stability/lab.hpp"
#include "support/catch.hpp"
#include "support/program.hpp"

using namespace scree::core;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("D58 OK: time is a count of cycles, within one unit in the last place after 1e12 of them") {
  Clock clock;
  clock.dt = 1e-12;
  clock.cycle = 1000000000000;
  CHECK(std::fabs(clock.time() - 1.0) <= std::numeric_limits<double>::epsilon());
  // A change of the step goes on from the time that is reached.
  clock.change_step(1e-3);
  clock.cycle += 1000;
  CHECK(std::fabs(clock.time() - 2.0) <= 2 * std::numeric_limits<double>::epsilon());
  lab::measured("D58", "1e12 cycles of 1e-12 s and 1000 of 1 ms: time differs from 2 s by " +
                           lab::number(clock.time() - 2.0) + " s");
}

TEST_CASE("D58 OK: cycle counters pass 2^31, 2^32 and 1e12 without a trace") {
  lab::Lab here;
  uint64_t hash = 0;
  for (const uint64_t start :
       {uint64_t{0}, (uint64_t{1} << 31) - 100, (uint64_t{1} << 32) - 100, uint64_t{1000000000000}}) {
    const auto simulation = here.make(lab::flow);
    simulation->engine.clock.cycle = start;
    simulation->engine.clock.base_cycle = start;
    lab::run(*simulation, 400);
    CHECK(simulation->engine.clock.cycle == start + 400);
    INFO("from cycle " << start);
    if (start == 0) hash = simulation->engine.state_hash();
    CHECK(simulation->engine.state_hash() == hash);
  }
}

TEST_CASE("D59 OK: one ball, no ball and one wall alone run and leave valid files") {
  const TemporaryFolder folder;
  const std::string head = "scree: 1\ntimestep: 1e-4\n",
                    tail =
                        "stages:\n  - go: [cycle: 200]\n"
                        "record:\n  history: {writer: csv, every: 100 cycles, quantities: [kinetic_energy]}\n"
                        "  view: {writer: vtk, every: 100 cycles, fields: [velocity]}\n";
  const std::string wall = "walls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n";
  const auto set = [](const std::string& rows) {
    return rows + "balls:\n  some: {generator: file, path: " + (rows.empty() ? "none" : "one") +
           ".csv, density: 2500}\ncontacts:\n  - {name: all, between: [balls, [balls, walls]], model: linear, kn: 1e3, "
           "ks: 0}\n";
  };
  write_text(folder / "none.csv", "x,y,z,radius\n");
  write_text(folder / "one.csv", "x,y,z,radius\n0,0,0.5,0.01\n");
  struct Case {
    std::string name, text, balls;
  };
  const std::vector<Case> cases = {{"wall", head + wall + tail, "\"balls\": 0"},
                                   {"none", head + set("") + tail, "\"balls\": 0"},
                                   {"one", head + set(wall) + tail, "\"balls\": 1"}};
  for (const Case& one : cases) {
    INFO(one.name);
    write_text(folder / (one.name + ".yaml"), one.text);
    const support::ProgramEnd end = support::scree({"run", one.name + ".yaml"}, folder.path());
    INFO(end.err);
    REQUIRE(end.code == 0);
    const std::string out = folder / (one.name + ".out");
    const std::string summary = read_text(out + "/summary.json");
    CHECK(has(summary, one.balls));
    CHECK(has(summary, "\"cycles\": 200"));
    CHECK(has(read_text(out + "/history.csv"), "cycle,time,kinetic_energy\n0,0,0\n100,"));
    CHECK(has(read_text(out + "/view.pvd"), "</VTKFile>"));
  }
  lab::measured("D59", "one wall, no ball, one ball: exit 0, 200 cycles, history and view are valid");
}

TEST_CASE("D59 REJECT: a ball for which nothing limits the step is refused with the key to give") {
  const TemporaryFolder folder;
  write_text(folder / "one.csv", "x,y,z,radius\n0,0,0.5,0.01\n");
  write_text(folder / "one.yaml",
             "scree: 1\nballs:\n  some: {generator: file, path: one.csv, density: 2500}\n"
             "contacts:\n  - {between: [some, some], model: linear, kn: 0, ks: 0}\nstages:\n  - go: [cycle: 5]\n");
  const support::ProgramEnd end = support::scree({"run", "one.yaml"}, folder.path());
  CHECK(end.code == 3);
  CHECK(has(end.err, "nothing limits the step"));
  CHECK(has(end.err, "give 'timestep'"));
}

TEST_CASE("D59 OK: without a ball the step follows the action and its records, and walls move on time") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& name, const std::string& text) {
    write_text(folder / (name + ".yaml"), "scree: 1\n" + text);
    const support::ProgramEnd end = support::scree({"run", name + ".yaml"}, folder.path());
    INFO(end.err);
    CHECK(end.code == 0);
    return nlohmann::json::parse(read_text(folder / (name + ".out/summary.json")));
  };
  const std::string lid =
      "walls:\n  lid: {wall: plane, point: [0, 0, 1], normal: [0, 0, -1], velocity: [0, 0, -0.1]}\n";
  // 0.5 s in 100 cycles; the lid has moved by 0.05 m then.
  const auto plain = run("plain", lid +
                                      "quantities: {height: walls.lid.displacement.z}\n"
                                      "stages:\n  - press: [run: 0.5 s]\n");
  CHECK(plain.at("cycles") == 100);
  CHECK(plain.at("model_time").get<double>() == Approx(0.5).epsilon(1e-12));
  CHECK(plain.at("quantities").at("height").get<double>() == Approx(-0.05).epsilon(1e-12));
  // A record that wants more gets it: 0, 1, ... 500 ms.
  run("recorded", lid +
                      "stages:\n  - press: [run: 0.5 s]\n"
                      "record: {curve: {writer: csv, every: 1 ms, quantities: [walls.lid.position.z]}}\n");
  const std::string rows = read_text(folder / "recorded.out/curve.csv");
  CHECK(std::count(rows.begin(), rows.end(), '\n') == 1 + 501);
  // Cycles alone are 1 ms each.
  CHECK(run("counted", lid + "stages:\n  - press: [cycle: 20]\n").at("model_time").get<double>() ==
        Approx(0.02).epsilon(1e-12));
  // Balls that come later bring their own step.
  const auto later = run("later",
                         "walls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\nstages:\n"
                         "  - wait: [run: 1 s]\n  - fill:\n    - add:\n"
                         "        balls: {sand: {generator: lattice, kind: sc, radius: 10 mm, density: 2600,\n"
                         "                       box: [[0, 0, 0], [40 mm, 40 mm, 40 mm]]}}\n"
                         "        contacts: [{between: [sand, [sand, floor]], model: linear, kn: 1e5, ks: 0}]\n"
                         "    - cycle: 20\n");
  CHECK(later.at("cycles") == 120);
  CHECK(later.at("timestep").at("used").get<double>() < 1e-3);
  CHECK(later.at("timestep").at("used").get<double>() < later.at("timestep").at("certified").get<double>());
}

TEST_CASE("D59 OK: a scene may begin without balls and get them from a stage") {
  const TemporaryFolder folder;
  write_text(
      folder / "later.yaml",
      "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n"
      "stages:\n  - fill:\n"
      "    - add:\n"
      "        balls: {sand: {generator: lattice, kind: sc, radius: 10 mm, density: 2600, velocity: [0, 0, -1],\n"
      "                       box: [[0, 0, 0], [40 mm, 40 mm, 40 mm]]}}\n"
      "        contacts: [{name: all, between: [sand, [sand, floor]], model: linear, kn: 1e5, ks: 0}]\n"
      "    - cycle: 20\n");
  const support::ProgramEnd end = support::scree({"run", "later.yaml"}, folder.path());
  INFO(end.err);
  CHECK(end.code == 0);
  CHECK(has(read_text(folder / "later.out/summary.json"), "\"balls\": 8"));
}

TEST_CASE("balls are counted: a run stops at the rebuild after an id was overwritten") {
  lab::Lab here;
  const auto simulation = here.make(lab::flow);
  lab::run(*simulation, 100);
  ++simulation->engine.balls.id()[3];
  std::string message;
  try {
    lab::run(*simulation, 1000);
  } catch (const NumericalStop& stop) {
    message = stop.what();
  }
  INFO(message);
  CHECK(has(message, "their ids are not all those that were"));
  CHECK(has(message, "scree vet"));
}
