#include "core/run/section_check.hpp"

namespace scree::core {

void refuse_section(const ArchiveReader& in, std::string_view section, const std::string& why) {
  throw Refusal(Exit::io, in.path() + ": section '" + std::string(section) + "' cannot be used: " + why +
                              "; the file was not written by a run of this scene: go on from another checkpoint, or "
                              "start again");
}

}  // namespace scree::core
