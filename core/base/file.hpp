#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace scree::core {

/// An open file descriptor that closes itself. [one thread]
class Fd {
 public:
  Fd() = default;
  explicit Fd(int fd) : fd_(fd) {}
  ~Fd() { close(); }
  Fd(Fd&& other) noexcept : fd_(other.release()) {}
  Fd& operator=(Fd&& other) noexcept;
  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  int release();
  void close();

 private:
  int fd_ = -1;
};

/// Writes everything or fails: goes on after short writes and EINTR. `written` counts the bytes that arrived either
/// way. Returns 0 or the errno of the failure. [any thread]
int write_all(int fd, const void* bytes, uint64_t size, uint64_t* written = nullptr);

/// Reads exactly `size` bytes at `offset`. Returns 0, an errno, or -1 when the file ends early. [any thread]
int read_all(int fd, void* bytes, uint64_t size, uint64_t offset);

/// "No space left on device" and the like. [any thread]
std::string errno_text(int code);

/// The folder part of a path, "." when it has none. [any thread]
std::string folder_of(const std::string& path);

/// fsync on a folder, so that a rename in it survives a power cut. Returns 0 or an errno.
int sync_folder(const std::string& folder);

/// Replaces a whole file so that a reader sees the old text or the new one, never a part: `path.tmp`, write, fsync,
/// rename, fsync of the folder. Returns 0 or an errno; on failure the old file stays and the temporary one is gone.
int write_atomically(const std::string& path, std::string_view text);

}  // namespace scree::core
