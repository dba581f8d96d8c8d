// Balls that are bonded to walls: which get a bond, what it carries, how it breaks, and that it goes along with its
// wall.
#include <fcntl.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/run/event_log.hpp"
#include "support/measure.hpp"
#include "support/scene_run.hpp"

using namespace support;
using scree::core::Action;
using scree::core::Column;

namespace {

constexpr double radius = 0.01, area = std::numbers::pi * radius * radius;
constexpr double inertia = std::numbers::pi * radius * radius * radius * radius / 4;
constexpr double mass = 4.0 / 3.0 * std::numbers::pi * 1e-6 * 2500;
constexpr double kn = 3e6, ks = 1e6;  ///< of the disc, N/m

const std::string floor_wall = "{wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}";

/// A disc of cement alone: the springs beside it have no stiffness.
std::string disc(const std::string& strength) {
  return "model: parallel_bond, kn: 0, ks: 0, fric: 0, pb_kn: " + digits(kn / area) + ", pb_ks: " + digits(ks / area) +
         ", " + strength;
}
const std::string endless = "pb_ten: .inf, pb_coh: .inf";

/// Balls of 10 mm and one wall under the rule `glue`; balls do not meet each other.
std::string scene(const std::string& wall, const std::string& law, const std::string& stages,
                  const std::string& more = "timestep: 1e-6\n") {
  return "scree: 1\nwalls:\n  plate: " + wall +
         "\nballs:\n  row: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n"
         "  - {name: glue, between: [row, plate], " +
         law + "}\n  - {name: balls, between: [row, row], model: none}\n" + more + "stages:\n" + stages;
}

void act(SceneRun& run, std::size_t stage) {
  for (const Action& action : run.simulation().scene.stages.at(stage).actions) run.simulation().edit(action);
}

double wall_force(SceneRun& run, const std::string& axis) { return run.value("walls.plate.force." + axis); }

}  // namespace

TEST_CASE("a bond action bonds balls to the walls that it names, or that its rule is for") {
  const auto bonded = [](const std::string& between, const std::string& action) {
    SceneRun run(
        "scree: 1\ntimestep: 1e-6\nwalls:\n  left: {wall: plane, point: [0, 0, 0], normal: [1, 0, 0]}\n  floor: " +
            floor_wall +
            "\nballs:\n  row: {generator: file, path: balls.csv, density: 2500}\ncontacts:\n"
            "  - {name: glue, between: " +
            between + ", " + disc(endless) +
            "}\n  - {name: rest, between: [balls, [balls, walls]], model: none}\nstages:\n  - one: [bond: {" + action +
            "}]\n",
        // The first touches both walls, the others the floor but for 2 um and 2 mm; they touch each other in turn.
        "x,y,z,radius,group\n0.01,0,0.01,0.01,a\n0.03,0,0.010002,0.01,a\n0.05,0,0.012,0.01,b\n");
    act(run, 0);
    run.step();
    return run.value("bonds.count");
  };
  const std::string walls = "[row, walls]", all = "[row, [row, walls]]";
  CHECK(bonded(walls, "rule: glue") == 2);
  CHECK(bonded(walls, "rule: glue, gap: 5 um") == 3);
  CHECK(bonded(walls, "rule: glue, gap: 3 mm") == 4);
  CHECK(bonded(walls, "rule: glue, gap: 30 mm") == 5);  // farther than the lists reach
  CHECK(bonded(walls, "rule: glue, gap: 30 mm, between: [floor, row]") == 3);
  CHECK(bonded(walls, "rule: glue, gap: 30 mm, between: [[left, floor], row.b]") == 1);
  CHECK(bonded("[row, left]", "rule: glue, gap: 3 mm, between: [row, walls]") == 1);
  // A rule that is between balls too glues them to the vessel only where it is told to.
  CHECK(bonded(all, "rule: glue, gap: 5 um") == 1);
  CHECK(bonded(all, "rule: glue, gap: 5 um, between: [balls, balls]") == 1);
  CHECK(bonded(all, "rule: glue, gap: 5 um, between: [balls, walls]") == 3);
  CHECK(bonded(all, "rule: glue, gap: 5 um, between: [balls, [balls, floor]]") == 3);
}

