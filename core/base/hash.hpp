#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace scree::core {

/// XXH3 (64 bit, seed 0) of bytes. Guards against damage, not against an adversary. [any thread]
uint64_t hash64(const void* bytes, size_t size);
inline uint64_t hash64(std::string_view text) { return hash64(text.data(), text.size()); }

/// XXH3 fed piece by piece; the value depends on the bytes only, not on how they were cut. [one thread]
class Hasher {
 public:
  Hasher();
  void add(const void* bytes, size_t size);
  void add(std::string_view text) { add(text.data(), text.size()); }
  /// One number, as its bytes in memory. Structs are left out on purpose: their padding has no value.
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) { add(&value, sizeof value); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(std::span<const T> values) { add(values.data(), values.size_bytes()); }
  /// Of everything added so far; adding may go on.
  uint64_t value() const;

 private:
  alignas(64) std::byte state_[640];
};

/// Sixteen lower-case hexadecimal digits, the form in which hashes are printed. [any thread]
struct HashText {
  char digits[17];
  operator std::string_view() const { return {digits, 16}; }
};
HashText hash_text(uint64_t hash);

}  // namespace scree::core
