// The command line of docs/cli.md: exit codes, suggestions, and what check, list, show and explain print.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/program.hpp"
#include "support/temporary_folder.hpp"

using support::ProgramEnd;
using support::scree;
using Json = nlohmann::json;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// One ball over a floor; `law` gives the rule its properties.
std::string scene(const std::string& law) {
  return "scree: 1\n"
         "walls:\n"
         "  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n"
         "balls:\n"
         "  sand: {generator: lattice, kind: sc, radius: 10 mm, density: 2650,\n"
         "         box: [[-11 mm, -11 mm, 9 mm], [11 mm, 11 mm, 31 mm]]}\n"
         "contacts:\n"
         "  - {name: grains, between: [balls, [balls, walls]], model: linear, " +
         law +
         "}\n"
         "stages:\n"
         "  - fall: [run: 100 cycles]\n";
}
const std::string frictionless = "kn: 1e5, ks: 0", frictional = "kn: 1e5, ks: 1e5, fric: 0.5";

struct Folder {
  TemporaryFolder folder;
  ProgramEnd with(const std::string& text, std::vector<std::string> words) const {
    write_text(folder / "scene.yaml", text);
    return scree(words, folder.path());
  }
};

}  // namespace

TEST_CASE("help and version exit 0 and go to stdout") {
  for (const char* flag : {"-h", "--help"}) {
    const ProgramEnd end = scree({flag});
    CHECK(end.code == 0);
    CHECK(has(end.out, "scree run SCENE"));
    CHECK(end.err.empty());
  }
  const ProgramEnd version = scree({"--version"});
  CHECK(version.code == 0);
  CHECK(version.out == "scree " SCREE_VERSION "\n");
  for (const char* command :
       {"run", "resume", "check", "explain", "study", "list", "show", "new", "vet", "schema", "demo"}) {
    const ProgramEnd end = scree({command, "-h"});
    INFO(command);
    CHECK(end.code == 0);
    CHECK(has(end.out, "--plugins"));
  }
}

TEST_CASE("wrong usage exits 2 with the nearest name") {
  CHECK(scree({}).code == 2);
  CHECK(has(scree({}).err, "scree run SCENE"));
  const ProgramEnd command = scree({"explian", "x.yaml"});
  CHECK(command.code == 2);
  CHECK(has(command.err, "unknown command 'explian'; did you mean 'explain'?"));
  const ProgramEnd flag = scree({"run", "x.yaml", "--ouptut", "a"});
  CHECK(flag.code == 2);
  CHECK(has(flag.err, "unknown flag '--ouptut'; did you mean '--output'?"));
  const ProgramEnd missing = scree({"run"});
  CHECK(missing.code == 2);
  CHECK(has(missing.err, "SCENE is required"));
  CHECK(scree({"run", "--ouptut=a"}).err.find("did you mean '--output'?") != std::string::npos);
  CHECK(scree({"check", "a.yaml", "b.yaml"}).code == 2);
  CHECK(scree({"--quiet", "run", "a.yaml"}).code == 2);
  CHECK(scree({"check", "a.yaml", "--set", "seed"}).code == 2);
  CHECK(scree({"list", "walls"}).code == 2);
  CHECK(has(scree({"list", "walls"}).err, "did you mean 'wall'?"));
  CHECK(scree({"list", "--plugins", "/nonexistent"}).code == 2);
  CHECK(scree({"resume", "x", "--from", "yesterday"}).code == 2);
}

TEST_CASE("numbers on the command line are read whole and in range") {
  const Folder at;
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{{"-j", "0"},
                                                                                     {"-j", "two"},
                                                                                     {"-n", "0"},
                                                                                     {"-n", "1e3"},
                                                                                     {"-n", "10x"},
                                                                                     {"--isa", "v9"},
                                                                                     {"--time-limit", "0"},
                                                                                     {"--time-limit", "3 kg"},
                                                                                     {"--time-limit", "soon"}}) {
    std::vector<std::string> words{"run", "scene.yaml"};
    words.insert(words.end(), wrong.begin(), wrong.end());
    INFO(wrong[0] << " " << wrong[1]);
    const ProgramEnd end = at.with(scene(frictional), words);
    CHECK(end.code == 2);
    CHECK(has(end.err, "'" + wrong[1] + "'") + has(end.err, wrong[0] + " " + wrong[1]) > 0);
    CHECK_FALSE(std::filesystem::exists(at.folder / "scene.out"));
  }
}

