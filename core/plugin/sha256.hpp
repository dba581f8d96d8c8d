#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace scree::core {

/// SHA-256 as 64 lower-case hexadecimal digits. [any thread]
std::string sha256(std::span<const std::byte> bytes);

}  // namespace scree::core
