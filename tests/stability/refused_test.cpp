// Cases D35, D36, D37 and 62: what a scene must not say, what a plug-in must not return, and mistakes with units.
#include <filesystem>

#include "stability/lab.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/program.hpp"

namespace {

using support::ProgramEnd;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

const char* const drop = R"(scree: 1
walls:
  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}
balls:
  sand: {generator: lattice, kind: sc, radius: 0.01, box: [[0, 0, 0], [0.02, 0.02, 0.02]], density: 2600}
contacts:
  - {name: all, between: [sand, [sand, floor]], model: linear, kn: 1e5, ks: 1e5, fric: 0.5}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
stages:
  - fall: [cycle: 50]
)";

struct Tried {
  TemporaryFolder folder;
  ProgramEnd end;
  Tried(const std::string& text, const std::string& balls = "", std::vector<std::string> more = {}) {
    write_text(folder / "scene.yaml", text);
    if (!balls.empty()) write_text(folder / "balls.csv", balls);
    std::vector<std::string> words{"run", "scene.yaml", "--no-color"};
    words.insert(words.end(), more.begin(), more.end());
    end = support::scree(words, folder.path());
  }
};

}  // namespace

TEST_CASE("D35 REJECT: negative, infinite and missing numbers are refused with place, key, value and range") {
  struct Wrong {
    const char *from, *to, *place, *key;
  };
  const Wrong wrong[] = {{"density: 2600", "density: .nan", "scene.yaml:5:", "density"},
                         {"density: 2600", "density: -2600", "scene.yaml:5:", "density"},
                         {"radius: 0.01", "radius: -1", "scene.yaml:5:", "radius"},
                         {"radius: 0.01", "radius: .inf", "scene.yaml:5:", "radius"},
                         {"kn: 1e5", "kn: .inf", "scene.yaml:7:", "kn"},
                         {"kn: 1e5", "kn: -1e5", "scene.yaml:7:", "kn"},
                         {"fric: 0.5", "fric: -0.5", "scene.yaml:7:", "fric"},
                         {"fric: 0.5", "fric: .nan", "scene.yaml:7:", "fric"},
                         {"-9.81]", ".nan]", "scene.yaml:9:", "acceleration"}};
  for (const Wrong& one : wrong) {
    INFO(one.to);
    const Tried tried(replaced(drop, one.from, one.to));
    INFO(tried.end.err);
    CHECK(tried.end.code == 3);
    CHECK(has(tried.end.err, one.place));
    CHECK(has(tried.end.err, one.key));
    CHECK_FALSE(std::filesystem::exists(tried.folder / "scene.out"));
  }
  lab::measured("D35", std::to_string(std::size(wrong)) + " values refused with exit 3, file:line and key");
}

TEST_CASE("D35 REJECT: what a plug-in hands over is checked as well") {
  const std::string scene =
      replaced(drop, "lattice, kind: sc, radius: 0.01, box: [[0, 0, 0], [0.02, 0.02, 0.02]]", "file, path: balls.csv");
  for (const std::string row : {"0,0,0.01,nan", "0,0,0.01,-0.01", "0,inf,0.01,0.01", "0,0,0.01,0"}) {
    const Tried tried(scene, "x,y,z,radius\n0,0,0.1,0.01\n" + row + "\n");
    INFO(row << "\n" << tried.end.err);
    CHECK(tried.end.code == 3);
    CHECK(has(tried.end.err, "balls.csv"));
    CHECK(has(tried.end.err, ":3"));
  }
}

TEST_CASE("D36 STOP: a law that returns not a number stops the run in the same cycle and is named") {
  const std::string scene =
      replaced(replaced(drop, "model: linear, kn: 1e5, ks: 1e5, fric: 0.5", "model: nan_law, kn: 1e5, until: 1e-6"),
               "cycle: 50", "cycle: 100000");
  const Tried tried(scene, "", {"--plugins", support::binary_dir() + "/tests/hostile"});
  INFO(tried.end.err);
  CHECK(tried.end.code == 5);
  CHECK(has(tried.end.err, "is not a finite number"));
  CHECK(has(tried.end.err, "ball 1"));
  CHECK(has(tried.end.err, "nan_law"));
  CHECK(has(tried.end.err, "failure.csv"));
  const std::string failure = read_text(tried.folder / "scene.out/failure.csv");
  CHECK(has(failure, "id,group,x,y,z"));
  CHECK(has(failure, "\n1,sand,"));
  lab::measured("D36", "exit 5 naming cycle, ball and contact model; failure.csv");
}

TEST_CASE("D37 REJECT: a ball without mass is refused") {
  const Tried tried(replaced(drop, "density: 2600", "density: 0"));
  INFO(tried.end.err);
  CHECK(tried.end.code == 3);
  CHECK(has(tried.end.err, "scene.yaml:5:"));
  CHECK(has(tried.end.err, "density"));
  lab::measured("D37", "exit 3 with file:line");
}

TEST_CASE("62 WARN: millimetres taken for metres show as overlap under own weight") {
  // 10 and 20 mm written as 10 and 20 (m).
  std::string wrong = replaced(drop, "radius: 0.01", "radius: 10");
  wrong = replaced(wrong, "[0.02, 0.02, 0.02]", "[20, 20, 20]");
  const Tried tried(wrong);
  INFO(tried.end.err);
  // m g / (kn R) with m = 2600 4/3 pi 10^3 kg: 106.8 radii.
  CHECK(has(tried.end.err, "overlap under own weight = 107 R: ball 1 of radius 10 m"));
  CHECK(has(tried.end.err, "check the units"));
  const Tried right(drop);
  CHECK(right.end.code == 0);
  CHECK_FALSE(has(right.end.err, "own weight"));
  lab::measured("62", "mm taken for m: overlap under own weight = 107 R; the right scene says nothing");
}
