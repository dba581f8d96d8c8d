// A scene pays only for what it uses: without friction there is no spin, no moment, no shear state, no library that the
// scene does not name, and less memory.
#include <nlohmann/json.hpp>
#include <set>

#include "stability/lab.hpp"
#include "support/catch.hpp"
#include "support/program.hpp"

using namespace scree::core;

namespace {

std::string pile(const std::string& law, int across) {
  return "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n"
         "balls:\n  sand: {generator: lattice, kind: fcc, radius: 5 mm, spacing: 9.999 mm, density: 2600,\n"
         "         box: [[0, 0, 0], [" +
         std::to_string(0.0071 * across * 2) + ", " + std::to_string(0.0071 * across * 2) + ", " +
         std::to_string(0.0071 * across * 2) +
         "]]}\n"
         "contacts:\n  - {name: all, between: [sand, [sand, floor]], model: linear, kn: 1e5, " +
         law + "}\nstages:\n  - hold: [cycle: 3]\n";
}
const std::string frictionless = "ks: 0, fric: 0", frictional = "ks: 5e4, fric: 0.5";

std::set<std::string> columns(const Simulation& simulation) {
  std::set<std::string> names;
  for (const Balls::Listed& listed : simulation.engine.balls.list()) names.insert(listed.name);
  return names;
}

double peak_memory(const std::string& law) {
  const TemporaryFolder folder;
  write_text(folder / "scene.yaml", pile(law, 20));
  const support::ProgramEnd end = support::scree({"run", "scene.yaml", "--quiet", "-j", "1"}, folder.path());
  INFO(end.err);
  REQUIRE(end.code == 0);
  const auto summary = nlohmann::json::parse(read_text(folder / "scene.out/summary.json"));
  REQUIRE(summary.at("balls").get<double>() > 20000);
  REQUIRE(summary.at("contacts").get<double>() > 100000);
  return summary.at("peak_memory_bytes").get<double>() / summary.at("balls").get<double>();
}

}  // namespace

TEST_CASE("a frictionless scene has no spin, no moment and no shear state") {
  lab::Lab here;
  const auto lean = here.make(pile(frictionless, 4)), full = here.make(pile(frictional, 4));
  lab::run(*lean, 3);
  lab::run(*full, 3);
  for (const char* name : {"wx", "wy", "wz", "moment_x", "moment_y", "moment_z"}) {
    INFO(name);
    CHECK(columns(*lean).count(name) == 0);
  }
  for (const Column c : {Column::wx, Column::wy, Column::wz}) {
    CHECK_FALSE(lean->engine.balls.has(c));
    CHECK(full->engine.balls.has(c));
    CHECK(columns(*full).count(Balls::name(c)) == 1);
  }
  REQUIRE(lean->engine.contacts.active() > 100);
  for (const TouchList& list : lean->engine.contacts.lists()) CHECK(list.state.empty());
  for (const WallList& list : lean->engine.contacts.wall_lists()) CHECK(list.state.empty());
  CHECK(lean->engine.contacts.slices().stride() == Slices::lean);
  CHECK(full->engine.contacts.slices().stride() == Slices::with_spin);
  for (const TouchList& list : full->engine.contacts.lists()) CHECK(list.state.size() == (list.bonded ? 0 : 3));
}

TEST_CASE("a scene opens no library that it does not name") {
  lab::Lab here;
  const auto lean = here.make(pile(frictionless, 2));
  lab::run(*lean, 1);
  std::set<std::string> opened;
  for (const Component* component : here.catalogue().opened())
    opened.insert(std::string(kind_name(component->kind)) + "/" + component->name);
  CHECK(opened == std::set<std::string>{"wall/plane", "generator/lattice", "contact_model/linear"});
  CHECK(here.catalogue().found().size() > 5);
}

TEST_CASE("a frictionless scene needs less memory at its peak") {
  const double lean = peak_memory(frictionless), full = peak_memory(frictional);
  // Spin (3), force records (4 more), shear state (3 per contact, 6 contacts a ball): 25 doubles a ball.
  CHECK(full - lean > 150);
  lab::measured("leaving out", "peak memory without friction " + lab::number(lean) + ", with " + lab::number(full) +
                                   " bytes a ball (dense lattice, whole process)");
}
