#include "core/run/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "core/base/error.hpp"
#include "core/base/log.hpp"

namespace scree::core {

namespace {

std::string owner_text() {
  char host[256] = "unknown";
  ::gethostname(host, sizeof host - 1);
  const std::time_t seconds = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  char start[32] = "";
  std::strftime(start, sizeof start, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return "scree " SCREE_VERSION ", pid " + std::to_string(::getpid()) + ", host " + host + ", since " + start + "\n";
}

std::string first_line(int fd) {
  char text[512];
  const ssize_t n = ::pread(fd, text, sizeof text, 0);
  std::string line(text, n > 0 ? static_cast<size_t>(n) : 0);
  line.resize(std::min(line.find('\n'), line.size()));
  return line.empty() ? "another process" : line;
}

}  // namespace

FolderLock::FolderLock(int folder_fd, const std::string& path) {
  fd_ = Fd(::openat(folder_fd, file_name, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  if (!fd_) throw Refusal(Exit::io, path + "/" + file_name + ": cannot make the lock file: " + errno_text(errno));
  int code = 0;
  while (::flock(fd_.get(), LOCK_EX | LOCK_NB) != 0 && (code = errno) == EINTR) code = 0;
  if (code == EWOULDBLOCK)
    throw Refusal(Exit::folder_in_use, path + ": in use by " + first_line(fd_.get()) +
                                           "; wait for it, stop it, or choose another folder with -o");
  if (code != 0)
    log::warning("{}: this file system has no locks ({}); take care that only one run uses the folder", path,
                 errno_text(code));
  const std::string owner = owner_text();
  // Only for people to read; a full disk must not stop the run here.
  if (::ftruncate(fd_.get(), 0) == 0) write_all(fd_.get(), owner.data(), owner.size());
}

}  // namespace scree::core
