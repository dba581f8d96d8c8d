#include <fstream>
#include <sstream>

#include "core/scene/scene.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

using namespace scree::core;

TEST_CASE("the scene of docs/scenes.md is accepted with the built-in plug-ins, and opens only those it names") {
  std::ifstream stream(support::source_dir() + "/docs/scenes.md");
  std::ostringstream page;
  page << stream.rdbuf();
  const std::string text = page.str();
  const size_t start = text.find("```yaml\nscree: 1");
  REQUIRE(start != std::string::npos);
  ReadOptions options;
  options.text = text.substr(start + 8, text.find("```", start + 8) - start - 8);
  Catalogue catalogue(SearchPath::standard({}));
  const Scene scene = read_scene(options, catalogue);
  REQUIRE(scene.contacts[0].model.component->name == "linear");
  REQUIRE(scene.contacts[0].model.form == 1);  // emod kratio
  std::vector<std::string> opened;
  for (const Component* component : catalogue.opened()) opened.push_back(component->name);
  REQUIRE(opened ==
          std::vector<std::string>{"plane", "box", "random", "linear", "gravity", "local_damping", "csv", "vtk"});
}

TEST_CASE("a plug-in that is not there is refused with exit code 4 at the place that names it") {
  ReadOptions options;
  options.text = "scree: 1\nwalls: {floor: {wall: plan}}\n";
  Catalogue catalogue(SearchPath::standard({}));
  try {
    read_scene(options, catalogue);
    FAIL("accepted");
  } catch (const Refusal& refusal) {
    REQUIRE(refusal.code() == Exit::plugin);
    REQUIRE(std::string(refusal.what()).rfind("scene:2:23: error: ", 0) == 0);
    REQUIRE(std::string(refusal.what()).find("'plan'") != std::string::npos);
  }
}
