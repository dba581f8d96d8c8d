#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/run/published.hpp"

namespace scree::core {

/// `walls.NAME.force.x`, `.moment`, `.position`, `.displacement`, `.velocity`, `.spin`, `.contacts`.
std::optional<Published> find_wall_quantity(const std::string& name, Engine& engine);
/// `balls.ID.position.x`, `.velocity`, `.spin`, `.force`, `.radius`, `.mass`.
std::optional<Published> find_ball_quantity(const std::string& name, Engine& engine, Instant& now);
/// `contacts.ID.ID2.force.x`, `.normal_force`, `.shear_force`, `.overlap`, and the same with a wall's name in place of
/// ID2. The force is that on the piece named second; all are 0 while the two do not touch.
std::optional<Published> find_contact_quantity(const std::string& name, Engine& engine, Instant& now);

/// The wall that a name `walls.NAME...` or `contacts.ID.NAME...` speaks of, else "".
std::string wall_of_quantity(const std::string& name);
/// The ids of balls that `balls.ID...` or `contacts.ID.ID2...` speak of.
std::vector<uint64_t> balls_of_quantity(const std::string& name);

/// Appends the quantities of a wall; those of the ball or contact that `like` begins with.
void add_wall_names(const std::string& wall, std::vector<std::string>& names);
void add_piece_names(const std::string& like, std::vector<std::string>& names);

}  // namespace scree::core
