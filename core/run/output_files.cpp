#include "core/run/output_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace scree::core {

namespace {

// Every name is written here before the file is begun, so a resumed run removes exactly what a killed one made.
constexpr const char* journal_name = ".scree-files";
constexpr size_t buffer_size = 65536;
constexpr size_t most_open = 16;

bool valid_part(std::string_view part) {
  return !part.empty() && part.front() != '.' && part.size() <= 200 &&
         std::all_of(part.begin(), part.end(), [](unsigned char c) { return c >= 0x20 && c != 0x7f && c != '/'; });
}

/// Plain relative names, at most one folder deep, that are neither hidden nor used by the program itself.
bool valid_name(std::string_view name) {
  if (name == "summary.json" || name == "log.txt" || name.ends_with(".tmp")) return false;
  const size_t slash = name.find('/');
  if (slash == std::string_view::npos) return valid_part(name);
  const std::string_view folder = name.substr(0, slash);
  return folder != "checkpoint" && valid_part(folder) && valid_part(name.substr(slash + 1));
}

}  // namespace

OutputFiles::OutputFiles(Fd folder, std::string path) : folder_(std::move(folder)), path_(std::move(path)) {}

OutputFiles::~OutputFiles() {
  if (folder_) flush();
}

OutputFiles& OutputFiles::operator=(OutputFiles&& other) noexcept {
  if (this == &other) return *this;
  if (folder_) flush();
  folder_ = std::move(other.folder_);
  path_ = std::move(other.path_);
  error_ = std::move(other.error_);
  files_ = std::move(other.files_);
  opened_ = std::move(other.opened_);
  journal_ = std::move(other.journal_);
  return *this;
}

bool OutputFiles::fail(const std::string& name, File* file, const std::string& why) {
  if (error_.empty()) error_ = path_ + "/" + name + ": " + why;
  if (file) {
    file->failed = true;
    if (file->open) opened_.remove(name);
    file->open.reset();
  }
  return false;
}

