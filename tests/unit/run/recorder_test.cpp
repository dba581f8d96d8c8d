#include "core/run/recorder.hpp"

#include <fcntl.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/run/condition.hpp"
#include "support/catch.hpp"
#include "support/simulated.hpp"

using namespace scree::core;
using support::Simulated;

namespace {

std::string scene_of(const std::string& step, const std::string& more) {
  return "scree: 1\ntimestep: " + step +
         "\nballs: {one: {generator: file, path: balls.csv, density: 1000}}\n"
         "contacts: [{name: none, between: [one, one], model: none}]\n"
         "processes: {gravity: {process: gravity, acceleration: [0, 0, -10]}}\n" +
         more;
}
const char* const thrown = "x,y,z,r,vx,vy,vz\n0,0,0,0.01,0,0,1\n";

struct Output {
  explicit Output(const std::string& path)
      : files(Fd(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)), path) {}
  OutputFiles files;
};

void run_to(Simulation& simulation, Recorder& recorder, uint64_t cycle) {
  for (;;) {
    simulation.engine.forces();
    if (recorder.due()) recorder.write();
    if (simulation.engine.clock.cycle >= cycle) return;
    simulation.engine.advance();
  }
}

std::vector<std::string> first_column(const std::string& path) {
  std::istringstream stream(read_text(path));
  std::vector<std::string> cells;
  for (std::string line; std::getline(stream, line);) cells.push_back(line.substr(0, line.find(',')));
  return cells;
}

std::string refusal(const std::string& record) {
  Simulated scene(scene_of("1 ms", "record: {r: {" + record + ", every: 1 ms}}\n"), thrown);
  Quantities quantities(*scene);
  Output output(scene.folder().path());
  try {
    Recorder recorder(*scene, quantities, scene->scene.record[0], output.files);
  } catch (const SceneErrors& errors) {
    return errors.what();
  }
  return "";
}

}  // namespace

TEST_CASE("recorder: frames lie on the cycle nearest to each multiple of the interval, without drift", "[run]") {
  Simulated scene(
      scene_of("0.3 ms", "record: {h: {writer: csv, every: 1 ms, quantities: [balls.1.position.z, time]}}\n"), thrown);
  Quantities quantities(*scene);
  Output output(scene.folder().path());
  Recorder recorder(*scene, quantities, scene->scene.record[0], output.files);
  run_to(*scene, recorder, 22);
  recorder.finish();
  recorder.finish();
  output.files.flush();
  // ceil(k/0.3 - 1/2) for k = 0 ... 6, and the end.
  CHECK(first_column(scene.folder() / "h.csv") ==
        std::vector<std::string>{"cycle", "0", "3", "7", "10", "13", "17", "20", "22"});
  CHECK(recorder.error().empty());
  CHECK(read_text(scene.folder() / "h.csv").starts_with("cycle,time,balls.1.position.z\n0,0,0\n"));
}

TEST_CASE("recorder: after a resume no row is missing and none comes twice", "[run]") {
  const std::string text = scene_of("1 ms", "record: {h: {writer: csv, every: 4 cycles, quantities: [cycle]}}\n");
  Simulated scene(text, thrown);
  Quantities quantities(*scene);
  Output output(scene.folder().path());
  {
    Recorder recorder(*scene, quantities, scene->scene.record[0], output.files);
    run_to(*scene, recorder, 8);
    ArchiveWriter archive(scene.folder() / "state");
    recorder.save(archive, "record/h");
    REQUIRE(archive.commit());
  }
  Recorder recorder(*scene, quantities, scene->scene.record[0], output.files);
  recorder.load(ArchiveReader(scene.folder() / "state"), "record/h");
  CHECK_FALSE(recorder.due());
  run_to(*scene, recorder, 12);
  recorder.finish();  // the last row is there already
  output.files.flush();
  CHECK(first_column(scene.folder() / "h.csv") == std::vector<std::string>{"cycle", "0", "4", "8", "12"});
}

