#pragma once
#include <cstddef>

#include "core/run/archive.hpp"
#include "core/world/balls.hpp"

namespace scree::core {

/// Every column that exists, with why it exists, in row order.
void save_balls(const Balls& balls, ArchiveWriter& out);
/// Replaces all balls. Columns that exist already and are not in the file become zero. `groups`: how many there are.
void load_balls(Balls& balls, const ArchiveReader& in, std::size_t groups);

}  // namespace scree::core