TEST_CASE("a bond with a wall begins without force, and a wall has it once") {
  SceneRun run(scene(floor_wall, disc(endless), "  - one: [bond: {rule: glue, gap: 1 mm}]\n"),
               "x,y,z,radius\n0,0,0.0105,0.01\n0.03,0,0.00999,0.01\n");
  act(run, 0);
  act(run, 0);
  CHECK(run.value("bonds.count") == 2);
  CHECK(run.value("contacts.walls") == 2);
  run.step(1000);
  for (uint64_t id = 1; id <= 2; ++id)
    for (double v : run.ball(id).velocity) CHECK(v == 0);
  CHECK(run.value("contacts.1.plate.overlap") == Approx(-5e-4).epsilon(1e-9));
}

TEST_CASE("a ball is pulled off a wall by the strength times the area of the disc") {
  constexpr double strength = 1e6, speed = 0.1, step = 1e-6;
  for (const double width : {1.0, 0.5}) {
    const double part = width * width * area;
    SceneRun run(scene(floor_wall,
                       "model: parallel_bond, kn: 1e6, ks: 1e6, fric: 0.5, pb_kn: 1e10, pb_ks: 1e10, pb_coh: .inf, "
                       "pb_ten: 1e6, pb_rmul: " +
                           digits(width),
                       "  - pull: [bond: {rule: glue}, fix: {balls: row}, set: {balls.row.velocity: [0, 0, " +
                           digits(speed) + "]}]\n",
                       "timestep: 1e-6\nprocesses:\n  energy: {process: energy_ledger}\n"),
                 "x,y,z,radius\n0.02,0,0.01,0.01\n");
    act(run, 0);
    double most = 0;
    while (run.value("bonds.broken") == 0 && run.time() < 0.01) {
      most = std::max(most, wall_force(run, "z"));
      run.step();
    }
    REQUIRE(run.engine().broken.size() == 1);
    const auto& broke = run.engine().broken[0];
    // Each cycle stretches the bond by v dt: that is how far below the strength the last force may lie.
    const double increment = 1e10 * part * speed * step;
    Measure measure("PB-W, width " + digits(width),
                    "largest pull sigma_c pi (lambda R)^2 of a parallel bond with a wall; energy F^2/(2 k)");
    measure.check("pull, N", most, strength * part, 1.01 * increment);
    measure.check("energy of the break, J", broke.what.energy, strength * strength * part / 2e10,
                  strength * speed * step * part);
    measure.check("share that is not accounted for", run.value("energy.residual_share"), 0, 1e-6);
    CHECK(broke.what.ids == scree::core::IdPair{1, 0});
    CHECK(broke.what.wall == 0);
    CHECK(broke.what.mode == 1);
    CHECK(broke.cycle == run.engine().clock.cycle);
    // In the middle between the surface of the ball and the wall.
    CHECK(broke.what.point[0] == Approx(0.02).epsilon(1e-12));
    CHECK(broke.what.point[2] == Approx(0.5 * strength / 1e10).epsilon(1e-2));
    CHECK(run.value("bonds.broken.tension") == 1);
    CHECK(run.value("bonds.count") == 0);
    CHECK(run.value("contacts.walls") == 0);
    CHECK(wall_force(run, "z") == 0);
    measure.check("work of the motion that was prescribed, J", run.value("energy.boundary"),
                  strength * strength * part / 2e10, 2 * strength * speed * step * part);
  }
}

