#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/run/archive.hpp"
#include "core/run/archive_layout.hpp"

namespace scree::core {

using namespace archive_layout;

namespace {

const char* type_name(SectionType type) {
  switch (type) {
    case SectionType::u8:
      return "8-bit integers";
    case SectionType::u16:
      return "16-bit integers";
    case SectionType::u32:
      return "32-bit integers";
    case SectionType::u64:
      return "64-bit integers";
    case SectionType::f64:
      return "numbers";
    case SectionType::text:
      return "text";
    case SectionType::texts:
      return "a list of texts";
  }
  return "an unknown type";
}

uint64_t type_width(SectionType type) {
  switch (type) {
    case SectionType::u16:
      return 2;
    case SectionType::u32:
      return 4;
    case SectionType::u64:
    case SectionType::f64:
      return 8;
    default:
      return 1;
  }
}

std::string quoted(std::string_view name) {
  std::string text(name.size() + 2, '\'');
  text.replace(1, name.size(), name);
  return text;
}

}  // namespace

void ArchiveReader::refuse(const std::string& why) const { throw Refusal(Exit::io, path_ + ": " + why); }

ArchiveReader::ArchiveReader(std::string path) : path_(std::move(path)) {
  fd_ = Fd(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!fd_) refuse("cannot open: " + errno_text(errno));
  struct stat status {};
  if (::fstat(fd_.get(), &status) != 0) refuse("cannot read: " + errno_text(errno));
  if (!S_ISREG(status.st_mode)) refuse("not a checkpoint of scree: not a regular file");
  length_ = static_cast<uint64_t>(status.st_size);
  read_header();
  Hasher whole;
  Header header;
  if (const int code = read_all(fd_.get(), &header, sizeof header, 0)) refuse("cannot read: " + errno_text(code));
  whole.add(&header, sizeof header);
  const uint64_t end = length_ - sizeof(Trailer);
  for (uint64_t offset = sizeof header; offset < end;) offset = read_section(offset, end, whole);
  read_trailer(whole);
}

void ArchiveReader::read_header() {
  Header header{};
  const uint64_t there = std::min<uint64_t>(length_, sizeof header);
  if (const int code = read_all(fd_.get(), &header, there, 0)) refuse("cannot read: " + errno_text(code));
  const uint64_t comparable = std::min<uint64_t>(there, sizeof magic);
  if (there == 0) refuse("damaged: the file is empty");
  if (std::memcmp(header.magic, magic, comparable) != 0) refuse("not a checkpoint of scree (wrong first bytes)");
  if (there < sizeof header) refuse("damaged: the file ends inside its header");
  if (header.order == swapped_order) refuse("written on a machine with the other byte order; run it there");
  if (header.hash != hash64(&header, offsetof(Header, hash))) refuse("damaged: the header");
  version_.assign(header.version, ::strnlen(header.version, sizeof header.version));
  if (header.order != byte_order) refuse("damaged: the byte order in the header");
  if (header.format != archive_format)
    refuse("checkpoint format " + std::to_string(header.format) + ", written by scree " + version_ + "; this scree " +
           SCREE_VERSION + " reads format " + std::to_string(archive_format));
  if (length_ < sizeof(Header) + sizeof(Trailer)) refuse("damaged: the file ends after its header");
}

uint64_t ArchiveReader::read_section(uint64_t offset, uint64_t end, Hasher& whole) {
  const std::string after = order_.empty() ? "the first section" : "the section after " + quoted(order_.back());
  SectionHead head{};
  if (end - offset < sizeof head) refuse("damaged: the file ends inside " + after);
  if (const int code = read_all(fd_.get(), &head, sizeof head, offset)) refuse("cannot read: " + errno_text(code));
  offset += sizeof head;
  if (head.mark != section_mark || head.zero != 0 || head.name_length == 0 || head.name_length > longest_name)
    refuse("damaged: " + after);
  if (head.name_length > end - offset) refuse("damaged: the file ends inside " + after);
  std::string name(head.name_length, '\0');
  if (const int code = read_all(fd_.get(), name.data(), name.size(), offset))
    refuse("cannot read: " + errno_text(code));
  offset += name.size();
  Hasher hasher;
  hasher.add(&head, offsetof(SectionHead, head_hash));
  hasher.add(name);
  if (hasher.value() != head.head_hash) refuse("damaged: " + after);
  const auto type = static_cast<SectionType>(head.type);
  if (head.type < 1 || head.type > 7 || head.size % type_width(type) != 0)
    refuse("damaged: section " + quoted(name) + " has no valid type");
  if (head.size > end - offset) refuse("damaged: the file ends inside section " + quoted(name));
  whole.add(&head, sizeof head);
  whole.add(name);
  Hasher content;
  std::vector<char> piece(static_cast<size_t>(std::min<uint64_t>(head.size, 1 << 20)));
  for (uint64_t done = 0; done < head.size;) {
    const uint64_t n = std::min<uint64_t>(piece.size(), head.size - done);
    if (const int code = read_all(fd_.get(), piece.data(), n, offset + done))
      refuse("cannot read section " + quoted(name) + ": " + errno_text(code));
    content.add(piece.data(), n);
    whole.add(piece.data(), n);
    done += n;
  }
  if (content.value() != head.hash) refuse("damaged: section " + quoted(name));
  if (!sections_.emplace(name, Section{type, offset, head.size, head.hash}).second)
    refuse("damaged: section " + quoted(name) + " occurs twice");
  order_.push_back(std::move(name));
  return offset + head.size;
}

void ArchiveReader::read_trailer(const Hasher& whole) {
  Trailer trailer{};
  if (const int code = read_all(fd_.get(), &trailer, sizeof trailer, length_ - sizeof trailer))
    refuse("cannot read: " + errno_text(code));
  const std::string where = order_.empty() ? "" : " (the last section is " + quoted(order_.back()) + ")";
  if (trailer.mark != trailer_mark || trailer.zero != 0 || trailer.hash != hash64(&trailer, offsetof(Trailer, hash)))
    refuse("damaged: the end of the file is missing or broken" + where);
  if (trailer.length != length_ || trailer.sections != order_.size() || trailer.whole_hash != whole.value())
    refuse("damaged: the file does not agree with its own end" + where);
}

const ArchiveReader::Section& ArchiveReader::find(std::string_view name, SectionType type) const {
  const auto found = sections_.find(name);
  if (found == sections_.end())
    refuse("section " + quoted(name) + " is missing; written by scree " + version_ + ", this is " + SCREE_VERSION);
  if (found->second.type != type)
    refuse("section " + quoted(name) + " holds " + type_name(found->second.type) + ", expected " + type_name(type));
  return found->second;
}

void ArchiveReader::check_count(std::string_view name, const Section& s, uint64_t count, uint64_t width) const {
  if (count != any_count && s.size / width != count)
    refuse("section " + quoted(name) + " holds " + std::to_string(s.size / width) + " values, expected " +
           std::to_string(count));
}

void ArchiveReader::load(std::string_view name, const Section& s, void* to) const {
  if (const int code = read_all(fd_.get(), to, s.size, s.offset))
    refuse("cannot read section " + quoted(name) + ": " + errno_text(code));
  if (hash64(to, static_cast<size_t>(s.size)) != s.hash) refuse("section " + quoted(name) + " changed while in use");
}

std::string ArchiveReader::get_text(std::string_view name) const {
  const Section& s = find(name, SectionType::text);
  std::string text(static_cast<size_t>(s.size), '\0');
  load(name, s, text.data());
  return text;
}

std::vector<std::string> ArchiveReader::get_texts(std::string_view name) const {
  const Section& s = find(name, SectionType::texts);
  std::string packed(static_cast<size_t>(s.size), '\0');
  load(name, s, packed.data());
  std::vector<std::string> texts;
  for (size_t at = 0; at < packed.size();) {
    uint64_t size = 0;
    if (packed.size() - at < sizeof size) refuse("damaged: section " + quoted(name));
    std::memcpy(&size, packed.data() + at, sizeof size);
    at += sizeof size;
    if (packed.size() - at < size) refuse("damaged: section " + quoted(name));
    texts.emplace_back(packed, at, static_cast<size_t>(size));
    at += static_cast<size_t>(size);
  }
  return texts;
}

}  // namespace scree::core
