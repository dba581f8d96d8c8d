#pragma once
#include <cstdint>

namespace scree::core {

/// Balls one behind the other, and where one stands that may be near them.
struct NearRun {
  static constexpr uint32_t most = 64;  ///< balls of a run
  const double *x, *y, *z, *radius;     ///< readable up to the next multiple of eight
  uint32_t count;
  double at[3], own, margin;  ///< where, its radius, and how far surfaces may be apart, m
  double edge[3], half[3];    ///< of the periodic cell; 0 and infinite along other axes, m
};

/// Writes to `hits` (room for `most`) which balls of the run are nearer than the margin, and how many they are. A
/// distance that is no number counts as near. [any thread]
using NearStage = uint32_t (*)(const NearRun& run, uint32_t* hits);
/// For an instruction set as of core/base/isa.hpp: the same bits on all.
NearStage near_stage(int isa);

}  // namespace scree::core
