// What the built program says about every wrong library, word by word: tests/loader/sentences.txt.
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/plugin/first_size.hpp"
#include "loader/plugin_folder.hpp"
#include "support/catch.hpp"
#include "support/program.hpp"

namespace {
using namespace scree::test;
namespace fs = std::filesystem;

struct Sentence {
  std::string library, state, text;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// Lines `library | state | text`; what depends on this build is written as a word in capitals.
std::vector<Sentence> sentences() {
  std::vector<Sentence> all;
  std::ifstream in(support::source_dir() + "/tests/loader/sentences.txt");
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t first = line.find(" | "), second = line.find(" | ", first + 1);
    REQUIRE(second != std::string::npos);
    Sentence one{line.substr(0, first), line.substr(first + 3, second - first - 3), line.substr(second + 3)};
    one.text = replaced(one.text, "THIS_FILE", "DIR/contact_model/" + one.library + ".so");
    one.text = replaced(one.text, "THIS_MODEL",
                        "DIR/contact_model/" + one.library + ".so: contact_model '" + one.library + "'");
    one.text = replaced(one.text, "THIS_BUILD", support::binary_dir());
    one.text = replaced(one.text, "THIS_ABI", std::to_string(SCREE_ABI_MAJOR) + "." + std::to_string(SCREE_ABI_MINOR));
    one.text = replaced(one.text, "HEADER_BYTES", std::to_string(sizeof(scree_plugin_header)));
    one.text = replaced(one.text, "COMPONENT_BYTES", std::to_string(sizeof(scree_component)));
    one.text = replaced(one.text, "TABLE_BYTES", std::to_string(scree::core::first_size<scree_contact_model>));
    one.text = replaced(one.text, "PROPERTY_BYTES", std::to_string(sizeof(scree_property)));
    all.push_back(one);
  }
  return all;
}

/// Files that no compiler makes, each from the right library.
const std::map<std::string, std::function<void(const PluginFolder&, const std::string&)>> made = {
    {"text_file", [](const PluginFolder& f, const std::string& n) { std::ofstream(f.file(n)) << "kn: 1e6\n"; }},
    {"empty", [](const PluginFolder& f, const std::string& n) { std::ofstream(f.file(n)); }},
    {"folder", [](const PluginFolder& f, const std::string& n) { fs::create_directory(f.file(n)); }},
    {"pipe", [](const PluginFolder& f, const std::string& n) { REQUIRE(::mkfifo(f.file(n).c_str(), 0644) == 0); }},
    {"no_target",
     [](const PluginFolder& f, const std::string& n) { fs::create_symlink("/nowhere/scree.so", f.file(n)); }},
    {"cut_short",
     [](const PluginFolder& f, const std::string& n) {
       f.put("good.so", n);
       fs::resize_file(f.file(n), 3000);
     }},
    {"other_machine",
     [](const PluginFolder& f, const std::string& n) {
       f.put("good.so", n);
       std::fstream(f.file(n), std::ios::in | std::ios::out | std::ios::binary).seekp(18).put('\xf3');  // RISC-V
     }},
    {"for_everybody",
     [](const PluginFolder& f, const std::string& n) {
       f.put("good.so", n);
       ::chmod(f.file(n).c_str(), 0646);
     }},
    {"program", [](const PluginFolder& f, const std::string& n) { f.put("program", n); }},
    {"stranger",
     [](const PluginFolder& f, const std::string& n) {
       f.put("good.so", n);
       REQUIRE(::chown(f.file(n).c_str(), 12345, 12345) == 0);
     }},
};

/// What this machine cannot make.
bool left_out(const std::string& library) {
  if (library == "stranger") return ::geteuid() != 0;
  if (library == "unique") return !fs::exists(support::binary_dir() + "/tests/wrong/unique.so");
  return false;
}

void put(const PluginFolder& folder, const std::string& library) {
  if (const auto found = made.find(library); found != made.end())
    found->second(folder, library);
  else
    folder.put(library + ".so", library);
}

std::string scene(const std::string& model) {
  return "scree: 1\nballs:\n  sand: {generator: lattice, kind: sc, radius: 0.01, box: [[0, 0, 0], [0.02, 0.02, 0.04]], "
         "density: 2600}\ncontacts:\n  - {name: grains, between: [sand, sand], model: \"" +
         model + "\", kn: 1e5}\nstages:\n  - go: [cycle: 1]\n";
}

std::string without(const PluginFolder& folder, const std::string& text) {
  return replaced(text, folder.path().string(), "DIR");
}

}  // namespace

TEST_CASE("every wrong library has its sentence, at least 25 of them") {
  std::set<std::string> told;
  for (const Sentence& one : sentences()) CHECK(told.insert(one.library).second);
  for (const auto& entry : fs::directory_iterator(support::binary_dir() + "/tests/wrong")) {
    const std::string name = entry.path().stem().string();
    INFO(name);
    if (name != "good" && name != "evidence") CHECK(told.count(name) == 1);
  }
  CHECK(told.size() >= 25);
}

