#include "support/paths.hpp"

namespace support {

std::string source_dir() { return SCREE_SOURCE_DIR; }
std::string binary_dir() { return SCREE_BINARY_DIR; }
std::string plugin_dir() { return SCREE_PLUGINS; }

}  // namespace support
