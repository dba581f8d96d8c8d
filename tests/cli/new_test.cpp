// `scree new` and `scree schema`: what they make, what they refuse. That the folders build is tested in tests/sdk.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/program.hpp"
#include "support/temporary_folder.hpp"

using support::ProgramEnd;
using support::scree;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("new makes a folder without a trace of the template", "[new]") {
  const TemporaryFolder folder;
  for (const char* kind : {"contact_model", "wall", "generator", "process", "writer"}) {
    const std::string name = std::string("my_") + kind;
    const ProgramEnd end = scree({"new", kind, name}, folder.path());
    INFO(end.err);
    REQUIRE(end.code == 0);
    CHECK(has(end.out, "cd " + name + "\n"));
    for (const char* file : {"CMakeLists.txt", "CMakeUserPresets.json", "README.md", "scene.yaml", ".gitignore"})
      CHECK(fs::exists(folder / (name + "/" + file)));
    CHECK(has(read_text(folder / (name + "/" + name + ".cpp")), "struct My"));
    CHECK(Json::parse(read_text(folder / (name + "/scree.schema.json"))).contains("definitions"));
    CHECK(
        read_text(folder / (name + "/scene.yaml")).starts_with("# yaml-language-server: $schema=scree.schema.json\n"));
    for (const auto& entry : fs::directory_iterator(folder / name)) {
      INFO(entry.path().string());
      for (const char* word : {"plugin_name", "PluginName", "plugin_kind", "scree_prefix"}) {
        CHECK_FALSE(has(entry.path().filename().string(), word));
        CHECK_FALSE(has(read_text(entry.path().string()), word));
      }
    }
  }
}

TEST_CASE("new says what it made as JSON, below the folder that was asked for", "[new]") {
  const TemporaryFolder folder;
  const Json made = Json::parse(scree({"new", "wall", "dish", "-o", "deep/er", "--json"}, folder.path()).out);
  CHECK(made.at("folder") == "deep/er/dish");
  CHECK(made.at("next").at(0) == "cd deep/er/dish");
  for (const std::string file : made.at("files")) CHECK(fs::exists(folder / ("deep/er/dish/" + file)));
}

TEST_CASE("new refuses names that cannot be", "[new]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& kind, const std::string& name, const std::string& why) {
    const ProgramEnd end = scree({"new", kind, name}, folder.path());
    INFO(name << ": " << end.err);
    CHECK(end.code == 2);
    CHECK(has(end.err, why));
    CHECK(fs::is_empty(folder.path()));
  };
  for (const char* name : {"my-wall", "2d", "_wall", "a/b", "..", "w\xc3\xa4nd", ""})
    refused("wall", name, "a letter in front, as in rolling_disc");
  refused("wall", std::string(65, 'a'), "longer than 64 letters");
  refused("wall", "union", "it is a word of C++");
  refused("contact_model", "none", "'model: none' says in scenes that pieces do not interact");
  refused("wall", "plane", "there is one of this name already, ");
  refused("wal", "dish", "did you mean 'wall'?");
  // Another kind may use the name.
  CHECK(scree({"new", "writer", "plane"}, folder.path()).code == 0);
  CHECK(scree({"new", "wall"}, folder.path()).code == 2);
}

TEST_CASE("new leaves a folder alone that exists, and says what it cannot write", "[new]") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "dish");
  const ProgramEnd there = scree({"new", "wall", "dish"}, folder.path());
  CHECK(there.code == 6);
  CHECK(has(there.err, "dish: exists already and is left alone"));
  CHECK(fs::is_empty(folder / "dish"));
  write_text(folder / "file", "");
  const ProgramEnd below = scree({"new", "wall", "dish", "-o", "file/x"}, folder.path());
  CHECK(below.code == 6);
  CHECK(has(below.err, "file/x/dish"));
}

TEST_CASE("schema goes to stdout or into a file", "[schema]") {
  const TemporaryFolder folder;
  const ProgramEnd end = scree({"schema"}, folder.path());
  CHECK(end.code == 0);
  const Json schema = Json::parse(end.out);
  CHECK(schema.at("$schema") == "http://json-schema.org/draft-07/schema#");
  CHECK(has(end.out, "\"local_damping\""));
  CHECK(scree({"schema", "-o", "scree.schema.json"}, folder.path()).out.empty());
  CHECK(read_text(folder / "scree.schema.json") == end.out);
  const ProgramEnd nowhere = scree({"schema", "-o", "no/such/folder.json"}, folder.path());
  CHECK(nowhere.code == 6);
  CHECK(has(nowhere.err, "no/such/folder.json: cannot write the schema: No such file or directory"));
}

TEST_CASE("schema leaves out what is refused, and says so", "[schema]") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "wall");
  write_text(folder / "wall/broken.so", "not a library");
  const ProgramEnd end = scree({"schema", "--plugins", folder.path()});
  CHECK(end.code == 0);
  CHECK(has(end.err, "broken.so"));
  CHECK(has(end.err, "the schema does not know it"));
  CHECK_FALSE(has(end.out, "\"broken\""));
}
