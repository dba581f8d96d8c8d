#include <functional>
#include <limits>
#include <random>

#include "core/run/packing.hpp"
#include "unit/run/saved_run.hpp"

// A file whose hashes are right but whose values are not those of a run: it must be refused with the section named, or
// do no harm. The archive's own checks (damage, truncation) are in archive_test.cpp.

using namespace scree::core;
using namespace support;

namespace {

const char* const pile = R"(scree: 1
vars: {edge: 0.06}
cell: {low: [0, 0, -0.01], high: [edge, edge, 0.1], periodic: [x, y]}
walls:
  floor: {wall: plane, point: [0, 0, 0.0002], normal: [0, 0, 1]}
balls:
  sand: {generator: lattice, kind: fcc, radius: 3 mm, spacing: 5.9 mm, box: [[0, 0, 0], [0.058, 0.058, 0.02]],
         density: 2600, contact: {fric: "0.3 + x"}}
contacts:
  - {name: grains, between: [sand, sand], model: linear, kn: 2e5, ks: 1e5}
  - {name: sides, between: [sand, walls], model: linear, kn: 2e5, ks: 1e5, fric: 0.5}
processes:
  pull: {process: gravity, acceleration: [0, 0, -9.81]}
  damping: {process: local_damping, factor: 0.1}
stages: [{settle: [{cycle: 100}]}]
)";

/// Changes the values of one section; gets them as they are.
struct Change {
  std::string section;
  std::function<void(std::vector<uint8_t>&)> u8 = {};
  std::function<void(std::vector<uint16_t>&)> u16 = {};
  std::function<void(std::vector<uint32_t>&)> u32 = {};
  std::function<void(std::vector<uint64_t>&)> u64 = {};
  std::function<void(std::vector<double>&)> f64 = {};
};

template <class T>
bool copied(const ArchiveReader& in, ArchiveWriter& out, const std::string& name,
            const std::function<void(std::vector<T>&)>* change) {
  try {
    std::vector<T> values = in.get<T>(name);
    if (change != nullptr && *change) (*change)(values);
    out.put(name, values);
    return true;
  } catch (const Refusal&) {
    return false;  // another type
  }
}

void copy_changed(const std::string& from, const std::string& to, const Change& change) {
  const ArchiveReader in(from);
  ArchiveWriter out(to);
  for (const std::string& name : in.names()) {
    const bool here = name == change.section;
    if (copied(in, out, name, here ? &change.u8 : nullptr) || copied(in, out, name, here ? &change.u16 : nullptr) ||
        copied(in, out, name, here ? &change.u32 : nullptr) || copied(in, out, name, here ? &change.u64 : nullptr) ||
        copied(in, out, name, here ? &change.f64 : nullptr))
      continue;
    if (name == "scene/file" || name == "scene/text")
      out.put_text(name, in.get_text(name));
    else
      out.put_texts(name, in.get_texts(name));
  }
  REQUIRE(out.commit());
}

/// What loading says: "" when it is accepted; then the run goes on a little.
std::string refusal(const std::string& path, Catalogue& catalogue, uint64_t cycles) {
  const ArchiveReader in(path);
  try {
    Simulation simulation(saved_scene(in, catalogue), catalogue, 2, 0);
    load_state(simulation, in);
    run(simulation, cycles);
  } catch (const NumericalStop&) {
    return "";
  } catch (const Refusal& refused) {
    return refused.what();
  }
  return "";
}

void save_pile(const std::string& path, Catalogue& catalogue) {
  Simulation simulation(read_scene({"", pile, {}, {}}, catalogue), catalogue, 1, 0);
  simulation.set_up();
  simulation.prepare();
  run(simulation, 4);
  simulation.engine.forces();
  REQUIRE(simulation.engine.contacts.active() > 50);
  REQUIRE(simulation.engine.walls[0].contacts > 10);
  save(simulation, path);
}

Change u8(const std::string& name, std::function<void(std::vector<uint8_t>&)> f) {
  return Change{name, f, {}, {}, {}, {}};
}
Change u16(const std::string& name, std::function<void(std::vector<uint16_t>&)> f) {
  return Change{name, {}, f, {}, {}, {}};
}
Change u32(const std::string& name, std::function<void(std::vector<uint32_t>&)> f) {
  return Change{name, {}, {}, f, {}, {}};
}
Change u64(const std::string& name, std::function<void(std::vector<uint64_t>&)> f) {
  return Change{name, {}, {}, {}, f, {}};
}
Change f64(const std::string& name, std::function<void(std::vector<double>&)> f) {
  return Change{name, {}, {}, {}, {}, f};
}

