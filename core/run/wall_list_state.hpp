#pragma once
#include <cstdint>
#include <vector>

#include "core/contact/wall_list.hpp"
#include "core/run/archive.hpp"

namespace scree::core {

/// What the indices of wall lists must stay below.
struct WallListLimits {
  uint64_t rows = 0;
  std::size_t rules = 0, walls = 0;
};

void save_wall_lists(const std::vector<WallList>& lists, ArchiveWriter& out);
/// Refuses indices out of range or out of order and sizes that do not match.
std::vector<WallList> read_wall_lists(const ArchiveReader& in, const WallListLimits& limits);

}  // namespace scree::core
