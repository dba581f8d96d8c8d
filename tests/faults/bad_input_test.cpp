// Scenes that cannot run, given to the built program: each refusal has its code and says what, where and what next, and
// leaves no folder behind.
#include <filesystem>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/program.hpp"
#include "support/temporary_folder.hpp"

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const char* const drop = R"(scree: 1
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  sand: {generator: random, radius: 0.01, count: 20, box: [[0, 0, 0], [0.2, 0.2, 0.2]], density: 2600}
contacts:
  - {name: grains, between: [sand, sand], model: linear, kn: 1e5, ks: 1e5, fric: 0.5}
  - {name: ground, between: [sand, floor], model: linear, kn: 1e5, ks: 1e5, fric: 0.5}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
stages:
  - fall: [cycle: 50]
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = drop;
  text.replace(text.find(from), from.size(), to);
  return text;
}

struct Wrong {
  const char* name;
  std::string scene;
  int code;
  std::vector<std::string> says;  ///< what, where, what next
};

}  // namespace

TEST_CASE("a scene that cannot run is refused with its code, place and remedy") {
  const std::vector<Wrong> all = {
      {"an empty file", "", 3, {"scene.yaml", "the scene is empty", "begin with 'scree: 1'"}},
      {"an empty scene", "scree: 1\n", 3, {"scene.yaml", "neither balls nor walls", "add an entry"}},
      {"not a number", with("density: 2600", "density: .nan"), 3, {"scene.yaml:5:", "density", "error"}},
      {"negative density", with("density: 2600", "density: -2600"), 3, {"scene.yaml:5:", "density", "-2600"}},
      {"a wall without a rule",
       with("  - {name: ground, between: [sand, floor], model: linear, kn: 1e5, ks: 1e5, fric: 0.5}\n", ""),
       3,
       {"scene.yaml:3:3:", "no rule mentions wall 'floor'", "model: none"}},
      {"a pair without a rule",
       with("  - {name: grains, between: [sand, sand], model: linear, kn: 1e5, ks: 1e5, fric: 0.5}\n", ""),
       3,
       {"scene.yaml:5:3:", "no rule covers the pair 'sand' and 'sand'", "model: none"}},
      {"a generator that cannot place its balls",
       with("count: 20, box: [[0, 0, 0], [0.2, 0.2, 0.2]]",
            "count: 900, tries: 200, box: [[0, 0, 0], [0.1, 0.1, 0.1]]"),
       3,
       {"scene.yaml:5:", "balls 'sand'", "of 900", "porosity"}},
      {"a periodic cell that is too small",
       with("walls:", "cell: {low: [0, 0, 0], high: [0.03, 0.2, 0.2], periodic: [x]}\nwalls:"),
       3,
       {"the periodic cell is too small along x", "0.03 m", "enlarge the cell or use smaller balls"}},
      {"a missing plug-in",
       with("model: linear", "model: linaer"),
       4,
       {"scene.yaml:7:", "linaer", "did you mean 'linear'?"}},
      {"a step above the stable limit",
       with("walls:", "timestep: 1 ms\nwalls:"),
       3,
       {"stable limit", "lower 'timestep'"}},
      {"an action for a sub-group that was not made",
       with("cycle: 50", "cycle: 1000000000, fix: {balls: sand.fien}, delete: {balls: sand.coarse, where: \"z > 1\"}"),
       3,
       {"scene.yaml:12:", "no balls belong to 'sand.fien'", "no balls belong to 'sand.coarse'"}},
      {"a state that is not there",
       "scree: 1\nstart: {state: none/such}\nstages:\n  - go: [cycle: 1]\n",
       6,
       {"none/such"}}};
  for (const Wrong& one : all) {
    const TemporaryFolder folder;
    write_text(folder / "scene.yaml", one.scene);
    const support::ProgramEnd end = support::scree({"run", "scene.yaml", "--no-color"}, folder.path());
    INFO(one.name << "\n" << end.err);
    CHECK(end.signal == 0);
    CHECK(end.code == one.code);
    for (const std::string& part : one.says) {
      INFO("wants: " << part);
      CHECK(has(end.err, part));
    }
    CHECK_FALSE(std::filesystem::exists(folder / "scene.out"));
  }
}

TEST_CASE("a folder that scree did not write is never touched") {
  const TemporaryFolder folder;
  write_text(folder / "scene.yaml", drop);
  std::filesystem::create_directory(folder / "mine");
  write_text(folder / "mine/thesis.txt", "years of work");
  const support::ProgramEnd end = support::scree({"run", "scene.yaml", "-o", "mine"}, folder.path());
  CHECK(end.code == 6);
  CHECK(has(end.err, "mine"));
  CHECK(read_text(folder / "mine/thesis.txt") == "years of work");
}

TEST_CASE("an instruction set that the CPU lacks or nobody knows is wrong usage") {
  const TemporaryFolder folder;
  write_text(folder / "scene.yaml", drop);
  const support::ProgramEnd end = support::scree({"run", "scene.yaml", "--isa", "v5"}, folder.path());
  CHECK(end.code == 2);
  CHECK(has(end.err, "use baseline, v3 or v4"));
}