TEST_CASE("a stdout that takes nothing is exit 6") {
  for (const char* command : {"--version", "-h", "list"}) {
    const ProgramEnd full = scree({command}, ".", "/dev/full");
    INFO(command);
    CHECK(full.code == 6);
    CHECK(has(full.err, "cannot write to stdout: No space left on device"));
    const ProgramEnd closed = scree({command}, ".", "-");
    CHECK(closed.code == 6);
    CHECK(has(closed.err, "cannot write to stdout: Bad file descriptor"));
  }
}

TEST_CASE("a scene that cannot be read is exit 3, each error with its place") {
  const Folder at;
  const ProgramEnd absent = scree({"check", "absent.yaml"}, at.folder.path());
  CHECK(absent.code == 3);
  CHECK(has(absent.err, "absent.yaml"));
  const ProgramEnd wrong = at.with(scene("kn: 1e5, kz: 0"), {"check", "scene.yaml"});
  CHECK(wrong.code == 3);
  CHECK(has(wrong.err, "scene.yaml:8:"));
  CHECK(has(wrong.err, "'kz'"));
  CHECK_FALSE(has(wrong.err, "error: scene.yaml"));
  CHECK(wrong.out.empty());
}

TEST_CASE("a plug-in that is missing is exit 4") {
  const Folder at;
  std::string text = scene(frictional);
  text.replace(text.find("model: linear"), 13, "model: linaer");
  const ProgramEnd end = at.with(text, {"check", "scene.yaml"});
  CHECK(end.code == 4);
  CHECK(has(end.err, "linaer"));
  CHECK(has(end.err, "did you mean 'linear'?"));
}

TEST_CASE("check runs nothing and says what it saw") {
  const Folder at;
  const ProgramEnd end = at.with(scene(frictional), {"check", "scene.yaml"});
  INFO(end.err);
  CHECK(end.code == 0);
  CHECK(has(end.out, "scene.yaml: ok (1 ball, 1 wall, 1 rule, 1 stage, step "));
  CHECK_FALSE(std::filesystem::exists(at.folder / "scene.out"));
  const Json json = Json::parse(at.with(scene(frictional), {"check", "scene.yaml", "--json"}).out);
  CHECK(json.at("ok") == true);
  CHECK(json.at("balls") == 1);
}

TEST_CASE("check refuses a step above the stable limit, as a run would") {
  // One ball on a spring: the limit is 2 sqrt(m/k), at 2650 kg/m3, 10 mm and 1e5 N/m about 0.67 ms.
  const Folder at;
  const ProgramEnd end = at.with(scene(frictional) + "timestep: 2 ms\n", {"check", "scene.yaml"});
  CHECK(end.code == 3);
  CHECK(has(end.err, "stable limit"));
}

TEST_CASE("the flag --set replaces a value before the scene is read") {
  const Folder at;
  const ProgramEnd end =
      at.with(scene(frictional), {"check", "--set", "contacts.grains.kn=-1", "scene.yaml", "--set", "seed=2"});
  CHECK(end.code == 3);
  CHECK(has(end.err, "--set contacts.grains.kn=-1"));
}

TEST_CASE("list names every plug-in of the build with its version") {
  const ProgramEnd end = scree({"list"});
  CHECK(end.code == 0);
  for (const char* name : {"linear", "plane", "box", "random", "lattice", "file", "gravity", "local_damping",
                           "quiet_boundary", "csv", "vtk"})
    CHECK(has(end.out, std::string(" ") + name + " "));
  CHECK_FALSE(has(end.out, "refused"));
  const Json walls = Json::parse(scree({"list", "wall", "--json"}).out);
  CHECK(walls.size() == 2);
  CHECK(walls.at(0).at("name") == "box");
  CHECK(walls.at(0).at("state") == "ok");
}

TEST_CASE("list says why a file is refused and which file is shadowed") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "wall");
  write_text(folder / "wall/plane.so", "not a library");
  const ProgramEnd end = scree({"list", "wall", "--plugins", folder.path()});
  CHECK(end.code == 0);
  CHECK(has(end.out, "refused: "));
  CHECK(has(end.out, "shadowed: "));
  CHECK(has(end.err, "warning: "));
}

