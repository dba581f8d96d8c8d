#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/catch.hpp"
#include "support/paths.hpp"
#include "unit/scene_fakes.hpp"

using namespace scree::core;
namespace fs = std::filesystem;

namespace {

const std::string folder = support::source_dir() + "/tests/scenes_broken/";

std::string text_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The messages of a broken scene without the folder of the sources; "accepted" when there are none.
std::string messages_of(const fs::path& scene) {
  ReadOptions options;
  options.file = scene.string();
  std::string out = "accepted\n";
  try {
    read_scene(options, fake_components());
  } catch (const Refusal& refusal) {
    REQUIRE((refusal.code() == Exit::scene || refusal.code() == Exit::plugin));
    out = std::string(refusal.what()) + "\n";
  }
  for (size_t at = out.find(folder); at != std::string::npos; at = out.find(folder)) out.erase(at, folder.size());
  return out;
}

}  // namespace

// After a change of wording: SCREE_WRITE_GOLDEN=1 test_unit "every broken scene*", then read the difference with git.
TEST_CASE("every broken scene is refused with the messages beside it") {
  const bool write = std::getenv("SCREE_WRITE_GOLDEN") != nullptr;
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") scenes.push_back(entry.path());
  std::sort(scenes.begin(), scenes.end());
  REQUIRE(scenes.size() >= 60);
  for (const fs::path& scene : scenes) {
    fs::path golden = scene;
    golden.replace_extension(".txt");
    const std::string messages = messages_of(scene);
    if (write) std::ofstream(golden, std::ios::binary) << messages;
    INFO(scene.filename().string());
    CHECK(messages != "accepted\n");
    CHECK(messages == text_of(golden));
    CHECK_FALSE(write);
  }
}
