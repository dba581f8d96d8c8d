#include <clocale>
#include <cmath>
#include <fstream>
#include <sstream>

#include "support/catch.hpp"
#include "support/paths.hpp"
#include "unit/scene_fakes.hpp"

using namespace scree::core;

namespace {

const char* const specimen = R"yaml(
scree: 1
title: a specimen
seed: 2011
vars: {half: "side / 2", side: 150 mm, slow: -50 mm/s}
cell: {low: [0, 0, 0], high: [side, side, 0.3], periodic: [x, y]}
overlap_limit: 40 %
walls:
  bottom: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
  top:    {wall: plane, point: [0, 0, side], normal: [0, 0, -1], velocity: [0, 0, slow], contact: {kn: 2e6 N/m, ks: 1e6}}
  sides:  {wall: box, low: [0, 0, 0], high: [side, side, 2*side], open: [bottom, top]}
balls:
  sand:
    generator: random
    box: [[0, 0, 0], [side, side, half]]
    grading: [{diameter: [12.5 mm, 25 mm], share: 1}, {diameter: 10 mm, share: 50 %}]
    porosity: 39.6 %
    density: 2650 kg/m3
    contact: {kn: 1e6 N/m, ks: 5e5, fric: "0.3 + 0.1*z/side"}
contacts:
  - {name: grains, between: [sand, sand], model: linear, emod: 4.5 GPa, kratio: 2.5, fric: "0.1*x + half"}
  - {name: platen, between: [sand, top], model: linear}
  - {name: mould, between: [sand, [bottom, sides]], model: linear, kn: 1 MN/m, ks: 1 MN/m, fric: .inf}
processes:
  gravity: {process: gravity, acceleration: [0, 0, -9.81]}
  damping: {process: local_damping, factor: 0.7}
quantities:
  stress: "(walls.top.force.z - walls.bottom.force.z) / (2*side^2)"
  low: {mean: radius, over: sand, where: "z < half"}
  number: {count: sand.fine}
stages:
  - settle: [solve: 1e-3, save: packed]
  - test:
      - set: {contacts.grains.fric: 0.4, walls.top.velocity: [0, 0, -50 mm/s], timestep: 1e-6, processes.damping.factor: 0.2}
        delete: {walls: sides}
        run: {until: {stress: {falls_to: 60 %}, "abs(stress) / 2": {above: 5 MPa}}, at_most: 30 ms}
      - fix: {balls: sand, velocity: [x, z]}
      - free: {balls: sand.fine, where: "z > 0.1"}
      - apply: {balls: sand, force: [0, 0, 10 N]}
      - cycle: 1000 cycles
      - solve: {unbalanced: 1.0e-5, at_most: 200000 cycles}
      - add:
          walls: {lid: {wall: plane, point: [0, 0, 1], normal: [0, 0, -1]}}
          contacts: [{name: lid, between: [sand, lid], model: none}]
record:
  curve: {writer: csv, every: 0.1 ms, quantities: [time, stress, "2*stress"]}
  frames: {writer: vtk, every: 500 cycles, fields: [radius, velocity]}
expect:
  - {quantity: stress.peak, between: [5 MPa, 35 MPa]}
  - {quantity: low, equals: 9 mm, within: 0.1 %, source: a sieve}
)yaml";

template <class Action>
const Action& action(const Scene& scene, size_t stage, size_t index) {
  return std::get<Action>(scene.stages.at(stage).actions.at(index).what);
}

}  // namespace

TEST_CASE("a whole scene is read in SI units") {
  const Scene scene = read_text_scene(specimen);
  REQUIRE(scene.seed == 2011);
  REQUIRE(scene.vars.at("half") == 0.075);
  REQUIRE(scene.cell->periodic == std::array<bool, 3>{true, true, false});
  REQUIRE(scene.cell->high == Triple{0.15, 0.15, 0.3});
  REQUIRE(scene.overlap_limit == 0.4);
  REQUIRE(scene.walls[1].velocity == Triple{0, 0, -0.05});
  REQUIRE(scene.walls[2].wall.settings[1].value.numbers == std::vector<double>{0.15, 0.15, 0.3});
  REQUIRE(scene.walls[2].wall.settings[2].value.texts == std::vector<std::string>{"bottom", "top"});
  const Use& random = scene.balls[0].generator;
  REQUIRE(random.settings[0].value.rows == 2);
  REQUIRE(random.settings[0].value.numbers == std::vector<double>{0, 0, 0, 0.15, 0.15, 0.075});
  REQUIRE(random.settings[1].value.numbers == std::vector<double>{0.0125, 0.025, 1, 0.01, 0.01, 0.5});
  REQUIRE(random.settings[1].value.columns == 3);
  REQUIRE(random.settings[2].value.numbers == std::vector<double>{39.6 / 100});
  REQUIRE(scene.balls[0].density == 2650.0);
  REQUIRE(scene.warnings.size() == 1);
  REQUIRE(scene.warnings[0].ends_with("wall 'lid' touches nothing: every rule for it is 'model: none'"));
}