TEST_CASE("show prints keys with units, ranges and defaults") {
  const ProgramEnd end = scree({"show", "linear"});
  CHECK(end.code == 0);
  CHECK(has(end.out, "kn: number, N/m, at least 0"));
  CHECK(has(end.out, "fric: number, at least 0, default 0"));
  CHECK(has(end.out, "in the form 'emod kratio'"));
  CHECK(has(end.out, "states and flags\n  remembers spring: 3 numbers, N\n"));
  CHECK(has(end.out, "  accounts for its energy\n"));
  CHECK(has(scree({"show", "local_damping"}).out, "  damps locally, which shortens the time step\n"));
  const ProgramEnd wrong = scree({"show", "liner"});
  CHECK(wrong.code == 4);
  CHECK(has(wrong.err, "no plug-in 'liner' is installed; did you mean 'linear'?"));
  CHECK(scree({"show", "linear", "--kind", "wall"}).code == 4);
}

TEST_CASE("what show offers to paste is a scene") {
  const Folder at;
  std::string text = scene(frictional);
  text.erase(text.find("contacts:"), text.find("stages:") - text.find("contacts:"));
  std::string rules = Json::parse(scree({"show", "linear", "--json"}).out).at("snippet");
  rules.replace(rules.find("[balls, balls]"), 14, "[balls, [balls, walls]]");
  text.erase(text.find("  floor:"), text.find("balls:") - text.find("  floor:"));
  text.replace(text.find("walls:\n"), 7,
               Json::parse(scree({"show", "box", "--json"}).out).at("snippet").get<std::string>());
  const std::string process = Json::parse(scree({"show", "gravity", "--json"}).out).at("snippet");
  const std::string writer = Json::parse(scree({"show", "csv", "--json"}).out).at("snippet");
  const ProgramEnd end = at.with(text + rules + process + writer, {"check", "scene.yaml"});
  INFO(end.err << rules << process << writer);
  CHECK(end.code == 0);
}

TEST_CASE("explain says what a frictionless scene leaves out") {
  const Folder at;
  const ProgramEnd lean = at.with(scene(frictionless), {"explain", "scene.yaml"});
  INFO(lean.err);
  CHECK(lean.code == 0);
  CHECK(has(lean.out, "spin and moment of balls: rule 'grains' has no tangential part"));
  CHECK(has(lean.out, "plug-ins: 3 opened of "));
  CHECK(has(lean.out, "grains: linear, normal force only, uniform properties"));
  CHECK(has(lean.out, "stage fall: 100 cycles"));
  CHECK_FALSE(has(lean.out, "  wx "));
  const ProgramEnd full = at.with(scene(frictional), {"explain", "scene.yaml"});
  CHECK_FALSE(has(full.out, "spin and moment of balls: "));
  CHECK(has(full.out, "  wx "));
  CHECK(has(full.out, "spring"));
  CHECK_FALSE(std::filesystem::exists(at.folder / "scene.out"));
}

TEST_CASE("explain counts the bytes of a ball and of a contact") {
  const Folder at;
  const Json lean = Json::parse(at.with(scene(frictionless), {"explain", "--json", "scene.yaml"}).out);
  const Json full = Json::parse(at.with(scene(frictional), {"explain", "--json", "scene.yaml"}).out);
  // Beside spin (3 doubles) the force record grows from 4 to 8 doubles; a contact remembers one vector.
  CHECK(full.at("bytes_per_ball").get<int>() - lean.at("bytes_per_ball").get<int>() == 7 * 8);
  CHECK(lean.at("per_contact").at(0).at("bytes") == 9);
  CHECK(full.at("per_contact").at(0).at("bytes") == 9 + 3 * 8);
  CHECK(lean.at("timestep").at("automatic") == true);
  // A bond with a wall also knows a point of its plane, its normal and a distance, 7 doubles and a flag.
  CHECK(full.at("per_wall_contact").size() == 1);
  std::string bonds = scene(frictional + ", cb_tenf: 1, cb_shearf: 1");
  bonds.replace(bonds.find("model: linear"), 13, "model: contact_bond");
  const Json bonded = Json::parse(at.with(bonds, {"explain", "--json", "scene.yaml"}).out);
  CHECK(bonded.at("per_wall_contact").at(1).at("bytes") == 8 * 8);
}

TEST_CASE("run ends with its result on stdout") {
  const Folder at;
  const ProgramEnd end = at.with(scene(frictional), {"run", "scene.yaml", "--quiet"});
  INFO(end.err);
  REQUIRE(end.code == 0);
  CHECK(has(end.out, "done after 100 cycles"));
  CHECK(has(end.out, "results in scene.out"));
  const ProgramEnd json = at.with(scene(frictional), {"run", "scene.yaml", "--json", "-o", "other"});
  REQUIRE(json.code == 0);
  CHECK(Json::parse(json.out) == Json::parse(read_text(at.folder / "other/summary.json")));
  CHECK(Json::parse(json.out).at("left_out").size() > 3);
}