TEST_CASE("a bond with a wall swings in its four ways with the frequencies of its springs") {
  // Along: k/m. Twist: kt/I. Across: two degrees of freedom u, w, with ks (u + R w) and kb w.
  const double spin_inertia = 0.4 * mass * radius * radius;
  const double kb = kn / area * inertia, kt = ks / area * 2 * inertia;
  Measure measure("PB-W, swing", "eigenfrequencies of a sphere on a disc of springs kn, ks, kb, kt at its surface");
  const auto frequency = [&](const std::string& start, Column column) {
    SceneRun run(scene(floor_wall, disc(endless), "  - one: [bond: {rule: glue}]\n", "timestep: 2e-7\n"),
                 "x,y,z,radius,vx,vy,vz,wx,wy,wz\n0,0,0.01,0.01," + start + "\n");
    run.engine().sums_wanted = run.engine().report_wanted = false;
    act(run, 0);
    // Twenty periods, by the first and last passage of the speed through zero.
    double first = 0, last = 0, before = run.engine().balls[column][0];
    int passages = 0;
    while (passages < 41) {
      run.step();
      const double now = run.engine().balls[column][0];
      if (before * now < 0) {
        last = run.time() - 2e-7 * now / (now - before);
        if (passages++ == 0) first = last;
      }
      before = now;
    }
    return std::numbers::pi * 40 / (last - first);
  };
  const double along = std::sqrt(kn / mass), twist = std::sqrt(kt / spin_inertia);
  measure.check("along, rad/s", frequency("0,0,1e-3,0,0,0", Column::vz), along, 1e-4 * along);
  measure.check("twist, rad/s", frequency("0,0,0,0,0,0.1", Column::wz), twist, 1e-4 * twist);
  // Eigenvector of the slower mode: (u, sqrt(I/m) w) of [[a, b], [b, c]].
  const double a = ks / mass, c = (ks * radius * radius + kb) / spin_inertia,
               b = ks * radius / std::sqrt(mass * spin_inertia);
  const double slow = 0.5 * (a + c) - std::sqrt(0.25 * (a - c) * (a - c) + b * b);
  // The contact point below a ball that turns by w about y moves by -R w along x.
  const double w = -(slow - a) / b * std::sqrt(mass / spin_inertia) * 1e-3;
  measure.check("across, slow mode, rad/s", frequency("1e-3,0,0,0," + digits(w) + ",0", Column::vx), std::sqrt(slow),
                1e-3 * std::sqrt(slow));
}

TEST_CASE("the certified step counts a bond with a wall exactly, bending and twist too") {
  const double spin_inertia = 0.4 * mass * radius * radius;
  for (const double wide : {0.1, 1.0, 3.0}) {
    // The disc's area grows with its width; the springs per area shrink, so that kn and ks stay.
    const double kb = kn * wide * wide * radius * radius / 4, kt = ks * wide * wide * radius * radius / 2;
    const double a = ks / mass, c = (ks * radius * radius + kb) / spin_inertia,
                 b = ks * radius / std::sqrt(mass * spin_inertia);
    const double fast = 0.5 * (a + c) + std::sqrt(0.25 * (a - c) * (a - c) + b * b);
    const double limit = 2 / std::sqrt(std::max({fast, kt / spin_inertia, kn / mass}));
    SceneRun run(
        scene(floor_wall,
              "model: parallel_bond, kn: 0, ks: 0, fric: 0, " + endless + ", pb_rmul: " + digits(wide) +
                  ", pb_kn: " + digits(kn / area / wide / wide) + ", pb_ks: " + digits(ks / area / wide / wide),
              "  - one: [bond: {rule: glue}]\n", ""),
        "x,y,z,radius,wx,wy,wz\n0,0,0.01,0.01,0,1e-3,0\n");
    act(run, 0);
    const auto& bound = run.engine().step.bound();
    INFO("width " << wide);
    CHECK(bound.step <= limit);
    CHECK(bound.step == Approx(limit).epsilon(1e-3));
    CHECK(bound.wall == "plate");
    // With the whole limit it would be on the edge; the step that is taken keeps it bounded.
    run.step(20000);
    CHECK(std::abs(run.ball(1).spin[1]) < 1e-2);
  }
}