bool OutputFiles::note_new(const std::string& name) {
  if (!journal_.insert(name).second) return true;
  const Fd fd(::openat(folder_.get(), journal_name, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!fd) return false;
  const off_t before = ::lseek(fd.get(), 0, SEEK_END);
  const std::string line = name + "\n";
  if (write_all(fd.get(), line.data(), line.size()) == 0) return true;
  const int code = errno;
  // Half a name would swallow the next one.
  if (before >= 0 && ::ftruncate(fd.get(), before) != 0) return false;
  errno = code;
  return false;
}

bool OutputFiles::begin(const std::string& name, File*& file) {
  file = nullptr;
  if (!valid_name(name))
    return fail(name, nullptr, "not a name for an output file (relative, at most one folder, no '..', not hidden)");
  const auto found = files_.find(name);
  if (found != files_.end()) {
    file = &found->second;
    return !file->failed;
  }
  if (!note_new(name)) return fail(name, nullptr, "cannot note the file in " + std::string(journal_name));
  file = &files_[name];
  return true;
}

Fd OutputFiles::folder_for(const std::string& name, std::string& leaf, bool make) {
  const size_t slash = name.find('/');
  leaf = slash == std::string::npos ? name : name.substr(slash + 1);
  if (slash == std::string::npos) return Fd(::fcntl(folder_.get(), F_DUPFD_CLOEXEC, 0));
  const std::string folder = name.substr(0, slash);
  if (make && ::mkdirat(folder_.get(), folder.c_str(), 0777) != 0 && errno != EEXIST) return Fd();
  return Fd(::openat(folder_.get(), folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW));
}

void OutputFiles::close_oldest() {
  const std::string name = opened_.front();
  File& file = files_.at(name);
  if (!drain(name, file)) return;  // closed by fail()
  file.open.reset();
  opened_.pop_front();
}

bool OutputFiles::open_file(const std::string& name, File& file) {
  if (file.open) {
    if (opened_.back() != name) {
      opened_.remove(name);
      opened_.push_back(name);
    }
    return true;
  }
  while (opened_.size() >= most_open) close_oldest();
  std::string leaf;
  const Fd folder = folder_for(name, leaf, true);
  if (!folder) return fail(name, &file, "cannot make its folder: " + errno_text(errno));
  Fd fd(
      ::openat(folder.get(), leaf.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  if (!fd) return fail(name, &file, "cannot open: " + errno_text(errno));
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0 || !S_ISREG(status.st_mode)) return fail(name, &file, "not a regular file");
  // Also drops what was there under a name that is new to this run.
  if (static_cast<uint64_t>(status.st_size) > file.size && ::ftruncate(fd.get(), static_cast<off_t>(file.size)) != 0)
    return fail(name, &file, "cannot shorten: " + errno_text(errno));
  file.open = std::make_unique<Open>();
  file.open->fd = std::move(fd);
  opened_.push_back(name);
  return true;
}

bool OutputFiles::drain(const std::string& name, File& file) {
  if (!file.open || file.open->waiting.empty()) return !file.failed;
  Open& open = *file.open;
  const uint64_t before = file.size - open.waiting.size();
  uint64_t written = 0;
  file.unsynced = true;
  if (const int code = write_all(open.fd.get(), open.waiting.data(), open.waiting.size(), &written)) {
    uint64_t whole = 0;
    for (const uint64_t end : open.ends)
      if (end <= written) whole = end;
    file.size = before + whole;
    std::string why = "cannot write: " + errno_text(code);
    if (::ftruncate(open.fd.get(), static_cast<off_t>(file.size)) != 0) why += ", nor cut off the incomplete end";
    return fail(name, &file, why);
  }
  open.waiting.clear();
  open.ends.clear();
  return true;
}

bool OutputFiles::append(std::string_view given, const void* bytes, uint64_t size) {
  const std::string name(given);
  File* file = nullptr;
  if (!begin(name, file)) return false;
  if (file->replaced) return fail(name, file, "written both by append and by replace");
  if (!open_file(name, *file)) return false;
  Open& open = *file->open;
  if (!open.waiting.empty() && open.waiting.size() + size > buffer_size && !drain(name, *file)) return false;
  open.waiting.append(static_cast<const char*>(bytes), static_cast<size_t>(size));
  open.ends.push_back(open.waiting.size());
  file->size += size;
  return open.waiting.size() < buffer_size || drain(name, *file);
}

bool OutputFiles::replace(std::string_view given, const void* bytes, uint64_t size) {
  const std::string name(given);
  File* file = nullptr;
  if (!begin(name, file)) return false;
  if (!file->replaced && file->size != 0) return fail(name, file, "written both by append and by replace");
  file->replaced = true;
  std::string leaf;
  const Fd folder = folder_for(name, leaf, true);
  if (!folder) return fail(name, file, "cannot make its folder: " + errno_text(errno));
  const std::string temporary = leaf + ".tmp";
  int code = 0;
  {
    const Fd fd(::openat(folder.get(), temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
    code = fd ? write_all(fd.get(), bytes, size) : errno;
  }
  if (code == 0 && ::renameat(folder.get(), temporary.c_str(), folder.get(), leaf.c_str()) != 0) code = errno;
  if (code != 0) {
    ::unlinkat(folder.get(), temporary.c_str(), 0);
    return fail(name, file, "cannot write: " + errno_text(code));
  }
  file->size = size;
  file->unsynced = true;
  return true;
}

bool OutputFiles::flush(bool sync) {
  bool good = true;
  for (auto& [name, file] : files_) {
    if (!drain(name, file)) good = false;
    if (!sync || !file.unsynced || file.failed) continue;
    std::string leaf;
    const Fd folder = folder_for(name, leaf, false);
    const Fd fd(folder ? ::openat(folder.get(), leaf.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW) : -1);
    if (!fd || ::fsync(fd.get()) != 0) good = fail(name, &file, "cannot write: " + errno_text(errno));
    file.unsynced = false;
  }
  return good;
}

std::vector<FileRecord> OutputFiles::table() const {
  std::vector<FileRecord> records;
  for (const auto& [name, file] : files_) records.push_back({name, file.size, file.replaced});
  return records;
}

std::vector<std::string> OutputFiles::cut_back(const std::vector<FileRecord>& table) {
  std::vector<std::string> remarks;
  files_.clear();
  opened_.clear();
  journal_.clear();
  std::set<std::string> known;
  for (const FileRecord& record : table) {
    if (!valid_name(record.name)) {
      remarks.push_back("the checkpoint names '" + record.name + "', which is no output file; left alone");
      continue;
    }
    known.insert(record.name);
    File& file = files_[record.name];
    file.replaced = record.replaced;
    std::string leaf;
    const Fd folder = folder_for(record.name, leaf, false);
    const Fd fd(folder ? ::openat(folder.get(), leaf.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK) : -1);
    struct stat status {};
    if (!fd || ::fstat(fd.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
      remarks.push_back(path_ + "/" + record.name + " is missing; it goes on without its earlier part");
      continue;
    }
    const auto size = static_cast<uint64_t>(status.st_size);
    file.size = record.replaced ? size : std::min(size, record.size);
    if (record.replaced) continue;
    if (size < record.size)
      remarks.push_back(path_ + "/" + record.name + " has " + std::to_string(size) +
                        " bytes, the checkpoint recorded " + std::to_string(record.size) + "; there will be a gap");
    else if (size > record.size && ::ftruncate(fd.get(), static_cast<off_t>(record.size)) != 0)
      remarks.push_back(path_ + "/" + record.name + " cannot be shortened: " + errno_text(errno));
  }
  for (const std::string& name : journal_names()) {
    journal_.insert(name);
    if (!valid_name(name) || known.count(name) != 0) continue;
    std::string leaf;
    if (const Fd folder = folder_for(name, leaf, false)) ::unlinkat(folder.get(), leaf.c_str(), 0);
  }
  return remarks;
}

std::vector<std::string> OutputFiles::journal_names() const {
  std::vector<std::string> names;
  const Fd fd(::openat(folder_.get(), journal_name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat status {};
  if (!fd || ::fstat(fd.get(), &status) != 0 || !S_ISREG(status.st_mode)) return names;
  std::string text(static_cast<size_t>(status.st_size), '\0');
  if (read_all(fd.get(), text.data(), text.size(), 0) != 0) return names;
  // A last line without its end was cut off by a kill, and then its file was never begun.
  for (size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
    names.push_back(text.substr(at, end - at));
  return names;
}

scree_files OutputFiles::abi() {
  scree_files table{};
  table.struct_size = sizeof table;
  table.self = this;
  table.append = [](void* self, const char* name, const void* bytes, uint64_t size) -> int {
    return static_cast<OutputFiles*>(self)->append(name, bytes, size);
  };
  table.replace = [](void* self, const char* name, const void* bytes, uint64_t size) -> int {
    return static_cast<OutputFiles*>(self)->replace(name, bytes, size);
  };
  return table;
}

}  // namespace scree::core
