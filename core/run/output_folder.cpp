#include "core/run/output_folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/error.hpp"
#include "core/run/checkpoint_files.hpp"
#include "core/run/summary.hpp"
#include "core/scene/scene.hpp"

namespace scree::core {

namespace {

bool is_file(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

std::vector<std::string> entries(const std::string& folder) {
  std::vector<std::string> names;
  DIR* open = ::opendir(folder.c_str());
  if (open == nullptr) return names;
  while (const dirent* entry = ::readdir(open)) {
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
  }
  ::closedir(open);
  return names;
}

/// The exit code in a summary of ours; -1 without one.
int summary_exit(const std::string& folder) {
  std::ifstream stream(folder + "/summary.json");
  if (!stream) return -1;
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object() || json.value("schema", nlohmann::json()) != summary_schema) return -1;
  const auto code = json.find("exit_code");
  return code != json.end() && code->is_number_integer() ? code->get<int>() : -1;
}

bool resumable(int exit_code) {
  return exit_code == static_cast<int>(Exit::time_limit) || exit_code == static_cast<int>(Exit::interrupted) ||
         exit_code == static_cast<int>(Exit::terminated);
}

std::string without_end_slashes(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

/// One above the highest number in use, so that the numbers tell the order.
uint64_t next_number(const std::string& path) {
  const std::string stem = path.substr(path.rfind('/') + 1) + ".";
  uint64_t highest = 0;
  for (const std::string& name : entries(folder_of(path))) {
    if (!name.starts_with(stem)) continue;
    uint64_t number = 0;
    const char* end = name.data() + name.size();
    const auto parsed = std::from_chars(name.data() + stem.size(), end, number);
    if (parsed.ec == std::errc() && parsed.ptr == end && number < UINT64_MAX) highest = std::max(highest, number);
  }
  return highest + 1;
}

std::string move_aside(const std::string& path) {
  for (uint64_t number = next_number(path);; ++number) {
    const std::string target = path + "." + std::to_string(number);
    if (::renameat2(AT_FDCWD, path.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) == 0) return target;
    if (errno == EEXIST) continue;
    // File systems without RENAME_NOREPLACE; a plain rename replaces nothing but an empty folder.
    if (errno == EINVAL && ::rename(path.c_str(), target.c_str()) == 0) return target;
    if (errno == ENOTEMPTY) continue;
    throw Refusal(Exit::io, path + ": cannot move the earlier run to " + target + ": " + errno_text(errno));
  }
}

Fd open_folder(const std::string& path) { return Fd(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)); }

/// `path` still names the folder behind `fd`: nobody moved it away between opening and locking.
bool same_folder(const std::string& path, int fd) {
  struct stat a {
  }, b{};
  return ::stat(path.c_str(), &a) == 0 && ::fstat(fd, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

void refuse_foreign(const std::string& path) {
  throw Refusal(Exit::io, path +
                              ": this is not an output folder of scree and is not empty, so it is left alone; choose "
                              "another with -o, or move it away");
}

void make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0777) != 0 && errno != EEXIST)
    throw Refusal(Exit::io,
                  path + ": cannot make the output folder: " + errno_text(errno) + "; choose another place with -o");
}

}  // namespace

FolderKind look_at_folder(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return errno == ENOENT ? FolderKind::absent : FolderKind::foreign;
  if (!S_ISDIR(status.st_mode) || !open_folder(path)) return FolderKind::foreign;
  const std::vector<std::string> names = entries(path);
  if (names.empty()) return FolderKind::absent;
  const int exit_code = summary_exit(path);
  if (exit_code >= 0 && !resumable(exit_code)) return FolderKind::finished;
  if (exit_code < 0 && !is_file(path + "/" + FolderLock::file_name)) return FolderKind::foreign;
  return CheckpointFiles(path).any() ? FolderKind::unfinished : FolderKind::finished;
}

OutputFolder::OutputFolder(std::string path, std::string moved_to, Fd fd, FolderLock lock)
    : path_(std::move(path)), moved_to_(std::move(moved_to)), lock_(std::move(lock)), files_(std::move(fd), path_) {}

OutputFolder OutputFolder::create(const std::string& given, bool restart) {
  const std::string path = without_end_slashes(given);
  std::string moved_to;
  for (int attempt = 0; attempt < 100; ++attempt) {
    if (look_at_folder(path) == FolderKind::foreign) refuse_foreign(path);
    make_folder(path);
    Fd fd = open_folder(path);
    if (!fd) {
      if (errno == ENOENT) continue;  // moved away by another run just now
      throw Refusal(Exit::io, path + ": cannot open the output folder: " + errno_text(errno));
    }
    FolderKind kind = look_at_folder(path);
    FolderLock lock(fd.get(), path);
    if (!same_folder(path, fd.get())) continue;
    // Look again: until the lock was ours another run could have used the folder. The lock file alone is no run.
    if (kind != FolderKind::absent || entries(path).size() > 1) kind = look_at_folder(path);
    if (kind == FolderKind::absent) return OutputFolder(path, moved_to, std::move(fd), std::move(lock));
    if (kind == FolderKind::unfinished && !restart)
      throw Refusal(Exit::io, path + ": holds an unfinished run: go on with `scree resume " + path +
                                  "`, or start again with --restart, which moves it aside");
    moved_to = move_aside(path);
  }
  throw Refusal(Exit::io, path + ": other runs keep moving this folder; choose another with -o");
}

OutputFolder OutputFolder::resume(const std::string& given) {
  const std::string path = without_end_slashes(given);
  const FolderKind kind = look_at_folder(path);
  if (kind == FolderKind::absent) throw Refusal(Exit::io, path + ": there is no run to resume here");
  if (kind == FolderKind::foreign) refuse_foreign(path);
  Fd fd = open_folder(path);
  if (!fd) throw Refusal(Exit::io, path + ": cannot open the output folder: " + errno_text(errno));
  FolderLock lock(fd.get(), path);
  const CheckpointFiles checkpoints(path);
  if (!checkpoints.any())
    throw Refusal(Exit::io, path + ": has no checkpoint to resume from; run the scene again with `scree run`");
  checkpoints.clean();
  ::unlinkat(fd.get(), "summary.json", 0);
  ::unlinkat(fd.get(), (std::string(stopped_state) + ".scree").c_str(), 0);
  return OutputFolder(path, "", std::move(fd), std::move(lock));
}

}  // namespace scree::core
