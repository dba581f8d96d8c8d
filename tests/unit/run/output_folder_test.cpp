#include "core/run/output_folder.hpp"

#include <filesystem>

#include "core/run/archive.hpp"
#include "core/run/checkpoint_files.hpp"
#include "core/run/summary.hpp"
#include "support/catch.hpp"
#include "support/child.hpp"
#include "support/temporary_folder.hpp"

using namespace scree::core;
namespace fs = std::filesystem;

namespace {

void put_checkpoint(const std::string& folder) {
  const CheckpointFiles files(folder);
  REQUIRE(files.prepare() == 0);
  ArchiveWriter out(files.latest);
  out.put_value<uint64_t>("cycle", 5);
  REQUIRE(out.commit(files.previous));
}

void put_summary(const std::string& folder, Exit code) {
  Summary summary;
  summary.exit_code = code;
  REQUIRE(write_summary(folder + "/summary.json", summary) == 0);
}

Refusal refused(const std::string& path, bool restart = false) {
  try {
    OutputFolder::create(path, restart);
  } catch (const Refusal& refusal) {
    return refusal;
  }
  FAIL("not refused: " << path);
  return {Exit::done, ""};
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a new output folder is made and locked") {
  const TemporaryFolder place;
  const std::string path = place / "job.out";
  {
    const OutputFolder folder = OutputFolder::create(path + "/", false);
    CHECK(folder.path() == path);
    CHECK(folder.moved_to().empty());
    const Refusal second = refused(path);
    CHECK(second.code() == Exit::folder_in_use);
    CHECK(holds(second.what(), ", pid " + std::to_string(::getpid()) + ", host "));
    const ChildEnd other = in_child([&] {
      try {
        OutputFolder::resume(path);
      } catch (const Refusal& refusal) {
        return static_cast<int>(refusal.code());
      }
      return 0;
    });
    CHECK(other.code == 9);
  }
  // Cut short before its first checkpoint: nothing is lost by moving it.
  CHECK(OutputFolder::create(path, false).moved_to() == path + ".1");
  CHECK(refused(place / "no/such/place.out").code() == Exit::io);
}

TEST_CASE("a finished run moves aside, to the number above the highest") {
  const TemporaryFolder place;
  const std::string path = place / "job.out";
  for (int k = 1; k <= 3; ++k) {
    fs::create_directory(place / ("job.out.x" + std::to_string(k)));
    const OutputFolder folder = OutputFolder::create(path, false);
    CHECK(folder.moved_to() == (k == 1 ? "" : path + "." + std::to_string(k - 1)));
    write_text(folder.file("mark"), std::to_string(k));
    put_checkpoint(path);
    put_summary(path, k == 2 ? Exit::numerical : Exit::done);
  }
  fs::create_directory(path + ".41");
  CHECK(look_at_folder(path) == FolderKind::finished);
  CHECK(OutputFolder::create(path, false).moved_to() == path + ".42");
  CHECK(read_text(path + ".1/mark") == "1");
  CHECK(read_text(path + ".42/mark") == "3");
}

TEST_CASE("an unfinished run is offered for resume and moves only with --restart") {
  const TemporaryFolder place;
  const std::string path = place / "job.out";
  for (const Exit code : {Exit::interrupted, Exit::terminated, Exit::time_limit, Exit::internal}) {
    fs::remove_all(path);
    { const OutputFolder folder = OutputFolder::create(path, false); }
    put_checkpoint(path);
    if (code != Exit::internal) put_summary(path, code);  // internal stands for killed: no summary
    CHECK(look_at_folder(path) == FolderKind::unfinished);
    const Refusal refusal = refused(path);
    CHECK(refusal.code() == Exit::io);
    CHECK(holds(refusal.what(), "`scree resume " + path + "`"));
    CHECK(holds(refusal.what(), "--restart"));
  }
  write_text(path + "/checkpoint/latest.scree.tmp", "half");
  {
    const OutputFolder folder = OutputFolder::resume(path);
    CHECK_FALSE(fs::exists(path + "/checkpoint/latest.scree.tmp"));
    CHECK_FALSE(fs::exists(path + "/summary.json"));
  }
  CHECK(OutputFolder::create(path, true).moved_to() == path + ".1");
  CHECK_THROWS_AS(OutputFolder::resume(path), Refusal);
  CHECK_THROWS_AS(OutputFolder::resume(place / "none.out"), Refusal);
}

TEST_CASE("a foreign folder is never touched") {
  const TemporaryFolder place;
  const std::string path = place / "thesis";
  fs::create_directory(path);
  CHECK(look_at_folder(path) == FolderKind::absent);
  write_text(path + "/chapter.tex", "x");
  for (const bool restart : {false, true}) {
    CHECK(look_at_folder(path) == FolderKind::foreign);
    CHECK(holds(refused(path, restart).what(), "not an output folder of scree"));
  }
  CHECK_THROWS_AS(OutputFolder::resume(path), Refusal);
  // Another program's summary does not make it ours.
  write_text(path + "/summary.json", "{\"exit_code\": 0}");
  CHECK(look_at_folder(path) == FolderKind::foreign);
  write_text(path + "/summary.json", "{broken");
  CHECK(look_at_folder(path) == FolderKind::foreign);
  write_text(place / "file", "x");
  CHECK(look_at_folder(place / "file") == FolderKind::foreign);
  CHECK(std::distance(fs::directory_iterator(path), fs::directory_iterator()) == 2);
  CHECK(read_text(path + "/chapter.tex") == "x");
}
