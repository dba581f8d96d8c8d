#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "core/run/archive.hpp"
#include "core/run/archive_layout.hpp"

namespace scree::core {

using namespace archive_layout;

ArchiveWriter::ArchiveWriter(std::string path) : path_(std::move(path)), temporary_(path_ + ".tmp") {
  fd_ = Fd(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!fd_) {
    fail("cannot create", errno);
    return;
  }
  buffer_.reserve(1 << 20);
  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.format = archive_format;
  header.order = byte_order;
  std::strncpy(header.version, SCREE_VERSION, sizeof header.version - 1);
  header.hash = hash64(&header, offsetof(Header, hash));
  emit(&header, sizeof header);
}

ArchiveWriter::~ArchiveWriter() {
  if (!committed_ && fd_) ::unlink(temporary_.c_str());
}

void ArchiveWriter::fail(const char* doing, int code) {
  if (error_.empty()) error_ = std::string(doing) + " " + temporary_ + ": " + errno_text(code);
  if (fd_) ::unlink(temporary_.c_str());  // gives the space back at once
  fd_.close();
}

void ArchiveWriter::drain() {
  if (!fd_ || buffer_.empty()) return;
  if (const int code = write_all(fd_.get(), buffer_.data(), buffer_.size())) fail("cannot write", code);
  buffer_.clear();
}

void ArchiveWriter::emit(const void* bytes, uint64_t size) {
  if (!fd_ || size == 0) return;
  whole_.add(bytes, size);
  length_ += size;
  if (buffer_.size() + size > buffer_.capacity()) drain();
  if (size > buffer_.capacity()) {
    if (!fd_) return;
    if (const int code = write_all(fd_.get(), bytes, size)) fail("cannot write", code);
    return;
  }
  const char* from = static_cast<const char*>(bytes);
  buffer_.insert(buffer_.end(), from, from + size);
}

void ArchiveWriter::section(std::string_view name, SectionType type, const void* bytes, uint64_t size) {
  if (name.empty() || name.size() > longest_name) throw std::logic_error("a checkpoint section needs a name");
  if (!names_.emplace(std::string(name), true).second)
    throw std::logic_error("checkpoint section '" + std::string(name) + "' written twice");
  SectionHead head{};
  head.mark = section_mark;
  head.type = static_cast<uint32_t>(type);
  head.name_length = static_cast<uint32_t>(name.size());
  head.size = size;
  head.hash = hash64(bytes, size);
  Hasher hasher;
  hasher.add(&head, offsetof(SectionHead, head_hash));
  hasher.add(name);
  head.head_hash = hasher.value();
  emit(&head, sizeof head);
  emit(name.data(), name.size());
  emit(bytes, size);
}

void ArchiveWriter::put_text(std::string_view name, std::string_view text) {
  section(name, SectionType::text, text.data(), text.size());
}

void ArchiveWriter::put_texts(std::string_view name, const std::vector<std::string>& texts) {
  std::string packed;
  for (const std::string& t : texts) {
    const uint64_t size = t.size();
    packed.append(reinterpret_cast<const char*>(&size), sizeof size);
    packed += t;
  }
  section(name, SectionType::texts, packed.data(), packed.size());
}

bool ArchiveWriter::keep_previous(const std::string& previous) {
  // A second name for the old file first, so that `path_` never stops existing.
  const std::string aside = previous + ".tmp";
  ::unlink(aside.c_str());
  if (::link(path_.c_str(), aside.c_str()) == 0) {
    if (::rename(aside.c_str(), previous.c_str()) == 0) return true;
  } else if (errno == ENOENT) {
    return true;
  } else if (::rename(path_.c_str(), previous.c_str()) == 0) {  // a file system without hard links
    return true;
  }
  fail("cannot keep the previous file beside", errno);
  ::unlink(aside.c_str());
  return false;
}

bool ArchiveWriter::commit(const std::string& previous) {
  if (committed_) throw std::logic_error("a checkpoint is committed once");
  Trailer trailer{};
  trailer.mark = trailer_mark;
  trailer.sections = names_.size();
  trailer.length = length_ + sizeof trailer;
  trailer.whole_hash = whole_.value();
  trailer.hash = hash64(&trailer, offsetof(Trailer, hash));
  emit(&trailer, sizeof trailer);
  drain();
  if (!fd_) return false;
  if (::fsync(fd_.get()) != 0) {
    fail("cannot write", errno);
    return false;
  }
  if (!previous.empty() && !keep_previous(previous)) return false;
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    fail("cannot rename", errno);
    return false;
  }
  committed_ = true;
  if (const int code = sync_folder(folder_of(path_))) {
    fd_.close();
    error_ = "cannot sync the folder of " + path_ + ": " + errno_text(code);
    return false;
  }
  return true;
}

}  // namespace scree::core
