#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace scree::core {

/// The candidate a mistyped name most likely meant, or "" when none is near enough to be worth suggesting. Case does
/// not count; a swap of two neighbouring letters is one mistake; a name that begins with the other (fric, friction) is
/// near. Of equally near candidates the first wins. [any thread]
std::string nearest_name(std::string_view text, const std::vector<std::string>& candidates);

}  // namespace scree::core
