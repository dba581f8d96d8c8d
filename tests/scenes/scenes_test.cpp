// Every scene of this folder runs to its end and measures what it says.
#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/run/run.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

using namespace scree::core;

namespace {

std::vector<std::filesystem::path> scenes() {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() + "/tests/scenes"))
    if (entry.path().extension() == ".yaml") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

TEST_CASE("every verification scene measures its closed form") {
  REQUIRE(scenes().size() >= 11);
  for (const std::filesystem::path& path : scenes()) {
    INFO(path.filename().string());
    const TemporaryFolder folder;
    Catalogue catalogue(SearchPath{{support::plugin_dir()}, {}});
    ReadOptions read;
    read.file = path.string();
    RunOptions options;
    options.output = folder / "out";
    options.quiet = true;
    options.threads = 1;
    const RunResult result = run_scene(read_scene(read, catalogue), catalogue, options);
    INFO(result.summary.message);
    CHECK(result.code == Exit::done);
    CHECK_FALSE(result.summary.expectations.empty());
    for (const ExpectationResult& expectation : result.summary.expectations) {
      INFO(expectation.text);
      CHECK(expectation.passed);
      CHECK(expectation.equals);
      CHECK(expectation.tolerance.value_or(0) > 0);
      CHECK_FALSE(expectation.source.empty());
    }
  }
}