TEST_CASE("rules choose their input form from their own settings or from their pieces") {
  const Scene scene = read_text_scene(specimen);
  REQUIRE(scene.contacts[0].model.form == 1);  // emod kratio
  REQUIRE(scene.contacts[1].model.form == 0);  // the pieces give kn ks
  REQUIRE(scene.contacts[1].model.settings.empty());
  REQUIRE(scene.contacts[2].model.form == 0);
  REQUIRE(std::isinf(scene.contacts[2].model.settings[2].value.numbers[0]));
  const Setting& fric = scene.contacts[0].model.settings[2];
  REQUIRE(fric.formula);
  REQUIRE(fric.formula->names() == std::vector<std::string>{"x"});
  REQUIRE(fric.formula->evaluate(std::vector<double>{0.5}) == 0.1 * 0.5 + 0.075);
  REQUIRE(scene.balls[0].contact[2].formula->names() == std::vector<std::string>{"z"});
  REQUIRE(scene.balls[0].contact[0].unit == "N/m");
  REQUIRE(scene.contacts[2].between[1] == std::vector<std::string>{"bottom", "sides"});
}

TEST_CASE("stages hold their actions in the order written") {
  const Scene scene = read_text_scene(specimen);
  REQUIRE(scene.stages.size() == 2);
  REQUIRE(action<RunAction>(scene, 0, 0).word == RunAction::Word::solve);
  REQUIRE(action<RunAction>(scene, 0, 0).until[0].value == 1e-3);
  REQUIRE(action<RunAction>(scene, 0, 0).until[0].quantity->text() == "unbalanced");
  REQUIRE(action<SaveAction>(scene, 0, 1).name.text == "packed");
  const auto& fric = action<SetAction>(scene, 1, 0);
  REQUIRE((fric.target == SetAction::Target::rule && fric.name == "grains" && fric.key == "fric"));
  REQUIRE(fric.setting.value.numbers == std::vector<double>{0.4});
  REQUIRE(action<SetAction>(scene, 1, 1).setting.value.numbers == std::vector<double>{0, 0, -0.05});
  REQUIRE(action<SetAction>(scene, 1, 2).target == SetAction::Target::timestep);
  REQUIRE(action<SetAction>(scene, 1, 3).target == SetAction::Target::process);
  REQUIRE(action<DeleteAction>(scene, 1, 4).name.text == "sides");
  const auto& run = action<RunAction>(scene, 1, 5);
  REQUIRE(run.until.size() == 2);
  REQUIRE((run.until[0].test == Until::Test::falls_to && run.until[0].value == 0.6));
  REQUIRE((run.until[1].test == Until::Test::above && run.until[1].value == 5e6));
  REQUIRE(run.length.time == 0.03);
  const auto& fix = action<FixAction>(scene, 1, 6);
  REQUIRE(fix.velocity == std::array<bool, 3>{true, false, true});
  REQUIRE(fix.spin == std::array<bool, 3>{false, false, false});
  const auto& free = action<FixAction>(scene, 1, 7);
  REQUIRE((!free.fix && free.velocity[1] && free.spin[2] && free.where));
  REQUIRE(action<ApplyAction>(scene, 1, 8).force == Triple{0, 0, 10});
  REQUIRE(action<RunAction>(scene, 1, 9).length.cycles == 1000u);
  REQUIRE(action<RunAction>(scene, 1, 10).length.cycles == 200000u);
  REQUIRE(action<AddAction>(scene, 1, 11).contacts[0].none);
}

