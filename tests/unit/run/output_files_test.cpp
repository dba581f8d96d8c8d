#include "core/run/output_files.hpp"

#include <fcntl.h>

#include <filesystem>
#include <map>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scree::core;
namespace fs = std::filesystem;

namespace {

OutputFiles open_files(const std::string& path) {
  return OutputFiles(Fd(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)), path);
}
bool append(OutputFiles& files, const std::string& name, const std::string& text) {
  return files.append(name, text.data(), text.size());
}
bool replace(OutputFiles& files, const std::string& name, const std::string& text) {
  return files.replace(name, text.data(), text.size());
}

}  // namespace

TEST_CASE("appends arrive in order, small and large, in more files than are kept open") {
  const TemporaryFolder folder;
  std::map<std::string, std::string> expected;
  {
    OutputFiles files = open_files(folder.path());
    for (int k = 0; k < 400; ++k) {
      const std::string name = "balls/f" + std::to_string(k * 7 % 40) + ".txt";
      const std::string text((k % 5 == 0) ? 70000 : 10, static_cast<char>('a' + k % 26));
      REQUIRE(append(files, name, text));
      expected[name] += text;
    }
    CHECK(files.table().size() == 40);
    for (const auto& record : files.table()) CHECK(record.size == expected[record.name].size());
    REQUIRE(files.flush(true));
    CHECK_FALSE(files.failed());
  }
  for (const auto& [name, text] : expected) CHECK(read_text(folder / name) == text);
}

TEST_CASE("replace shows the old text or the new one") {
  const TemporaryFolder folder;
  OutputFiles files = open_files(folder.path());
  REQUIRE(replace(files, "view.pvd", "one"));
  CHECK(read_text(folder / "view.pvd") == "one");
  REQUIRE(replace(files, "view.pvd", "three"));
  CHECK(read_text(folder / "view.pvd") == "three");
  CHECK_FALSE(fs::exists(folder / "view.pvd.tmp"));
  CHECK_FALSE(append(files, "view.pvd", "x"));
  CHECK(files.failed());
}

TEST_CASE("names that leave the folder, hide or belong to the program are refused") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  for (const std::string name : {"", ".", "..", "../x", "/etc/x", "a/../x", "a/b/c", "a//b", "/x", "x/", ".hidden",
                                 "a/.hidden", "log.txt", "summary.json", "checkpoint/x", "x.tmp", "a\nb", "\x7f"}) {
    OutputFiles files = open_files(folder / "out");
    INFO("name '" << name << "'");
    CHECK_FALSE(append(files, name, "x"));
    CHECK_FALSE(replace(files, name, "x"));
    CHECK(files.failed());
  }
  CHECK(fs::is_empty(folder / "out"));
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("links are not followed") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  fs::create_directory(folder / "elsewhere");
  write_text(folder / "victim", "keep");
  fs::create_symlink(folder / "victim", folder / "out/a.csv");
  fs::create_directory_symlink(folder / "elsewhere", folder / "out/balls");
  OutputFiles files = open_files(folder / "out");
  CHECK_FALSE(append(files, "a.csv", "x"));
  CHECK_FALSE(append(files, "balls/x", "x"));
  CHECK_FALSE(replace(files, "balls/x", "x"));
  CHECK(files.error().find("out/a.csv: cannot open: ") != std::string::npos);
  CHECK(read_text(folder / "victim") == "keep");
  CHECK(fs::is_empty(folder / "elsewhere"));
}

TEST_CASE("resume cuts files back to the checkpoint: no gap, no duplicate, nothing of the user's") {
  const TemporaryFolder folder;
  std::vector<FileRecord> table;
  {
    OutputFiles files = open_files(folder.path());
    append(files, "history.csv", "t,x\n0,1\n");
    append(files, "balls/f0.vtp", "frame 0");
    replace(files, "view.pvd", "f0");
    files.flush(true);
    table = files.table();
    append(files, "history.csv", "1,2\n2,");
    append(files, "balls/f1.vtp", "frame 1");
    append(files, "events.csv", "break");
    replace(files, "view.pvd", "f0 f1");
  }
  write_text(folder / "notes.txt", "mine");
  write_text(folder / "balls/f9.pvsm", "mine");
  OutputFiles files = open_files(folder.path());
  CHECK(files.cut_back(table).empty());
  CHECK(read_text(folder / "history.csv") == "t,x\n0,1\n");
  CHECK(read_text(folder / "balls/f0.vtp") == "frame 0");
  CHECK_FALSE(fs::exists(folder / "balls/f1.vtp"));
  CHECK_FALSE(fs::exists(folder / "events.csv"));
  CHECK(read_text(folder / "notes.txt") == "mine");
  CHECK(read_text(folder / "balls/f9.pvsm") == "mine");
  append(files, "history.csv", "1,2\n");
  append(files, "balls/f1.vtp", "again 1");
  replace(files, "view.pvd", "f0 f1");
  REQUIRE(files.flush());
  CHECK(read_text(folder / "history.csv") == "t,x\n0,1\n1,2\n");
  CHECK(read_text(folder / "balls/f1.vtp") == "again 1");
}

TEST_CASE("what does not fit the checkpoint is said") {
  const TemporaryFolder folder;
  write_text(folder / "short.csv", "ab");
  OutputFiles files = open_files(folder.path());
  const auto remarks = files.cut_back({{"gone.csv", 10, false}, {"short.csv", 5, false}, {"../x", 1, false}});
  REQUIRE(remarks.size() == 3);
  CHECK(remarks[0].find("gone.csv is missing") != std::string::npos);
  CHECK(remarks[1].find("has 2 bytes, the checkpoint recorded 5") != std::string::npos);
  CHECK(remarks[2].find("'../x', which is no output file") != std::string::npos);
  CHECK(append(files, "short.csv", "c"));
  files.flush();
  CHECK(read_text(folder / "short.csv") == "abc");
}

TEST_CASE("writers reach the files through the plug-in table") {
  const TemporaryFolder folder;
  OutputFiles files = open_files(folder.path());
  const scree_files table = files.abi();
  CHECK(table.append(table.self, "a.csv", "1\n", 2) == 1);
  CHECK(table.replace(table.self, "b.pvd", "xyz", 3) == 1);
  CHECK(table.append(table.self, "../a.csv", "1\n", 2) == 0);
  files.flush();
  CHECK(read_text(folder / "a.csv") == "1\n");
  CHECK(read_text(folder / "b.pvd") == "xyz");
}
