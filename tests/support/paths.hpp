#pragma once
// Where this build lies. Functions, not macros of each file: so the objects of two clones are the same to a compiler
// cache.
#include <string>

namespace support {

std::string source_dir();  ///< root of the sources
std::string binary_dir();  ///< root of the build
std::string plugin_dir();  ///< the build's plug-ins, <kind>/<name>.so

}  // namespace support
