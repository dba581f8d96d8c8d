#pragma once
#include <scree/abi.h>

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/file.hpp"

namespace scree::core {

/// A file of the output folder as a checkpoint remembers it.
struct FileRecord {
  std::string name;
  uint64_t size = 0;
  bool replaced = false;  ///< written whole each time; its size is not cut back
};

/// The files that recorders write, with sizes known, so that a resumed run can cut them back. Names are relative, with
/// at most one folder, and links are never followed. A failure (full disk) is remembered: the file ends at its last
/// whole append and takes no more, the call and all later ones on that file return false, and the run goes on to
/// exit 6. [one thread]
class OutputFiles {
 public:
  OutputFiles() = default;
  /// `folder`: the open output folder; `path` is for messages.
  OutputFiles(Fd folder, std::string path);
  ~OutputFiles();
  OutputFiles(OutputFiles&& other) noexcept = default;
  OutputFiles& operator=(OutputFiles&& other) noexcept;

  /// Adds to the end. Small pieces wait in memory until 64 KiB are together or `flush`. The first append to a name that
  /// is not known (written in this run, or named by `cut_back`) starts the file anew.
  bool append(std::string_view name, const void* bytes, uint64_t size);
  /// The whole file; a reader sees the old or the new one.
  bool replace(std::string_view name, const void* bytes, uint64_t size);
  /// Hands what waits in memory to the system; fsync too with `sync`, which a checkpoint wants before it is written.
  bool flush(bool sync = false);

  /// Every file with its size, in name order; complete only after `flush`.
  std::vector<FileRecord> table() const;
  /// After opening for resume: shortens files to what a checkpoint recorded and removes those begun since. Returns what
  /// did not fit (a file that is missing or shorter than recorded), one sentence each.
  std::vector<std::string> cut_back(const std::vector<FileRecord>& table);

  bool failed() const { return !error_.empty(); }
  /// The first failure: file and reason.
  const std::string& error() const { return error_; }

  /// As writers see it; valid as long as this object stays where it is.
  scree_files abi();

 private:
  struct Open {
    Fd fd;
    std::string waiting;
    std::vector<uint64_t> ends;  // of the appends in `waiting`
  };
  struct File {
    uint64_t size = 0;  // with what waits
    bool replaced = false, failed = false, unsynced = false;
    std::unique_ptr<Open> open;
  };

  bool begin(const std::string& name, File*& file);
  bool note_new(const std::string& name);
  Fd folder_for(const std::string& name, std::string& leaf, bool make);
  bool open_file(const std::string& name, File& file);
  bool drain(const std::string& name, File& file);
  bool fail(const std::string& name, File* file, const std::string& why);
  void close_oldest();
  std::vector<std::string> journal_names() const;

  Fd folder_;
  std::string path_, error_;
  std::map<std::string, File, std::less<>> files_;
  std::list<std::string> opened_;  // oldest first
  std::set<std::string> journal_;  // names ever begun, as in the journal file
};

}  // namespace scree::core
