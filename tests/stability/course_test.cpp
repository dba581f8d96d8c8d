// The scenes of examples/course hold what their own expectations say, one after the other in one folder, as a reader
// runs them: the last one starts from what the one before it saved.
#include <algorithm>
#include <filesystem>
#include <vector>

#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/program.hpp"

TEST_CASE("every scene of the course passes its expectations") {
  namespace fs = std::filesystem;
  std::vector<std::string> scenes;
  const TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(support::source_dir() + "/examples/course")) {
    if (entry.path().extension() != ".yaml") continue;
    scenes.push_back(entry.path().filename().string());
    fs::copy(entry.path(), folder / scenes.back());
  }
  std::sort(scenes.begin(), scenes.end());
  REQUIRE(scenes.size() >= 5);
  for (const std::string& scene : scenes) {
    const support::ProgramEnd end = support::scree({"run", scene, "--quiet"}, folder.path());
    INFO(scene << "\n" << end.err << end.out);
    CHECK(end.code == 0);
    CHECK(end.out.find("passed") != std::string::npos);
  }
}
