// The scenes of examples/problems hold what their own expectations say.
#include <algorithm>
#include <filesystem>

#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/program.hpp"

TEST_CASE("every classic problem passes its expectations, and has a page") {
  namespace fs = std::filesystem;
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::recursive_directory_iterator(support::source_dir() + "/examples/problems"))
    if (entry.path().extension() == ".yaml") scenes.push_back(entry.path());
  std::sort(scenes.begin(), scenes.end());
  REQUIRE(scenes.size() >= 5);
  for (const fs::path& scene : scenes) {
    const auto beside = fs::directory_iterator(scene.parent_path());
    CHECK(std::any_of(fs::begin(beside), fs::end(beside),
                      [](const auto& entry) { return entry.path().extension() == ".md"; }));
    const TemporaryFolder folder;
    const support::ProgramEnd end = support::scree({"run", scene.string(), "--quiet"}, folder.path());
    INFO(scene << "\n" << end.err << end.out);
    CHECK(end.code == 0);
    CHECK(end.out.find("passed") != std::string::npos);
  }
}