TEST_CASE("scree list shows every wrong library with its sentence, and none ends it") {
  const PluginFolder folder;
  const std::vector<Sentence> all = sentences();
  for (const Sentence& one : all)
    if (!left_out(one.library)) put(folder, one.library);
  const std::vector<std::string> words = {"list", "contact_model", "--plugins", folder.path().string(), "--no-color"};
  const support::ProgramEnd text = support::scree(words);
  std::vector<std::string> json_words = words;
  json_words.push_back("--json");
  const support::ProgramEnd json = support::scree(json_words);
  INFO(json.err);
  CHECK(text.code == 0);
  REQUIRE(json.code == 0);
  std::map<std::string, nlohmann::json> shown;
  // Valid JSON although a library writes to stdout as it is loaded.
  for (const auto& entry : nlohmann::json::parse(json.out)) shown[entry["name"]] = entry;
  for (const Sentence& one : all) {
    if (left_out(one.library)) continue;
    INFO(one.library);
    const nlohmann::json& entry = shown[one.library];
    CHECK(entry.value("state", "") == (one.state == "refused" ? "refused" : "ok"));
    if (one.state == "refused") {
      CHECK(without(folder, entry.value("reason", "")) == one.text);
      CHECK(without(folder, text.out).find("refused: " + one.text + "\n") != std::string::npos);
    }
    if (one.state == "warning")
      CHECK(without(folder, json.err).find("warning: " + one.text + "\n") != std::string::npos);
  }
}

TEST_CASE("a scene that names a wrong library ends with its sentence and exit code 4") {
  for (const Sentence& one : sentences()) {
    if (left_out(one.library)) continue;
    INFO(one.library);
    const PluginFolder folder;
    const TemporaryFolder here;
    put(folder, one.library);
    write_text(here / "scene.yaml", scene(one.library));
    const support::ProgramEnd end =
        support::scree({"check", "scene.yaml", "--plugins", folder.path().string(), "--no-color"}, here.path());
    INFO(end.err);
    CHECK(end.signal == 0);
    CHECK(end.code == (one.state == "refused" ? 4 : 0));
    if (one.state != "fine") CHECK(without(folder, end.err).find(one.text) != std::string::npos);
  }
}

TEST_CASE("no code of a library runs unless its folder is one for plug-ins") {
  const TemporaryFolder here;
  const PluginFolder folder;
  folder.put("evidence.so", "evidence");
  fs::create_directory(here / "contact_model");
  for (const char* place : {"evidence.so", "evidence", "contact_model/evidence.so", "libevidence.so"})
    fs::copy_file(folder.file("evidence"), here / place);
  const std::string proof = here / "proof";
  ::setenv("SCREE_TEST_EVIDENCE", proof.c_str(), 1);
  ::setenv("LD_LIBRARY_PATH", here.path().c_str(), 1);
  for (const std::string& model :
       std::vector<std::string>{"evidence", "evidence.so", "./evidence.so", "contact_model/evidence", "../evidence",
                                here / "evidence.so", here / "contact_model/evidence"}) {
    INFO(model);
    write_text(here / "scene.yaml", scene(model));
    const support::ProgramEnd end = support::scree({"run", "scene.yaml"}, here.path());
    INFO(end.err);
    CHECK(end.code == 4);
    CHECK(end.err.find("scene.yaml:5:") != std::string::npos);
    CHECK_FALSE(fs::exists(proof));
  }
  CHECK(support::scree({"list"}, here.path()).out.find("evidence") == std::string::npos);
  CHECK_FALSE(fs::exists(proof));
  // The same library in a folder that was named does leave its trace, so the trace would have been seen.
  write_text(here / "scene.yaml", scene("evidence"));
  CHECK(support::scree({"check", "scene.yaml", "--plugins", folder.path().string()}, here.path()).code == 0);
  CHECK(fs::exists(proof));
  ::unsetenv("SCREE_TEST_EVIDENCE");
  ::unsetenv("LD_LIBRARY_PATH");
}

TEST_CASE("a folder that everybody may write to, and two files of one name, through the program") {
  const TemporaryFolder here;
  write_text(here / "scene.yaml", scene("spring"));
  const PluginFolder first, second;
  first.put("good.so");
  second.put("good.so");
  const support::ProgramEnd two = support::scree(
      {"check", "scene.yaml", "--plugins", first.path().string(), "--plugins", second.path().string()}, here.path());
  INFO(two.err);
  // Both folders were given: the first wins, and the second is told.
  CHECK(two.code == 0);
  CHECK(two.err.find(first.file().string() + ": shadows " + second.file().string()) != std::string::npos);
  ::chmod((first.path() / "contact_model").c_str(), 0777);
  const support::ProgramEnd open =
      support::scree({"check", "scene.yaml", "--plugins", first.path().string()}, here.path());
  CHECK(open.code == 4);
  CHECK(without(first, open.err)
            .find("DIR/contact_model: everybody may write to this folder, so anybody could change "
                  "the code that would run here: chmod o-w DIR/contact_model") != std::string::npos);
}
