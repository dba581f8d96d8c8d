#include "core/vet/loaded_object.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace scree::core::vet {

namespace {

int add_object(dl_phdr_info* info, std::size_t, void* list) {
  LoadedObject object;
  object.name = info->dlpi_name;
  object.base = info->dlpi_addr;
  object.segments.assign(info->dlpi_phdr, info->dlpi_phdr + info->dlpi_phnum);
  static_cast<std::vector<LoadedObject>*>(list)->push_back(std::move(object));
  return 0;
}

}  // namespace

std::vector<LoadedObject> loaded_objects() {
  std::vector<LoadedObject> list;
  ::dl_iterate_phdr(add_object, &list);
  return list;
}

bool LoadedObject::holds(const void* address) const {
  const auto at = reinterpret_cast<std::size_t>(address);
  return std::any_of(segments.begin(), segments.end(), [&](const ElfW(Phdr) & s) {
    return s.p_type == PT_LOAD && at >= base + s.p_vaddr && at < base + s.p_vaddr + s.p_memsz;
  });
}

LoadedObject object_of(const void* address) {
  for (LoadedObject& object : loaded_objects())
    if (object.holds(address)) return object;
  throw std::runtime_error("the function lies in no loaded library");
}

std::vector<std::span<const std::byte>> LoadedObject::writable() const {
  // Relocation is over before anything of the library runs; that part is whole pages.
  std::size_t fixed_begin = 0, fixed_end = 0;
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  for (const auto& s : segments)
    if (s.p_type == PT_GNU_RELRO) {
      fixed_begin = base + s.p_vaddr;
      fixed_end = (base + s.p_vaddr + s.p_memsz) / page * page;
    }
  std::vector<std::span<const std::byte>> list;
  const auto add = [&](std::size_t begin, std::size_t end) {
    if (begin < end) list.emplace_back(reinterpret_cast<const std::byte*>(begin), end - begin);
  };
  for (const auto& s : segments) {
    if (s.p_type != PT_LOAD || (s.p_flags & PF_W) == 0) continue;
    const std::size_t begin = base + s.p_vaddr, end = begin + s.p_memsz;
    if (fixed_begin >= begin && fixed_begin < end) {
      add(begin, fixed_begin);
      add(std::min(fixed_end, end), end);
    } else {
      add(begin, end);
    }
  }
  return list;
}

// The address sanitizer forbids what lies between variables, but a segment is read as a whole.
#define SCREE_READS_SEGMENTS __attribute__((no_sanitize("address")))

SCREE_READS_SEGMENTS MemoryPicture::MemoryPicture(const LoadedObject& object) : ranges_(object.writable()) {
  for (const auto& range : ranges_) {
    std::vector<std::byte>& copy = bytes_.emplace_back(range.size());
    const volatile std::byte* from = range.data();
    for (std::size_t k = 0; k < range.size(); ++k) copy[k] = from[k];
  }
}

SCREE_READS_SEGMENTS std::size_t MemoryPicture::changed() const {
  using Word = uint64_t __attribute__((may_alias, aligned(1)));
  std::size_t count = 0;
  for (std::size_t r = 0; r < ranges_.size(); ++r) {
    const std::byte *now = ranges_[r].data(), *then = bytes_[r].data();
    const std::size_t size = bytes_[r].size();
    for (std::size_t k = 0; k < size;) {
      const bool whole = k + sizeof(Word) <= size;
      if (whole && *reinterpret_cast<const volatile Word*>(now + k) == *reinterpret_cast<const Word*>(then + k)) {
        k += sizeof(Word);
        continue;
      }
      for (const std::size_t end = whole ? k + sizeof(Word) : size; k < end; ++k)
        count += *static_cast<const volatile std::byte*>(now + k) != then[k];
    }
  }
  return count;
}

}  // namespace scree::core::vet
