#pragma once
#include <scree/abi.h>

#include <cstdint>

namespace scree::core {

/// A stretch of listed pairs that the filter looks at together: separation of centres, its square, sum of radii, and
/// whether they touch.
struct Window {
  static constexpr uint32_t size = 64;
  double x[size], y[size], z[size], square[size], sum[size];
  int64_t near[size];
  uint32_t row[size + 8];  ///< rows are written in eights
};

/// One batch on its way through the stages, small enough for the first-level cache. One per thread.
/// The filter writes up to eight places past the end of a full batch, hence the padding.
struct alignas(64) Scratch {
  static constexpr uint32_t size = SCREE_BATCH;
  static constexpr uint32_t padded = SCREE_BATCH + 8;
  static constexpr uint32_t state_words = 16;
  double nx[padded], ny[padded], nz[padded];  ///< first the separation of centres, then the unit normal
  double gap[padded];                         ///< first the sum of radii
  double square[padded];                      ///< squared distance of centres
  double sign[padded];                        ///< -1 where the higher row has the lower id
  double vx[padded], vy[padded], vz[padded];
  double wx[padded], wy[padded], wz[padded];
  double tx[padded], ty[padded], tz[padded];
  double r1[padded], r2[padded], mass[padded];
  double arm_i[padded], arm_j[padded];  ///< from each centre to the contact point, m
  double fx[padded], fy[padded], fz[padded];
  double mx[padded], my[padded], mz[padded];
  double sliding[padded], event[padded];
  double energy[4][padded];  ///< strain, friction, dashpot, break
  uint8_t bonded[padded];
  double state[state_words][padded];
  double property[state_words * 2][padded];
  Window window;
  uint32_t slot[padded], row[padded], other[padded], where[padded];
};

}  // namespace scree::core