TEST_CASE("a bonded ball goes along with a wall that moves and turns, and its loads turn too") {
  // Ball and wall turn together about z, with the acceleration w^2 r carried by the bond: across it on a turntable,
  // along it on a wall that stands. It acts at once, so the ball swings between nothing and twice the deflection at
  // rest; forces that stayed where they were would let it fly off within a turn.
  struct Case {
    std::string wall, ball;
    double softest;
  };
  const double kb = kn / area * inertia, across = 1 / (1 / ks + radius * radius / kb);
  constexpr double spin = 20, way = 0.2;
  const std::vector<Case> cases = {
      {"{wall: plane, point: [0, 0, 0], normal: [0, 0, 1], spin: [0, 0, 20], velocity: [0.3, 0, -0.1]}",
       "0.2,0,0.01,0.01,0.3,4,-0.1,0,0,20", across},
      {"{wall: plane, point: [0.21, 0, 0], normal: [-1, 0, 0], spin: [0, 0, 20], velocity: [0.3, 0, -0.1]}",
       "0.2,0,0.01,0.01,0.3,4,-0.1,0,0,20", kn}};
  for (const Case& one : cases) {
    SceneRun run(scene(one.wall, disc(endless), "  - one: [bond: {rule: glue}]\n", "timestep: 4e-6\n"),
                 "x,y,z,radius,vx,vy,vz,wx,wy,wz\n" + one.ball + "\n");
    run.engine().sums_wanted = run.engine().report_wanted = false;
    act(run, 0);
    const double deflection = mass * spin * spin * way / one.softest;
    double farthest = 0, turned = 0;
    while (run.time() < 2 * 2 * std::numbers::pi / spin) {
      run.step(20);
      const double t = run.time(), angle = spin * t;
      const auto& balls = run.engine().balls;
      const double x = 0.3 * t + way * std::cos(angle), y = way * std::sin(angle), z = 0.01 - 0.1 * t;
      farthest =
          std::max(farthest, std::hypot(balls[Column::x][0] - x, balls[Column::y][0] - y, balls[Column::z][0] - z));
      turned = std::max(turned, std::abs(balls[Column::wz][0] - spin));
    }
    Measure measure("PB-W, turn",
                    "twice the deflection m w^2 r/k of a spring under a sudden load, in the wall's frame");
    measure.check("farthest from the place on the wall over m w^2 r/k", farthest / deflection, 2, 0.1);
    CHECK(turned < 0.05 * spin);
    CHECK(run.value("bonds.count") == 1);
  }
}

TEST_CASE("a bond with a wall holds over a gap of many radii") {
  SceneRun run(scene(floor_wall, "model: contact_bond, kn: 1e3, ks: 1e3, lin_mode: 1, cb_tenf: .inf, cb_shearf: .inf",
                     "  - one: [bond: {rule: glue, gap: 10 mm}]\n", "timestep: 1e-5\n"),
               "x,y,z,radius,vx,vy,vz\n0,0,0.02,0.01,0,0,20\n1,0,0.5,0.01,0,0,0\n");
  act(run, 0);
  REQUIRE(run.value("bonds.count") == 1);
  const uint64_t before = run.engine().rebuilds();
  double farthest = 0;
  const double quarter = std::numbers::pi / 2 * std::sqrt(mass / 1e3);
  while (run.time() < 1.5 * quarter) {
    run.step(10);
    farthest = std::max(farthest, run.ball(1).position[2]);
  }
  CHECK(run.engine().rebuilds() > before);
  CHECK(run.value("bonds.count") == 1);
  CHECK(run.value("contacts.1.plate.overlap") < -0.05);
  Measure measure("PB-W, far", "amplitude v sqrt(m/k) of a ball on a spring (energy conservation)");
  measure.check("largest distance", farthest, 0.02 + 20 * std::sqrt(mass / 1e3), 1e-3);
}

