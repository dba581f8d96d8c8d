#pragma once
#include <vector>

#include "core/run/archive.hpp"
#include "core/world/wall.hpp"

namespace scree::core {

/// Names, poses, velocities, own contact properties and resultants; not the geometry, which is the plug-in's.
void save_walls(const std::vector<Wall>& walls, ArchiveWriter& out);
/// Into walls that exist already, in the same order and with the same names.
void load_walls(std::vector<Wall>& walls, const ArchiveReader& in);
/// Into the walls whose names the file knows; tells for each wall of the file its index among `walls`, or none.
std::vector<std::size_t> load_walls_by_name(std::vector<Wall>& walls, const ArchiveReader& in);
inline constexpr std::size_t no_wall = static_cast<std::size_t>(-1);

}  // namespace scree::core
