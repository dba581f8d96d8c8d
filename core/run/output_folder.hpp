#pragma once
#include <string>

#include "core/base/file.hpp"
#include "core/run/folder_lock.hpp"
#include "core/run/output_files.hpp"

namespace scree::core {

/// What lies at the path of an output folder.
enum class FolderKind {
  absent,      ///< nothing, or an empty folder
  finished,    ///< a run of ours that ended and cannot be resumed
  unfinished,  ///< a run of ours that was cut short and has a checkpoint
  foreign      ///< anything else: never touched
};

/// A finished run has a summary.json whose exit_code is none of 75, 130, 143 (those can be resumed); a run without a
/// summary was killed, and counts as finished only if it left no checkpoint. [any thread]
FolderKind look_at_folder(const std::string& path);

/// The folder of one run, locked. [one thread]
class OutputFolder {
 public:
  /// For a new run. A finished earlier one moves to `path.N`, N one above the highest there is, and so does an
  /// unfinished one with `restart`; otherwise an unfinished or foreign one is refused (exit 6), one in use too (exit
  /// 9).
  static OutputFolder create(const std::string& path, bool restart);
  /// For going on: the folder must be ours. Removes half-written checkpoints and the summary of the run that was cut
  /// short, so that being killed again shows.
  static OutputFolder resume(const std::string& path);

  const std::string& path() const { return path_; }
  /// Where the earlier run went, "" if there was none.
  const std::string& moved_to() const { return moved_to_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  OutputFiles& files() { return files_; }
  const OutputFiles& files() const { return files_; }

 private:
  OutputFolder(std::string path, std::string moved_to, Fd fd, FolderLock lock);

  std::string path_, moved_to_;
  FolderLock lock_;
  OutputFiles files_;
};

}  // namespace scree::core