TEST_CASE("recorder: fields and quantities that would not be shown are refused", "[run]") {
  CHECK(refusal("writer: vtk, fields: [velocity, contact.force]") == "");
  CHECK(refusal("writer: vtk, fields: [velocty]").find("did you mean 'velocity'?") != std::string::npos);
  CHECK(refusal("writer: vtk, fields: [normal_force]").find("did you mean 'contact.normal_force'?") !=
        std::string::npos);
  CHECK(refusal("writer: vtk, fields: [spin, spin]").find("named twice") != std::string::npos);
  CHECK(refusal("writer: csv, fields: [velocity]").find("'csv' shows no fields of balls") != std::string::npos);
  CHECK(refusal("writer: vtk, quantities: [time]").find("'vtk' shows no quantities") != std::string::npos);
}

TEST_CASE("recorder: a file that cannot be written silences its recorder, and that is told", "[run]") {
  Simulated scene(scene_of("1 ms", "record: {h: {writer: csv, every: 1 cycles, quantities: [time]}}\n"), thrown);
  Quantities quantities(*scene);
  Output output(scene.folder().path());
  std::filesystem::create_directory(scene.folder() / "h.csv");
  std::string warned;
  scene->warn = [&](const std::string& text) { warned += text; };
  Recorder recorder(*scene, quantities, scene->scene.record[0], output.files);
  run_to(*scene, recorder, 3);
  recorder.finish();
  CHECK(recorder.error().find("h.csv") != std::string::npos);
  CHECK(warned.find("goes on without it") != std::string::npos);
  CHECK(recorder.frames() == 0);
}

TEST_CASE("frame: balls in id order, contacts in pair order, walls in the scene's frame", "[run]") {
  Simulated scene(
      "scree: 1\n"
      "walls: {floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}}\n"
      "balls: {grains: {generator: file, path: balls.csv, density: 1000}}\n"
      "contacts: [{name: all, between: [balls, [balls, walls]], model: linear, kn: 1e4, ks: 0}]\n",
      "id,x,y,z,radius\n7,0,0,0.095,0.1\n3,0.17,0,0.095,0.08\n9,2,0,1,0.1\n");
  Quantities quantities(*scene);
  scene->engine.report_wanted = true;
  scene->engine.forces();
  FrameContent content;
  content.wants = SCREE_WANTS_BALLS | SCREE_WANTS_CONTACTS | SCREE_WANTS_WALLS | SCREE_WANTS_QUANTITIES;
  content.fields = chosen_fields({{"contacts", {}}, {"density", {}}, {"contact.force", {}}}, "r");
  content.quantities = {std::make_shared<Formula>("2*balls.count", std::map<std::string, double>{}, Place{})};
  Wall& wall = scene->engine.walls[0];
  const double s = std::sqrt(0.5);
  for (const bool turned : {false, true}) {
    wall.centre = {0, 0, turned ? 0.0 : 0.25};
    if (turned) wall.turn = {s, 0, s, 0};  // a quarter about y: the plane z = 0 becomes x = 0
    ShownBox box;
    box.follow(scene->engine);
    const Frame built(*scene, quantities, content, 4, box);
    const scree_frame& frame = built.abi();
    REQUIRE(frame.ball_count == 3);
    CHECK(std::vector<uint64_t>(frame.ball_id, frame.ball_id + 3) == std::vector<uint64_t>{3, 7, 9});
    CHECK(frame.x[0] == 0.17);
    CHECK(frame.radius[2] == 0.1);
    REQUIRE(frame.ball_array_count == 2);
    CHECK(std::vector<double>(frame.ball_arrays[0].component[0], frame.ball_arrays[0].component[0] + 3) ==
          std::vector<double>{1, 2, 0});
    CHECK(frame.ball_arrays[1].component[0][1] == Approx(1000).epsilon(1e-12));
    REQUIRE(frame.contact_count == 2);
    CHECK(frame.contact_id1[0] == 3);
    CHECK(frame.contact_id2[0] == 7);
    CHECK(frame.contact_id1[1] == 7);
    CHECK(frame.contact_id2[1] == 0);
    CHECK(frame.contact_arrays[0].component[0][0] == Approx(-100));
    CHECK(frame.contact_arrays[0].component[2][1] == Approx(-50));
    CHECK(frame.contact_x[0] == Approx(0.095));  // half way between the surfaces, 0.09 and 0.1
    CHECK(frame.quantities[0] == 6);
    CHECK(std::string(frame.quantity_names[0]) == "2*balls.count");
    CHECK(frame.index == 4);
    REQUIRE(frame.wall_count == 1);
    REQUIRE(frame.walls[0].polygon_count == 1);
    const scree_polygon& polygon = frame.walls[0].polygons[0];
    CHECK(polygon.corners == 4);
    for (uint32_t k = 0; k < polygon.corners; ++k)
      CHECK(polygon.xyz[3 * k + (turned ? 0 : 2)] == Approx(turned ? 0 : 0.25).margin(1e-12));
  }
}