std::vector<Change> changes_of_contacts() {
  return {
      u64("contacts/shape", [](auto& v) { v[1] += 1; }),
      u64("contacts/shape", [](auto& v) { v[0] = 2; }),
      u32("contacts/rows_before", [](auto& v) { v.push_back(0); }),
      u64("contacts/0/begin", [](auto& v) { v[4] = v[v.size() - 1] + 1; }),
      u64("contacts/0/begin", [](auto& v) { v.back() += 1; }),
      u64("contacts/0/begin", [](auto& v) { v[0] = 1; }),
      u64("contacts/0/begin", [](auto& v) { v.clear(); }),
      u32("contacts/0/other", [](auto& v) { v[0] = 0; }),
      u32("contacts/0/other", [](auto& v) { v.back() = 4000000000u; }),
      u32("contacts/0/where", [](auto& v) { v[0] ^= 0x80000000u; }),
      u32("contacts/0/where", [](auto& v) { v[0] |= 3u << 24; }),
      u32("contacts/0/where", [](auto& v) { v[0] |= 1u << 28; }),
      u8("contacts/0/active", [](auto& v) { v[0] = 2; }),
      u64("contacts/0/words", [](auto& v) { v[0] = 1000000; }),
      u64("contacts/0/words", [](auto& v) { v[0] = 0; }),
      f64("contacts/0/state/0", [](auto& v) { v.pop_back(); }),
      f64("contacts/0/property/0", [](auto& v) { v.push_back(1); }),
      u32("wall_lists/block", [](auto& v) { v[0] = 7; }),
      u16("wall_lists/wall", [](auto& v) { v[0] = 1; }),
      u16("wall_lists/rule", [](auto& v) { v[0] = 2; }),
      u64("wall_lists/sizes", [](auto& v) { v[0] += 1; }),
      u64("wall_lists/sizes", [](auto& v) { v[1] = ~uint64_t{0}; }),
      u32("wall_lists/candidate", [](auto& v) { v[0] = 4000000; }),
      u32("wall_lists/slot_row", [](auto& v) { v[0] = 4000000; }),
      f64("wall_lists/state", [](auto& v) { v.pop_back(); }),
  };
}

std::vector<Change> changes_of_the_rest() {
  return {
      u64("balls/id", [](auto& v) { v[1] = v[0]; }),
      u64("balls/id", [](auto& v) { v[1] = 0; }),
      u64("balls/next_id", [](auto& v) { v[0] = 3; }),
      u16("balls/group", [](auto& v) { v[5] = 1; }),
      f64("balls/x", [](auto& v) { v.pop_back(); }),
      f64("balls/x", [](auto& v) { v[3] = std::numeric_limits<double>::quiet_NaN(); }),
      f64("balls/radius", [](auto& v) { v[3] = 0; }),
      f64("balls/mass", [](auto& v) { v[3] = -1; }),
      f64("balls/property/fric", [](auto& v) { v.push_back(1); }),
      f64("forces", [](auto& v) { v.pop_back(); }),
      u16("words/precedence", [](auto& v) { v[0] = 9; }),
      u8("clock", [](auto& v) { v.pop_back(); }),
      u8("position", [](auto& v) { v[0] = 5; }),
      u8("walls", [](auto& v) { v[0] = 2; }),
      u8("words/rules", [](auto& v) { v.push_back(0); }),
      u8("rules/bound", [](auto& v) { v[0] = 3; }),
      u64("scene/hash", [](auto& v) { v[0] ^= 1; }),
  };
}

}  // namespace

TEST_CASE("a state whose indices do not fit is refused and the section is named") {
  const TemporaryFolder folder;
  Catalogue catalogue(plugins_of_build());
  save_pile(folder / "good", catalogue);
  copy_changed(folder / "good", folder / "same", {"", {}, {}, {}, {}, {}});
  REQUIRE(read_text(folder / "good") == read_text(folder / "same"));
  std::vector<Change> changes = changes_of_contacts();
  for (const Change& change : changes_of_the_rest()) changes.push_back(change);
  for (const Change& change : changes) {
    copy_changed(folder / "good", folder / "bad", change);
    const std::string said = refusal(folder / "bad", catalogue, 0);
    INFO("section " << change.section << ": " << said);
    CHECK(said.find(folder / "bad") != std::string::npos);
    // A size that differs is told at the section that was read second, so the folder of sections must fit.
    const std::string stem = change.section.substr(0, change.section.find('/'));
    CHECK(said.find("'" + (stem == "scene" || stem == "contacts" || stem == "balls" || stem == "wall_lists"
                               ? stem + "/"
                               : change.section + "'")) != std::string::npos);
  }
}

TEST_CASE("random values in a state are refused or do no harm") {
  const TemporaryFolder folder;
  Catalogue catalogue(plugins_of_build());
  save_pile(folder / "good", catalogue);
  const std::vector<std::string> sections = ArchiveReader(folder / "good").names();
  std::mt19937_64 random(20240611);
  const auto disturb = [&](auto& values) {
    if (values.empty()) return;
    using T = std::remove_reference_t<decltype(values[0])>;
    const std::size_t at = random() % values.size();
    switch (random() % 4) {
      case 0:
        values[at] = static_cast<T>(random());
        break;
      case 1:
        values[at] = static_cast<T>(values[at] + T{1});
        break;
      case 2:
        values[at] = values[random() % values.size()];
        break;
      default:
        values.resize(at);
    }
  };
  int refused = 0;
  constexpr int rounds = 300;
  for (int k = 0; k < rounds; ++k) {
    const std::string& name = sections[random() % sections.size()];
    INFO("round " << k << ", section " << name);
    copy_changed(folder / "good", folder / "bad", {name, disturb, disturb, disturb, disturb, {}});
    REQUIRE_NOTHROW(refused += refusal(folder / "bad", catalogue, 2).empty() ? 0 : 1);
  }
  CHECK(refused > rounds / 10);
}
