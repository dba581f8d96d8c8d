#include "core/base/hash.hpp"

#include <string>
#include <vector>

#include "support/catch.hpp"

using namespace scree::core;

TEST_CASE("hash64 is XXH3 with seed 0") {
  // Reference values of the xxHash project: XXH3_64bits of the empty input, and of "a" and "abc" as printed by `xxhsum
  // -H3`.
  CHECK(hash64("") == 0x2d06800538d394c2u);
  CHECK(hash64("a") == 0xe6c632b61e964e1fu);
  CHECK(hash64("abc") == 0x78af5f94892f3950u);
}

TEST_CASE("a hash does not depend on how the bytes are cut") {
  std::vector<unsigned char> bytes(5000);
  for (size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<unsigned char>(k * k * 31 + k);
  for (const size_t total : {0u, 1u, 16u, 240u, 241u, 1024u, 5000u}) {
    for (const size_t piece : {1u, 7u, 64u, 1000u}) {
      Hasher hasher;
      for (size_t at = 0; at < total; at += piece) hasher.add(bytes.data() + at, std::min(piece, total - at));
      CHECK(hasher.value() == hash64(bytes.data(), total));
    }
  }
}

TEST_CASE("a hash sees every bit and the order") {
  Hasher a, b;
  a.add(1.0), a.add(2.0);
  b.add(2.0), b.add(1.0);
  CHECK(a.value() != b.value());
  Hasher zero, minus;
  zero.add(0.0);
  minus.add(-0.0);
  CHECK(zero.value() != minus.value());
  CHECK(std::string(std::string_view(hash_text(0x0123456789abcdefu))) == "0123456789abcdef");
}
