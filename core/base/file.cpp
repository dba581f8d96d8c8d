#include "core/base/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace scree::core {

Fd& Fd::operator=(Fd&& other) noexcept {
  if (this != &other) {
    close();
    fd_ = other.release();
  }
  return *this;
}

int Fd::release() { return std::exchange(fd_, -1); }

void Fd::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

int write_all(int fd, const void* bytes, uint64_t size, uint64_t* written) {
  const char* next = static_cast<const char*>(bytes);
  uint64_t done = 0;
  int error = 0;
  while (done < size) {
    // Linux moves at most 2 GiB per call; a smaller piece also keeps a signal from waiting long.
    const size_t piece = static_cast<size_t>(std::min<uint64_t>(size - done, uint64_t{1} << 28));
    const ssize_t n = ::write(fd, next + done, piece);
    if (n > 0) {
      done += static_cast<uint64_t>(n);
    } else if (n == 0) {
      error = ENOSPC;  // no progress and no reason given: do not spin
      break;
    } else if (errno != EINTR) {
      error = errno;
      break;
    }
  }
  if (written) *written = done;
  return error;
}

int read_all(int fd, void* bytes, uint64_t size, uint64_t offset) {
  char* next = static_cast<char*>(bytes);
  uint64_t done = 0;
  while (done < size) {
    const size_t piece = static_cast<size_t>(std::min<uint64_t>(size - done, uint64_t{1} << 28));
    const ssize_t n = ::pread(fd, next + done, piece, static_cast<off_t>(offset + done));
    if (n == 0) return -1;
    if (n > 0)
      done += static_cast<uint64_t>(n);
    else if (errno != EINTR)
      return errno;
  }
  return 0;
}

std::string errno_text(int code) {
  return code < 0 ? std::string("the file ends early") : std::generic_category().message(code);
}

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

int sync_folder(const std::string& folder) {
  const Fd fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!fd) return errno;
  // Some network file systems cannot sync a folder and say EINVAL; their rename is as durable as it gets.
  if (::fsync(fd.get()) != 0 && errno != EINVAL && errno != EROFS) return errno;
  return 0;
}

int write_atomically(const std::string& path, std::string_view text) {
  const std::string temporary = path + ".tmp";
  int error = 0;
  {
    const Fd fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (!fd) return errno;
    error = write_all(fd.get(), text.data(), text.size());
    if (error == 0 && ::fsync(fd.get()) != 0) error = errno;
  }
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return error;
  }
  return sync_folder(folder_of(path));
}

}  // namespace scree::core