TEST_CASE("condition: a fall to half of the largest is met at the first tested cycle after it", "[run]") {
  const std::string tests = "stages: [up: [run: {until: {balls.1.position.z: {falls_to: 50 %}}, at_most: 1 s}]]\n";
  Simulated scene(scene_of("1 ms", tests), thrown);
  Quantities quantities(*scene);
  Condition condition(*scene, quantities, std::get<RunAction>(scene->scene.stages[0].actions[0].what));
  std::vector<uint64_t> tested;
  std::optional<std::size_t> met;
  while (!met && scene->engine.clock.cycle < 1000) {
    scene->engine.forces();
    if (condition.due()) {
      tested.push_back(scene->engine.clock.cycle);
      met = condition.met();
    }
    scene->engine.advance();
  }
  // t - 5 t^2 is 0.05 at its top, at 0.1 s, and falls to half of it at (1 + sqrt(1/2))/10 = 0.1707 s.
  REQUIRE(met == 0u);
  CHECK(tested.front() == 10);
  CHECK(tested.back() == 180);
  CHECK(scene->position.extreme[0] == Approx(0.05).epsilon(1e-9));
}

TEST_CASE("condition: rises, bounds, and numbers that are none", "[run]") {
  Simulated scene(scene_of("1 ms",
                           "quantities: {none: {mean: x, where: z > 100}}\n"
                           "stages: [s: [run: {until: {none: {below: 1}, time: {rises_to: 3}, "
                           "cycle: {above: 35}}, at_most: 1 s}]]\n"),
                  thrown);
  Quantities quantities(*scene);
  Condition condition(*scene, quantities, std::get<RunAction>(scene->scene.stages[0].actions[0].what));
  std::vector<std::optional<std::size_t>> met;
  while (scene->engine.clock.cycle <= 40) {
    scene->engine.forces();
    if (condition.due()) met.push_back(condition.met());
    scene->engine.advance();
  }
  // The smallest time seen is that of cycle 10, so three times it is reached at cycle 30; the first of those met wins.
  CHECK(met == std::vector<std::optional<std::size_t>>{std::nullopt, std::nullopt, 1u, 1u});
}

TEST_CASE("frame: unbounded walls keep their size while balls move, and grow by a margin when one leaves", "[run]") {
  Simulated scene(scene_of("1 ms", ""), "x,y,z,radius\n0,0,0,0.1\n1,1,1,0.1\n");
  Balls& balls = scene->engine.balls;
  ShownBox box;
  box.follow(scene->engine);
  // From -0.1 to 1.1, and a tenth of 1.2 on each side.
  const auto low = box.low(), high = box.high();
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(low[c] == Approx(-0.22));
    CHECK(high[c] == Approx(1.22));
  }
  balls[Column::x][0] = 0.3;
  balls[Column::z][1] = 1.11;
  box.follow(scene->engine);
  CHECK(box.low() == low);
  CHECK(box.high() == high);
  // 1.9 + 0.1 is outside; the edge is 2.0 - 0.2 = 1.8 long now, and 0.18 is added on this side alone.
  balls[Column::x][1] = 1.9;
  box.follow(scene->engine);
  CHECK(box.high()[0] == Approx(2.18));
  CHECK(box.low() == low);
  CHECK(box.high()[1] == high[1]);
  // What a checkpoint keeps goes on in the same way, also when the balls have come back together.
  ShownBox resumed;
  resumed.restore(box.saved());
  balls[Column::x][1] = 1.0;
  resumed.follow(scene->engine);
  CHECK(resumed.low() == box.low());
  CHECK(resumed.high() == box.high());
  ShownBox nothing;
  nothing.restore(ShownBox().saved());
  nothing.follow(scene->engine);
  CHECK(nothing.high()[1] == Approx(1.1 + 0.1 * 1.31));
}
