#pragma once
#include <string>

#include "core/base/file.hpp"

namespace scree::core {

/// Holds an output folder for this process. The kernel drops the lock with the process, so none is ever stale. The file
/// `.scree-lock` stays and marks the folder as one of ours. [one thread]
class FolderLock {
 public:
  static constexpr const char* file_name = ".scree-lock";

  FolderLock() = default;
  /// `folder_fd`: the open folder; `path` is for messages. Refusal(Exit::folder_in_use) while another process holds it,
  /// Refusal(Exit::io) when the file cannot be made.
  FolderLock(int folder_fd, const std::string& path);

 private:
  Fd fd_;
};

}  // namespace scree::core