TEST_CASE("quantities, records and expectations") {
  const Scene scene = read_text_scene(specimen);
  REQUIRE(scene.quantities[0].formula->names().size() == 2);
  REQUIRE((scene.quantities[1].reduction == "mean" && scene.quantities[1].over == "sand"));
  REQUIRE(scene.quantities[1].where->names() == std::vector<std::string>{"z"});
  REQUIRE((scene.quantities[2].reduction == "count" && scene.quantities[2].over == "sand.fine"));
  REQUIRE(scene.record[0].every.time == 0.1 / 1000);
  REQUIRE(scene.record[0].quantities[2]->text() == "2*stress");
  REQUIRE(scene.record[1].every.cycles == 500u);
  REQUIRE(scene.record[1].fields[1].text == "velocity");
  REQUIRE((scene.expect[0].low == 5e6 && scene.expect[0].high == 35e6));
  REQUIRE(scene.expect[1].equals == 0.009);
  REQUIRE(*scene.expect[1].tolerance == Approx(9e-6).epsilon(1e-14));
  REQUIRE(scene.expect[0].text == "stress.peak between [5 MPa, 35 MPa]");
}

TEST_CASE("the resolved scene reads back to itself") {
  const Scene scene = read_text_scene(specimen, {{"vars.side", "200 mm"}});
  REQUIRE(scene.vars.at("side") == 0.2);
  const Scene again = read_text_scene(scene.resolved);
  REQUIRE(again.resolved == scene.resolved);
  REQUIRE(again.vars == scene.vars);
  REQUIRE(again.stages.size() == scene.stages.size());
  REQUIRE(again.stages[1].actions.size() == scene.stages[1].actions.size());
  REQUIRE(again.contacts[0].model.settings[2].formula->text() == "0.1*x + half");
}

TEST_CASE("the flag --set changes a value, adds a key, and goes by the name of a rule or stage") {
  const Scene scene = read_text_scene(specimen, {{"contacts.grains.fric", "0.25"},
                                                 {"stages.settle.0.solve", "1e-2"},
                                                 {"timestep", "1 us"},
                                                 {"contacts.2.kn", "2 MN/m"}});
  REQUIRE(scene.contacts[0].model.settings[2].value.numbers[0] == 0.25);
  REQUIRE(action<RunAction>(scene, 0, 0).until[0].value == 0.01);
  REQUIRE(scene.timestep == 1e-6);
  REQUIRE(scene.contacts[2].model.settings[0].value.numbers[0] == 2e6);
}

TEST_CASE("the flag --set refuses a path whose parent does not exist and values that do not fit") {
  const auto refusal = [](const std::string& path, const std::string& value) -> std::string {
    try {
      read_text_scene(specimen, {{path, value}});
    } catch (const SceneErrors& errors) {
      return errors.what();
    }
    return "accepted";
  };
  REQUIRE(refusal("ball.sand.density", "1") ==
          "--set ball.sand.density=1: error: there is no 'ball' in the scene; did you mean 'balls'?");
  REQUIRE(refusal("contacts.gains.fric", "1") ==
          "--set contacts.gains.fric=1: error: there is no 'contacts.gains' in the scene; did you mean "
          "'grains'?");
  REQUIRE(refusal("contacts.7", "1") == "--set contacts.7=1: error: there is no 'contacts.7' in the scene");
  REQUIRE(refusal("balls.sand.density", "-1 kg/m3") ==
          "--set balls.sand.density=-1 kg/m3: error: 'density' must be above 0 kg/m3, not '-1 kg/m3'");
}

TEST_CASE("zero balls and one wall, one ball and no wall, and a saved state are scenes") {
  REQUIRE(refusal_of("scree: 1\nwalls: {floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}}\n") == "");
  REQUIRE(refusal_of("scree: 1\nballs: {one: {generator: points, centres: [[0, 0, 0]], radii: 1}}\n"
                     "contacts: [{between: [one, one], model: none}]\n") == "");
  const Scene scene =
      read_text_scene("scree: 1\nstart: {state: other.out/packed}\nstages: [go: [delete: {balls: sand}]]\n");
  REQUIRE(scene.start_state->text.ends_with("/other.out/packed"));
  // Balls come from the state; walls, rules and processes are the scene's own.
  for (const char* what : {"walls", "contacts", "processes"})
    REQUIRE(refusal_of("scree: 1\nstart: {state: other.out/packed}\nstages: [go: [delete: {" + std::string(what) +
                       ": w}]]\n")
                .find("'w' at this point of the scene") != std::string::npos);
}

