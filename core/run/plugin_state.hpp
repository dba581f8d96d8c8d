#pragma once
#include "core/plugin/catalogue.hpp"
#include "core/run/archive.hpp"

namespace scree::core {

/// Kind, name, version and SHA-256 of every library that is open.
void save_plugins(const Catalogue& catalogue, ArchiveWriter& out);

/// Opens the same plug-ins. One whose file is another one than then is refused (Exit::plugin), unless that is allowed:
/// then its name is among those returned.
std::vector<std::string> check_plugins(const ArchiveReader& in, Catalogue& catalogue, bool allow_change);

}  // namespace scree::core
