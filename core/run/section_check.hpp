#pragma once
#include <string>
#include <string_view>

#include "core/run/archive.hpp"

namespace scree::core {

/// Refuses (Exit::io) a section whose bytes are sound but whose values cannot be used.
[[noreturn]] void refuse_section(const ArchiveReader& in, std::string_view section, const std::string& why);

/// Refuses unless `fine`.
inline void want(bool fine, const ArchiveReader& in, std::string_view section, const char* why) {
  if (!fine) refuse_section(in, section, why);
}

}  // namespace scree::core
