#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/file.hpp"
#include "core/base/hash.hpp"

// A checkpoint file: named, typed sections, each with its own hash, and a hash of the whole at the end.
//
//   header   64 bytes: magic, format version, byte order, scree version, hash of these
//   section  40 bytes: mark, type, length of name, 0, bytes, hash of bytes, hash of this head and the name;
//            then the name, then the bytes
//   trailer  40 bytes: mark, 0, number of sections, length of the file, hash of all before, hash of this trailer
//
// Integers are in the machine's order, which the header states. The file is data: nothing in it is ever run.
namespace scree::core {

inline constexpr uint32_t archive_format = 1;

enum class SectionType : uint32_t { u8 = 1, u16 = 2, u32 = 3, u64 = 4, f64 = 5, text = 6, texts = 7 };

template <class T>
constexpr SectionType section_type();
template <>
constexpr SectionType section_type<uint8_t>() {
  return SectionType::u8;
}
template <>
constexpr SectionType section_type<uint16_t>() {
  return SectionType::u16;
}
template <>
constexpr SectionType section_type<uint32_t>() {
  return SectionType::u32;
}
template <>
constexpr SectionType section_type<uint64_t>() {
  return SectionType::u64;
}
template <>
constexpr SectionType section_type<double>() {
  return SectionType::f64;
}

/// Writes an archive so that the file at `path` is at any moment the old one or the new one, whole: `path.tmp`, fsync,
/// rename, fsync of the folder. A failure (full disk) makes the rest do nothing; `commit` reports it and the old file
/// stays. Using one name twice is a mistake of the program (std::logic_error). [one thread]
class ArchiveWriter {
 public:
  explicit ArchiveWriter(std::string path);
  /// Without `commit` nothing is left behind.
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  template <class T>
  void put(std::string_view name, std::span<const T> values) {
    section(name, section_type<T>(), values.data(), values.size_bytes());
  }
  template <class T>
  void put(std::string_view name, const std::vector<T>& values) {
    put(name, std::span<const T>(values));
  }
  /// One number.
  template <class T>
  void put_value(std::string_view name, T value) {
    put(name, std::span<const T>(&value, 1));
  }
  void put_text(std::string_view name, std::string_view text);
  void put_texts(std::string_view name, const std::vector<std::string>& texts);

  /// Puts the file in its place. With `previous`, the file that was there gets that name. False: see `error`.
  bool commit(const std::string& previous = "");
  /// "cannot write x.scree: No space left on device"; empty while all is well.
  const std::string& error() const { return error_; }
  uint64_t bytes() const { return length_; }

 private:
  void section(std::string_view name, SectionType type, const void* bytes, uint64_t size);
  void emit(const void* bytes, uint64_t size);
  void drain();
  void fail(const char* doing, int code);
  bool keep_previous(const std::string& previous);

  std::string path_, temporary_, error_;
  Fd fd_;
  std::vector<char> buffer_;
  Hasher whole_;
  uint64_t length_ = 0;
  std::map<std::string, bool, std::less<>> names_;
  bool committed_ = false;
};

/// Opens an archive and checks all of it before anything is used. Every refusal is Refusal(Exit::io) and names the file
/// and the section. Sizes are checked against the file before memory is asked for. [one thread]
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string path);

  const std::string& path() const { return path_; }
  /// Version of the program that wrote it.
  const std::string& version() const { return version_; }
  bool has(std::string_view name) const { return sections_.find(name) != sections_.end(); }
  /// In the order they were written.
  const std::vector<std::string>& names() const { return order_; }

  static constexpr uint64_t any_count = UINT64_MAX;
  /// The values of a section; refuses another type, and another count unless `count` is any_count.
  template <class T>
  std::vector<T> get(std::string_view name, uint64_t count = any_count) const {
    const Section& s = find(name, section_type<T>());
    check_count(name, s, count, sizeof(T));
    std::vector<T> values(static_cast<size_t>(s.size / sizeof(T)));
    load(name, s, values.data());
    return values;
  }
  template <class T>
  T get_value(std::string_view name) const {
    return get<T>(name, 1)[0];
  }
  std::string get_text(std::string_view name) const;
  std::vector<std::string> get_texts(std::string_view name) const;

 private:
  struct Section {
    SectionType type;
    uint64_t offset, size, hash;
  };
  void read_header();
  uint64_t read_section(uint64_t offset, uint64_t end, Hasher& whole);
  void read_trailer(const Hasher& whole);
  [[noreturn]] void refuse(const std::string& why) const;
  const Section& find(std::string_view name, SectionType type) const;
  void check_count(std::string_view name, const Section& s, uint64_t count, uint64_t width) const;
  void load(std::string_view name, const Section& s, void* to) const;

  std::string path_, version_;
  Fd fd_;
  uint64_t length_ = 0;
  std::vector<std::string> order_;
  std::map<std::string, Section, std::less<>> sections_;
};

}  // namespace scree::core
