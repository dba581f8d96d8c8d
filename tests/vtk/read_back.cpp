// What the vtk writer writes, read back by VTK's own reader (Debian: python3-vtk9). Without VTK these tests fail; they
// are never skipped.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/catch.hpp"
#include "support/frame_files.hpp"
#include "support/opened.hpp"
#include "support/paths.hpp"

namespace {

using support::MemoryFiles;
using support::Object;
using support::SampleFrame;

/// Writes `frames` sample frames and returns what the script says of them: 0 when every array is right.
int read_back(std::size_t balls, std::size_t contacts, uint32_t frames, bool damage) {
  const auto& writer = support::opened<scree_writer>("writer", "vtk");
  Object object(writer.object);
  MemoryFiles files;
  REQUIRE(writer.open(object.self(), "view", files.table(), nullptr) == 0);
  for (uint32_t k = 0; k < frames; ++k) {
    SampleFrame frame(k, balls, contacts);
    REQUIRE(writer.frame(object.self(), &frame.frame, files.table()) == 0);
  }
  REQUIRE(writer.close(object.self(), files.table()) == 0);
  const auto folder = std::filesystem::temp_directory_path() / ("scree_vtk_" + std::to_string(getpid()));
  for (auto& [name, content] : files.content) {
    std::filesystem::create_directories((folder / name).parent_path());
    if (damage && name.find("balls/") == 0) content[content.find("\n_") + 2 + 40] ^= 1;
    std::ofstream(folder / name, std::ios::binary) << content;
  }
  const std::string command = std::string(SCREE_VTK_PYTHON) + " '" + support::source_dir() +
                              "/tests/vtk/read_back.py' '" + folder.string() + "' " + std::to_string(balls) + " " +
                              std::to_string(contacts) + " " + std::to_string(frames);
  const int status = std::system(command.c_str());
  std::filesystem::remove_all(folder);
  return status;
}

}  // namespace

TEST_CASE("VTK reads every array of a written frame bit for bit", "[vtk]") {
  CHECK(read_back(1000, 50, 2, false) == 0);
}
TEST_CASE("VTK reads frames of no ball and of one ball", "[vtk]") {
  CHECK(read_back(0, 0, 1, false) == 0);
  CHECK(read_back(1, 1, 3, false) == 0);
}
TEST_CASE("the comparison notices one changed bit", "[vtk]") { CHECK(read_back(10, 0, 1, true) != 0); }
