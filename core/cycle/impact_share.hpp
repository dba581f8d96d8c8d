#pragma once

namespace scree::core {

/// The largest step in a collision, as a share of the stable limit of the pair: by itself, and with `timestep:
/// accurate`.
inline constexpr double impact_share = 0.3, accurate_share = 0.1;

/// Of the smaller radius: as far a pair may close in one cycle, so that no contact is born deeper.
inline constexpr double birth_depth = 0.05;

}  // namespace scree::core
