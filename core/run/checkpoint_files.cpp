#include "core/run/checkpoint_files.hpp"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace scree::core {

CheckpointFiles::CheckpointFiles(const std::string& output_folder)
    : folder(output_folder + "/checkpoint"), latest(folder + "/latest.scree"), previous(folder + "/previous.scree") {}

int CheckpointFiles::prepare() const {
  if (::mkdir(folder.c_str(), 0777) == 0) return sync_folder(folder_of(folder));
  return errno == EEXIST ? 0 : errno;
}

void CheckpointFiles::clean() const {
  DIR* open = ::opendir(folder.c_str());
  if (open == nullptr) return;
  while (const dirent* entry = ::readdir(open)) {
    const std::string_view name = entry->d_name;
    if (name.ends_with(".scree.tmp")) ::unlinkat(::dirfd(open), entry->d_name, 0);
  }
  ::closedir(open);
}

bool CheckpointFiles::any() const {
  return ::access(latest.c_str(), F_OK) == 0 || ::access(previous.c_str(), F_OK) == 0;
}

ArchiveReader CheckpointFiles::open_latest() const {
  std::string why;
  try {
    return ArchiveReader(latest);
  } catch (const Refusal& refusal) {
    why = refusal.what();
  }
  if (::access(previous.c_str(), F_OK) != 0)
    throw Refusal(Exit::io, why + "; there is no previous checkpoint: start again with `scree run --restart`");
  std::string also;
  try {
    const ArchiveReader sound(previous);
    also =
        "; the previous checkpoint is sound: `scree resume " + folder_of(folder) + " --from previous` goes on from it";
  } catch (const Refusal& refusal) {
    also = "; and the previous checkpoint cannot be used: " + std::string(refusal.what());
  }
  throw Refusal(Exit::io, why + also);
}

}  // namespace scree::core
