#include "core/base/hash.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace scree::core {

uint64_t hash64(const void* bytes, size_t size) { return XXH3_64bits(bytes, size); }

static_assert(sizeof(XXH3_state_t) <= 640 && alignof(XXH3_state_t) <= 64);

Hasher::Hasher() { XXH3_64bits_reset(reinterpret_cast<XXH3_state_t*>(state_)); }

void Hasher::add(const void* bytes, size_t size) {
  if (size != 0) XXH3_64bits_update(reinterpret_cast<XXH3_state_t*>(state_), bytes, size);
}

uint64_t Hasher::value() const { return XXH3_64bits_digest(reinterpret_cast<const XXH3_state_t*>(state_)); }

HashText hash_text(uint64_t hash) {
  HashText text{};
  for (int k = 0; k < 16; ++k) text.digits[k] = "0123456789abcdef"[(hash >> (60 - 4 * k)) & 15];
  return text;
}

}  // namespace scree::core