TEST_CASE("a bond whose ball slides off its patch keeps to the plane of the patch") {
  // Up along the left side of a box without top, past its rim, then far beyond: only shear grows.
  const std::string box = "{wall: box, low: [0, 0, 0], high: [0.5, 0.5, 0.1], open: [top]}";
  SceneRun run(scene(box, disc(endless),
                     "  - up: [bond: {rule: glue}, fix: {balls: row}, set: {balls.row.velocity: [0, 0, 1]}]\n"
                     "  - off: [set: {balls.row.velocity: [1, 0, 0]}]\n",
                     "timestep: 1e-5\n"),
               "x,y,z,radius\n0.01,0.25,0.095,0.01\n");
  act(run, 0);
  for (int part = 0; part < 10; ++part) {
    run.step(500);
    const double slid = run.ball(1).position[2] - 0.095;
    CHECK(wall_force(run, "x") == Approx(0).margin(1e-6 * ks * slid));
    CHECK(wall_force(run, "z") == Approx(ks * slid).epsilon(1e-9));
    CHECK(run.value("bonds.count") == 1);
  }
  act(run, 1);
  run.step(1000);
  CHECK(wall_force(run, "x") == Approx(kn * 0.01).epsilon(1e-6));
  CHECK(wall_force(run, "z") == Approx(ks * 0.05).epsilon(1e-6));
}

TEST_CASE("a bond with a wall that broke leaves a contact, and is made again only where that is asked for") {
  // Torn along the floor while it is pressed: the springs beside the disc go on, and slip.
  const std::string law =
      "model: parallel_bond, kn: 1e6, ks: 1e6, fric: 0.5, pb_kn: 1e10, pb_ks: 1e10, pb_ten: .inf, pb_coh: 1e6";
  SceneRun run(scene(floor_wall, law,
                     "  - shear: [bond: {rule: glue}, fix: {balls: row}, set: {balls.row.velocity: [0.1, 0, 0]}]\n"
                     "  - first_only: [bond: {rule: glue, again: false}]\n  - anew: [bond: {rule: glue}]\n"),
               "x,y,z,radius\n0,0,0.0099,0.01\n");
  act(run, 0);
  while (run.value("bonds.broken") == 0 && run.time() < 1) run.step();
  CHECK(run.value("bonds.broken.shear") == 1);
  CHECK(run.value("bonds.count") == 0);
  CHECK(run.value("contacts.walls") == 1);
  // The pass of the break and the next ones: 100 N of push, half of it as friction.
  for (int k = 0; k < 3; ++k) {
    CHECK(wall_force(run, "x") == Approx(50).epsilon(1e-9));
    CHECK(wall_force(run, "z") == Approx(-100).epsilon(1e-9));
    CHECK(run.value("contacts.sliding") == 1);
    run.step();
  }
  act(run, 1);
  CHECK(run.value("bonds.count") == 0);
  act(run, 2);
  CHECK(run.value("bonds.count") == 1);
  CHECK(wall_force(run, "x") == Approx(50).epsilon(1e-9));
}

TEST_CASE("the process bonding glues balls to a wall as they come near") {
  SceneRun run(scene(floor_wall, disc(endless), "  - go: [cycle: 1]\n",
                     "timestep: 1e-6\nprocesses:\n  cement: {process: bonding, rule: glue, gap: 5 um, every: 10}\n"),
               "x,y,z,radius\n0,0,0.01,0.01\n0.03,0,0.010001,0.01\n0.06,0,0.0101,0.01\n");
  CHECK(run.value("bonds.count") == 0);
  run.step(10);
  CHECK(run.value("bonds.count") == 2);
  for (uint64_t id = 1; id <= 3; ++id)
    for (double v : run.ball(id).velocity) CHECK(v == 0);
}

