#pragma once
#include <cstdint>
#include <cstring>

namespace scree::core::archive_layout {

// PNG's trick: a byte above 127, a line end that transfers in text mode destroy, and an end-of-file mark.
inline constexpr unsigned char magic[8] = {0x89, 'S', 'C', 'R', 0x0d, 0x0a, 0x1a, 0x0a};
inline constexpr uint32_t byte_order = 0x01020304;
inline constexpr uint32_t swapped_order = 0x04030201;
inline constexpr uint32_t section_mark = 0x54434553;  // "SECT"
inline constexpr uint32_t trailer_mark = 0x21444e45;  // "END!"
inline constexpr uint32_t longest_name = 1024;

struct Header {
  unsigned char magic[8];
  uint32_t format, order;
  char version[40];
  uint64_t hash;
};
struct SectionHead {
  uint32_t mark, type, name_length, zero;
  uint64_t size, hash, head_hash;
};
struct Trailer {
  uint32_t mark, zero;
  uint64_t sections, length, whole_hash, hash;
};
static_assert(sizeof(Header) == 64 && sizeof(SectionHead) == 40 && sizeof(Trailer) == 40);

}  // namespace scree::core::archive_layout
