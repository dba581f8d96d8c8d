#include <limits>

#include "support/catch.hpp"
#include "support/frame_files.hpp"
#include "support/opened.hpp"

namespace {

using support::MemoryFiles;
using support::Object;
using support::opened;
using support::SampleFrame;

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::string saved(const scree_writer& writer, const Object& object) {
  std::string bytes(writer.save(object.self(), nullptr, 0), '\0');
  REQUIRE(writer.save(object.self(), bytes.data(), bytes.size()) == bytes.size());
  return bytes;
}

}  // namespace

TEST_CASE("csv: header once, one row per frame, numbers that read back", "[plugin]") {
  const auto& writer = opened<scree_writer>("writer", "csv");
  CHECK(writer.wants == SCREE_WANTS_QUANTITIES);
  Object object(writer.object);
  MemoryFiles files;
  REQUIRE(writer.open(object.self(), "history", files.table(), nullptr) == 0);
  const std::vector<const char*> names{"time", "unbalanced", "max(a,b)", "say \"x\"", "walls.top.force.z"};
  SampleFrame first(0, 0, 0), second(1, 0, 0);
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> a{0, infinity, 0.1, 1e300, -1.0 / 3},
      b{0.1, std::numeric_limits<double>::quiet_NaN(), 3, 5e-324, 0};
  first.quantities(names, a);
  second.quantities(names, b);
  REQUIRE(writer.frame(object.self(), &first.frame, files.table()) == 0);
  REQUIRE(writer.frame(object.self(), &second.frame, files.table()) == 0);
  REQUIRE(files.content.size() == 1);
  CHECK(files.content["history.csv"] ==
        "cycle,time,unbalanced,\"max(a,b)\",\"say \"\"x\"\"\",walls.top.force.z\n"
        "0,0,inf,0.1,1e+300,-0.3333333333333333\n"
        "100,0.1,nan,3,5e-324,0\n");
  CHECK(std::stod("-0.3333333333333333") == -1.0 / 3);
}

TEST_CASE("csv: a resumed history goes on without a second header, and a full disk is told", "[plugin]") {
  const auto& writer = opened<scree_writer>("writer", "csv");
  MemoryFiles files;
  const std::vector<const char*> names{"a"};
  const std::vector<double> values{2};
  for (uint32_t index : {0u, 1u}) {  // a new object for each, as after a resume
    Object object(writer.object);
    REQUIRE(writer.open(object.self(), "h", files.table(), nullptr) == 0);
    SampleFrame frame(index, 0, 0);
    frame.quantities(names, values);
    files.full = true;
    CHECK(writer.frame(object.self(), &frame.frame, files.table()) != 0);
    files.full = false;
    REQUIRE(writer.frame(object.self(), &frame.frame, files.table()) == 0);
  }
  CHECK(files.content["h.csv"] == "cycle,time,a\n0,0,2\n100,0.1,2\n");
}

TEST_CASE("vtk: one file each for balls, contacts and walls, and a list of them", "[plugin]") {
  const auto& writer = opened<scree_writer>("writer", "vtk");
  Object object(writer.object);
  MemoryFiles files;
  REQUIRE(writer.open(object.self(), "view", files.table(), nullptr) == 0);
  SampleFrame bare(0, 2, 0), full(1, 2, 3);
  REQUIRE(writer.frame(object.self(), &bare.frame, files.table()) == 0);
  REQUIRE(writer.frame(object.self(), &full.frame, files.table()) == 0);
  REQUIRE(writer.close(object.self(), files.table()) == 0);
  std::vector<std::string> names;
  for (const auto& [name, content] : files.content) names.push_back(name);
  CHECK(names == std::vector<std::string>{"balls/view_000000.vtp", "balls/view_000001.vtp", "contacts/view_000001.vtp",
                                          "view.pvd", "walls/view_top%2E1_000000.vtp",
                                          "walls/view_top%2E1_000001.vtp"});
  const std::string& list = files.content["view.pvd"];
  CHECK(occurrences(list, "<DataSet ") == 5);
  CHECK(list.find(
            "<DataSet timestep=\"0.1\" group=\"\" part=\"1\" name=\"contacts\" file=\"contacts/view_000001.vtp\"/>") !=
        std::string::npos);
  files.full = true;
  CHECK(writer.frame(object.self(), &full.frame, files.table()) != 0);
}

TEST_CASE("vtk: the list survives a checkpoint, and long lists are not rewritten every time", "[plugin]") {
  const auto& writer = opened<scree_writer>("writer", "vtk");
  MemoryFiles files;
  std::string memory;
  {
    Object object(writer.object);
    REQUIRE(writer.open(object.self(), "view", files.table(), nullptr) == 0);
    for (uint32_t k = 0; k < 2000; ++k) {
      SampleFrame frame(k, 1, 0);
      REQUIRE(writer.frame(object.self(), &frame.frame, files.table()) == 0);
    }
    memory = saved(writer, object);
    CHECK(files.replaced < 2000 * 2 + 256 + 60);  // two files a frame; log(2000/256)/log(17/16) = 34 lists beyond 256
  }
  files.content.clear();
  Object object(writer.object);
  REQUIRE(writer.open(object.self(), "view", files.table(), nullptr) == 0);
  REQUIRE(writer.load(object.self(), memory.data(), memory.size()) == 0);
  SampleFrame frame(2000, 1, 0);
  REQUIRE(writer.frame(object.self(), &frame.frame, files.table()) == 0);
  REQUIRE(writer.close(object.self(), files.table()) == 0);
  CHECK(occurrences(files.content["view.pvd"], "<DataSet ") == 2 * 2001);
  CHECK(occurrences(files.content["view.pvd"], "balls/view_000000.vtp") == 1);
  CHECK(occurrences(files.content["view.pvd"], "balls/view_002000.vtp") == 1);
  CHECK(writer.load(object.self(), "x\n", 2) != 0);
}
