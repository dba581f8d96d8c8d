#include "core/run/packing.hpp"

#include <cstring>

#include "core/run/section_check.hpp"

namespace scree::core {

void Packer::raw(const void* from, std::size_t size) {
  const std::size_t at = bytes_.size();
  bytes_.resize(at + size);
  if (size > 0) std::memcpy(bytes_.data() + at, from, size);
}

Unpacker::Unpacker(const ArchiveReader& in, std::string section)
    : in_(in), section_(std::move(section)), bytes_(in.get<uint8_t>(section_)) {}

void Unpacker::refuse(const std::string& why) const { refuse_section(in_, section_, why); }

uint64_t Unpacker::u64() {
  uint64_t value = 0;
  if (bytes_.size() - at_ < sizeof value) refuse("it ends too early");
  std::memcpy(&value, bytes_.data() + at_, sizeof value);
  at_ += sizeof value;
  return value;
}

bool Unpacker::flag() {
  const uint64_t value = u64();
  if (value > 1) refuse("a flag is neither 0 nor 1");
  return value == 1;
}

uint64_t Unpacker::count(uint64_t least) {
  const uint64_t value = u64();
  if (value > (bytes_.size() - at_) / least) refuse("it holds fewer items than it says");
  return value;
}

std::string Unpacker::text() {
  const uint64_t size = count(1);
  std::string value(reinterpret_cast<const char*>(bytes_.data()) + at_, static_cast<std::size_t>(size));
  at_ += static_cast<std::size_t>(size);
  return value;
}

void Unpacker::finish() {
  if (at_ != bytes_.size()) refuse("something is left behind its last item");
}

}  // namespace scree::core
