#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "core/base/philox.hpp"
#include "core/run/checkpoint_files.hpp"
#include "core/run/output_folder.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scree::core;
namespace fs = std::filesystem;

namespace {

[[noreturn]] void save_for_ever(const CheckpointFiles& files, uint64_t cycle) {
  for (std::vector<uint64_t> values(20000);; ++cycle) {
    for (uint64_t& v : values) v = cycle;
    ArchiveWriter out(files.latest);
    out.put_value<uint64_t>("cycle", cycle);
    out.put("values", values);
    if (!out.commit(files.previous)) ::_exit(1);
  }
}

/// The cycle of a sound file whose values agree with it.
uint64_t check(const ArchiveReader& in) {
  const auto cycle = in.get_value<uint64_t>("cycle");
  for (const uint64_t v : in.get<uint64_t>("values", 20000)) REQUIRE(v == cycle);
  return cycle;
}

}  // namespace

TEST_CASE("kill -9 at random moments of saving always leaves sound checkpoints") {
  const TemporaryFolder folder;
  const std::string path = folder / "job.out";
  { const OutputFolder made = OutputFolder::create(path, false); }
  const CheckpointFiles files(path);
  REQUIRE(files.prepare() == 0);
  const Random random(1, "kill");
  uint64_t reached = 0;
  int halves = 0;
  // The test means something only if kills did hit the middle of a save: on a busy machine that takes more rounds.
  for (uint64_t round = 0; round < 100 || (round < 2000 && (reached <= 20 || halves <= 10)); ++round) {
    const pid_t pid = ::fork();
    if (pid == 0) save_for_ever(files, reached + 1);
    const timespec wait{0, static_cast<long>(1e6 + 19e6 * random.uniform(round, 0))};
    ::nanosleep(&wait, nullptr);
    ::kill(pid, SIGKILL);
    int status = 0;
    ::waitpid(pid, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    if (!files.any()) continue;  // killed before the very first save
    halves += fs::exists(files.latest + ".tmp") ? 1 : 0;
    const uint64_t cycle = check(files.open_latest());
    REQUIRE(cycle >= reached);
    if (fs::exists(files.previous)) REQUIRE(check(files.open_previous()) <= cycle);
    reached = cycle;
    const OutputFolder again = OutputFolder::resume(path);
    REQUIRE_FALSE(fs::exists(files.latest + ".tmp"));
    REQUIRE_FALSE(fs::exists(files.previous + ".tmp"));
  }
  CHECK(reached > 20);
  CHECK(halves > 10);
}
