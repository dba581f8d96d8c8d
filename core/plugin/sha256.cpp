#include "core/plugin/sha256.hpp"

#include <openssl/evp.h>

#include <array>

#include "core/base/error.hpp"

namespace scree::core {

std::string sha256(std::span<const std::byte> bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
    throw Refusal(Exit::internal, "SHA-256 is not available in this libcrypto: install a libcrypto that has it");
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * static_cast<std::size_t>(length));
  for (unsigned k = 0; k < length; ++k) {
    text += digits[digest[k] >> 4];
    text += digits[digest[k] & 15u];
  }
  return text;
}

}  // namespace scree::core