TEST_CASE("deleted balls, walls and rules take their bonds with walls with them") {
  const auto left = [](const std::string& action) {
    SceneRun run(scene(floor_wall, disc(endless),
                       "  - one: [bond: {rule: glue, gap: 1 mm}]\n  - two: [" + action + ", cycle: 1]\n"),
                 "x,y,z,radius\n0,0,0.01,0.01\n0.03,0,0.01,0.01\n0.06,0,0.01,0.01\n");
    act(run, 0);
    const auto& actions = run.simulation().scene.stages.at(1).actions;
    for (std::size_t k = 0; k + 1 < actions.size(); ++k) run.simulation().edit(actions[k]);
    run.step(10);
    CHECK(run.value("bonds.broken") == 0);
    return run.value("bonds.count");
  };
  CHECK(left("delete: {balls: row, where: \"id == 2\"}") == 2);
  CHECK(left("delete: {walls: plate}") == 0);
  CHECK(left("add: {contacts: [{name: none, between: [row, plate], model: none}]}, delete: {contacts: glue}") == 0);
  // A rule that comes first is for pairs to come: bonds keep to theirs.
  CHECK(left("add: {contacts: [{name: none, between: [row, plate], model: none}]}") == 3);
}

TEST_CASE("strengths of bonds with walls are drawn, and anew for a bond that is made again") {
  SceneRun run(
      scene(
          floor_wall,
          "model: parallel_bond, kn: 1e6, ks: 1e6, fric: 0, pb_kn: 1e10, pb_ks: 1e10, pb_coh: .inf, pb_ten: {uniform: "
          "{low: 5e5, high: 1e6}}",
          "  - pull: [bond: {rule: glue}, fix: {balls: row}, set: {balls.row.velocity: [0, 0, 0.1]}]\n"
          "  - anew: [bond: {rule: glue, gap: 1 mm}]\n"),
      "x,y,z,radius\n0,0,0.01,0.01\n0.03,0,0.01,0.01\n");
  act(run, 0);
  const auto strength = [&](std::size_t broken) {
    while (run.engine().broken.size() < broken && run.time() < 0.1) run.step();
    REQUIRE(run.engine().broken.size() == broken);
    std::vector<double> found;
    for (const auto& one : run.engine().broken) found.push_back(std::sqrt(2e10 * one.what.energy / area));
    return found;
  };
  const std::vector<double> first = strength(2);
  act(run, 1);
  REQUIRE(run.value("bonds.count") == 2);
  const std::vector<double> all = strength(4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(all[k] > 5e5 * 0.99);
    CHECK(all[k] < 1e6 * 1.01);
    for (std::size_t j = 0; j < k; ++j) CHECK(std::abs(all[k] - all[j]) > 1e3);
  }
}

TEST_CASE("the log of events names the wall of a bond that broke") {
  SceneRun run(scene(floor_wall, "model: contact_bond, kn: 1e6, ks: 1e6, fric: 0, cb_tenf: 10, cb_shearf: 10",
                     "  - pull: [bond: {rule: glue}, apply: {balls: row, force: [0, 0, 100]}]\n"),
               "x,y,z,radius\n0,0,0.01,0.01\n");
  act(run, 0);
  while (run.value("bonds.broken") == 0 && run.time() < 1) run.step();
  const TemporaryFolder folder;
  const double time = run.time(), energy = run.engine().broken.at(0).what.energy;
  const std::string z = digits(run.engine().broken[0].what.point[2]);
  {
    scree::core::OutputFiles files(scree::core::Fd(::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)),
                                   folder.path());
    scree::core::EventLog(files).take(run.engine());
  }
  std::ifstream in(folder / "events.csv");
  std::string head, line;
  REQUIRE(std::getline(in, head));
  REQUIRE(std::getline(in, line));
  CHECK(head == "cycle,time,event,mode,rule,id1,id2,x,y,z,energy,wall");
  CHECK(line == std::to_string(run.engine().clock.cycle) + "," + digits(time) + ",bond_break,tension,glue,1,0,0,0," +
                    z + "," + digits(energy) + ",plate");
}
