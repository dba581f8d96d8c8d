#pragma once
/// How a component says no: throw anything derived from std::exception; its text reaches the user with the place in the
/// scene in front of it. Exceptions never cross the boundary itself.
#include <scree/abi.h>

#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

namespace scree {

/// Writes `why` into the host's buffer. A text that is too long is cut between two UTF-8 characters.
inline void write_refusal(const scree_refusal* refusal, const char* why) noexcept {
  if (refusal == nullptr || refusal->why == nullptr || refusal->size == 0) return;
  std::size_t length = std::strlen(why);
  if (length >= refusal->size) {
    length = refusal->size - 1;
    while (length > 0 && (static_cast<unsigned char>(why[length]) & 0xC0u) == 0x80u) --length;
  }
  std::memcpy(refusal->why, why, length);
  refusal->why[length] = '\0';
}

/// Runs an author's code; 0 when it returned, 1 when it threw, with the text of the exception in `refusal`.
template <class Code>
int guarded(const scree_refusal* refusal, Code&& code) noexcept {
  try {
    code();
    return 0;
  } catch (const std::exception& error) {
    write_refusal(refusal, error.what());
  } catch (...) {
    write_refusal(refusal, "it threw something that is not a std::exception");
  }
  return 1;
}

}  // namespace scree
