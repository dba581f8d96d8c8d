#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>

#include "core/base/log.hpp"
#include "core/run/checkpoint_files.hpp"
#include "core/run/output_files.hpp"
#include "core/run/summary.hpp"
#include "support/catch.hpp"
#include "support/child.hpp"
#include "support/temporary_folder.hpp"

// Faults that also happen to root: /dev/full, and RLIMIT_FSIZE, under which a write past the limit arrives in part and
// then fails with EFBIG, as a full disk or a quota does with ENOSPC or EDQUOT.

using namespace scree::core;
namespace fs = std::filesystem;

namespace {

void limit_file_size(uint64_t bytes) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(97);
}

bool write_checkpoint(const CheckpointFiles& files, uint64_t cycle, std::string* error = nullptr) {
  ArchiveWriter out(files.latest);
  out.put_value<uint64_t>("cycle", cycle);
  out.put("x", std::vector<double>(100, static_cast<double>(cycle)));
  const bool done = out.commit(files.previous);
  if (error) *error = out.error();
  return done;
}

}  // namespace

TEST_CASE("a full disk fails a write with its reason") {
  const Fd full(::open("/dev/full", O_WRONLY));
  REQUIRE(full);
  uint64_t written = 9;
  CHECK(write_all(full.get(), "abc", 3, &written) == ENOSPC);
  CHECK(written == 0);
  CHECK(errno_text(ENOSPC) == "No space left on device");
}

TEST_CASE("a log on a full disk loses lines and nothing else") {
  const ChildEnd end = in_child([] {
    log::open({});
    if (!log::open_file("/dev/full")) return 1;
    for (int k = 0; k < 10; ++k) log::info("line {}", k);
    return log::lines_lost() == 10 ? 0 : 2;
  });
  CHECK(end.code == 0);
  CHECK(end.text.find("line 9\n") != std::string::npos);
}

TEST_CASE("a log without stderr loses lines and nothing else") {
  const ChildEnd end = in_child([] {
    log::open({});
    ::close(STDERR_FILENO);
    log::error("nobody reads this");
    log::status_line("nor this");
    return 0;
  });
  CHECK(end.code == 0);
}

TEST_CASE("a checkpoint that does not fit leaves the old ones, at every point where the disk may end") {
  const TemporaryFolder folder;
  const CheckpointFiles files(folder.path());
  REQUIRE(files.prepare() == 0);
  REQUIRE(write_checkpoint(files, 1));
  REQUIRE(write_checkpoint(files, 2));
  const uint64_t size = fs::file_size(files.latest);
  for (uint64_t limit = 0; limit < size; limit += limit < 200 ? 7 : 61) {
    const ChildEnd end = in_child([&] {
      limit_file_size(limit);
      std::string error;
      if (write_checkpoint(files, 3, &error)) return 1;
      return error == "cannot write " + files.latest + ".tmp: File too large" ? 0 : 2;
    });
    INFO("limit " << limit);
    REQUIRE(end.code == 0);
    REQUIRE(files.open_latest().get_value<uint64_t>("cycle") == 2);
    REQUIRE(files.open_previous().get_value<uint64_t>("cycle") == 1);
    REQUIRE_FALSE(fs::exists(files.latest + ".tmp"));
  }
  const ChildEnd enough = in_child([&] {
    limit_file_size(size);
    return write_checkpoint(files, 3) ? 0 : 1;
  });
  CHECK(enough.code == 0);
  CHECK(files.open_latest().get_value<uint64_t>("cycle") == 3);
}

TEST_CASE("a history that meets a full disk ends at a whole row and the run goes on") {
  const TemporaryFolder folder;
  for (const uint64_t limit : {0u, 5u, 10u, 1234u, 65536u, 70001u}) {
    const std::string path = folder / std::to_string(limit);
    fs::create_directory(path);
    const ChildEnd end = in_child([&] {
      OutputFiles files(Fd(::open(path.c_str(), O_RDONLY | O_DIRECTORY)), path);
      files.append("first.csv", "", 0);  // the note of names is written before the disk is full
      files.append("second.csv", "", 0);
      limit_file_size(limit);
      bool went_on = true;
      for (int k = 0; k < 20000; ++k) went_on = files.append("first.csv", "123456789\n", 10) && went_on;
      if (files.flush() || went_on || !files.failed()) return 1;
      if (files.append("first.csv", "x", 1)) return 2;
      if (files.error() != path + "/first.csv: cannot write: File too large") return 3;
      if (limit >= 10 && !files.append("second.csv", "row\n", 4)) return 4;
      return files.table()[0].size == limit / 10 * 10 ? 0 : 5;
    });
    INFO("limit " << limit);
    CHECK(end.code == 0);
    CHECK(fs::file_size(path + "/first.csv") == limit / 10 * 10);
    CHECK(read_text(path + "/second.csv") == (limit >= 10 ? "row\n" : ""));
  }
}

TEST_CASE("a whole-file write that does not fit leaves the old file") {
  const TemporaryFolder folder;
  const ChildEnd end = in_child([&] {
    OutputFiles files(Fd(::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY)), folder.path());
    if (!files.replace("view.pvd", "old", 3)) return 1;
    if (write_summary(folder / "summary.json", Summary{}) != 0) return 2;
    limit_file_size(20);
    const std::string longer(21, 'x');
    if (files.replace("view.pvd", longer.data(), longer.size())) return 3;
    Summary changed;
    changed.title = "changed";
    return write_summary(folder / "summary.json", changed) == EFBIG ? 0 : 4;
  });
  CHECK(end.code == 0);
  CHECK(read_text(folder / "view.pvd") == "old");
  CHECK(read_text(folder / "summary.json") == to_json(Summary{}));
  CHECK_FALSE(fs::exists(folder / "view.pvd.tmp"));
  CHECK_FALSE(fs::exists(folder / "summary.json.tmp"));
}
