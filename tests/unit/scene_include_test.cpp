#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/catch.hpp"
#include "unit/scene_fakes.hpp"

using namespace scree::core;
namespace fs = std::filesystem;

namespace {

/// A folder of its own for one test, gone afterwards.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("scree_include_" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_ / "scene" / "parts");
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
  }
  Scene read(std::vector<std::string> include_dirs = {}) const {
    ReadOptions options;
    options.file = (path_ / "scene" / "s.yaml").string();
    options.include_dirs = std::move(include_dirs);
    return read_scene(options, fake_components());
  }
  std::string refusal() const {
    try {
      read();
    } catch (const SceneErrors& errors) {
      return errors.what();
    }
    return "accepted";
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

const char* const walls = "walls: {floor: {wall: plane, point: [0, 0, depth], normal: [0, 0, 1]}}\n";

}  // namespace

TEST_CASE("the scene's own entries win over its fragments, and vars of both know each other") {
  const Folder folder;
  folder.write("scene/parts/base.yaml",
               std::string("vars: {depth: \"2*unit\", twice: \"2*depth\", far: 9}\ntitle: base\n") + walls);
  folder.write("scene/s.yaml", "scree: 1\ninclude: parts/base.yaml\nvars: {unit: 3, far: \"twice + 1\"}\ntitle: own\n");
  const Scene scene = folder.read();
  REQUIRE(scene.title == "own");
  REQUIRE(scene.vars == std::map<std::string, double>{{"unit", 3}, {"depth", 6}, {"twice", 12}, {"far", 13}});
  REQUIRE(scene.walls[0].wall.settings[0].value.numbers[2] == 6.0);
  REQUIRE(scene.walls[0].place.file == "parts/base.yaml");
}

TEST_CASE("rules of fragments come after the scene's own, stages and expectations before") {
  const Folder folder;
  folder.write("scene/parts/a.yaml",
               "stages: [a: [cycle: 1]]\ncontacts: [{name: a, between: [balls, balls], model: none}]\n");
  folder.write("scene/parts/b.yaml",
               "stages: [b: [cycle: 1]]\ncontacts: [{name: b, between: [balls, balls], model: none}]\n");
  folder.write("scene/s.yaml",
               "scree: 1\ninclude: [parts/a.yaml, parts/b.yaml]\nstages: [own: [cycle: 1]]\n"
               "balls: {s: {generator: points, centres: [[0, 0, 0]], radii: 1}}\n"
               "contacts: [{name: own, between: [balls, balls], model: none}]\n");
  const Scene scene = folder.read();
  REQUIRE((scene.stages[0].name == "a" && scene.stages[1].name == "b" && scene.stages[2].name == "own"));
  REQUIRE((scene.contacts[0].name == "own" && scene.contacts[1].name == "a" && scene.contacts[2].name == "b"));
}

TEST_CASE("a stage splices a file of actions, also from an installed folder, also nested") {
  const Folder folder;
  folder.write("configs/procedures/settle.yaml", "- run: 0.5 s\n- include: procedures/more.yaml\n");
  folder.write("configs/procedures/more.yaml", "- cycle: 7\n");
  folder.write("scene/s.yaml", std::string("scree: 1\nvars: {depth: 0}\n") + walls +
                                   "stages:\n  - all: [cycle: 1, {include: procedures/settle.yaml, save: packed}]\n");
  const Scene scene = folder.read({(folder.path() / "configs").string()});
  const auto& actions = scene.stages[0].actions;
  REQUIRE(actions.size() == 4);
  REQUIRE(std::get<RunAction>(actions[0].what).length.cycles == 1u);
  REQUIRE(std::get<RunAction>(actions[1].what).length.time == 0.5);
  REQUIRE(std::get<RunAction>(actions[2].what).length.cycles == 7u);
  REQUIRE(std::get<SaveAction>(actions[3].what).name.text == "packed");
  REQUIRE(scene.resolved.find("include") == std::string::npos);
}

TEST_CASE("a link that leads out of the scene's folder is refused, in includes and in files") {
  const Folder folder;
  folder.write("secret.yaml", "title: stolen\n");
  folder.write("scene/s.yaml", "scree: 1\ninclude: parts/link.yaml\n");
  fs::create_symlink(folder.path() / "secret.yaml", folder.path() / "scene/parts/link.yaml");
  REQUIRE(folder.refusal().find("'parts/link.yaml' is a link that leads out of the scene's folder") !=
          std::string::npos);
  folder.write("scene/s.yaml",
               "scree: 1\nballs: {s: {generator: file, path: parts/link.yaml}}\n"
               "contacts: [{between: [s, s], model: none}]\n");
  REQUIRE(folder.refusal().find("is a link that leads out") != std::string::npos);
}

TEST_CASE("a file property becomes an absolute path below the scene") {
  const Folder folder;
  folder.write("scene/parts/balls.csv", "x,y,z,r\n");
  folder.write("scene/s.yaml",
               "scree: 1\nballs: {s: {generator: file, path: parts/balls.csv}}\n"
               "contacts: [{between: [s, s], model: none}]\n");
  const Scene scene = folder.read();
  REQUIRE(scene.balls[0].generator.settings[0].value.texts[0] ==
          fs::canonical(folder.path() / "scene/parts/balls.csv").string());
}