TEST_CASE("a rule that no pair reaches is warned of with the rules before it") {
  const std::string balls =
      "scree: 1\nballs:\n  one: {generator: points, centres: [[0, 0, 0]], radii: 1}\n"
      "  two: {generator: points, centres: [[9, 0, 0]], radii: 1}\n"
      "walls: {floor: {wall: plane, point: [0, 0, -1], normal: [0, 0, 1]}}\ncontacts:\n";
  const std::string law = ", model: linear, kn: 1e6, ks: 1e6, fric: 0.5}\n";
  const auto warnings = [&](const std::string& rest) { return read_text_scene(balls + rest).warnings; };
  REQUIRE(warnings("  - {name: all, between: [balls, [balls, walls]]" + law + "  - {name: late, between: [two, one]" +
                   law) ==
          std::vector<std::string>{"scene:8:5: warning: rule 'late' is never used: 'all' comes first and fits all its "
                                   "pairs; put it before it, or delete it"});
  REQUIRE(warnings("  - {name: a, between: [one, balls]" + law + "  - {name: b, between: [two, [two, floor]]" + law +
                   "  - {name: c, between: [balls, balls]" + law + "  - {name: d, between: [one, floor]" + law) ==
          std::vector<std::string>{"scene:9:5: warning: rule 'c' is never used: 'a', 'b' come first and fit all its "
                                   "pairs; put it before them, or delete it"});
  // Half of it reached, a sub-group before its set, and one that a stage brings to light or adds in front.
  REQUIRE(warnings("  - {name: a, between: [one, one]" + law + "  - {name: b, between: [balls, [balls, walls]]" + law)
              .empty());
  REQUIRE(warnings("  - {name: a, between: [one.fine, balls]" + law + "  - {name: b, between: [one, [balls, walls]]" +
                   law + "  - {name: c, between: [two, [balls, walls]]" + law)
              .empty());
  REQUIRE(warnings("  - {name: all, between: [balls, [balls, walls]]" + law + "  - {name: late, between: [two, one]" +
                   law + "  - {name: rest, between: [balls, [balls, walls]]" + law +
                   "stages: [go: [delete: {contacts: all}]]\n")
              .empty());
  REQUIRE(warnings("  - {name: all, between: [balls, [balls, walls]]" + law +
                   "stages: [go: [add: {contacts: [{name: late, between: [two, one]" + law.substr(0, law.size() - 1) +
                   "]}]]\n")
              .empty());
}

TEST_CASE("pieces that touch nothing are warned of") {
  const Scene scene = read_text_scene(
      "scree: 1\nballs: {one: {generator: points, centres: [[0, 0, 0]], radii: 1}}\n"
      "contacts: [{between: [one, one], model: none}]\n");
  REQUIRE(scene.warnings ==
          std::vector<std::string>{
              "scene:2:9: warning: ball set 'one' touches nothing: every rule for it is 'model: none'"});
}

TEST_CASE("a missing plug-in alone exits with 4, beside other errors with 3") {
  const std::string missing = "scree: 1\nwalls: {floor: {wall: plan}}\n";
  try {
    read_text_scene(missing);
    FAIL("accepted");
  } catch (const Refusal& refusal) {
    REQUIRE(refusal.code() == Exit::plugin);
    REQUIRE(std::string(refusal.what()) == "scene:2:23: error: no wall plug-in 'plan'; did you mean 'plane'?");
  }
  REQUIRE_THROWS_AS(read_text_scene(missing + "sed: 3\n"), SceneErrors);
}

TEST_CASE("the whole scene of docs/scenes.md is accepted") {
  std::ifstream stream(support::source_dir() + "/docs/scenes.md");
  std::ostringstream page;
  page << stream.rdbuf();
  const std::string text = page.str();
  const size_t start = text.find("```yaml\nscree: 1");
  REQUIRE(start != std::string::npos);
  const std::string scene = text.substr(start + 8, text.find("```", start + 8) - start - 8);
  REQUIRE(refusal_of(scene) == "");
}

TEST_CASE("numbers and units do not depend on the locale") {
  // Any locale with a decimal comma that the machine has; without one the C locale is tested again.
  const char* found = nullptr;
  for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8"})
    if (!found) found = std::setlocale(LC_ALL, name);
  const Scene scene = read_text_scene(specimen);
  std::setlocale(LC_ALL, "C");
  REQUIRE(scene.vars.at("side") == 0.15);
  REQUIRE(scene.contacts[0].model.settings[2].formula->evaluate(std::vector<double>{0.5}) == 0.1 * 0.5 + 0.075);
}
