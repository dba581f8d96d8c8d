#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "core/contact/scratch.hpp"
#include "core/world/balls.hpp"

namespace scree::core {

/// What the stages read of the balls; null where a column does not exist.
struct BallView {
  const double *x, *y, *z, *vx, *vy, *vz, *wx, *wy, *wz, *radius, *inverse_mass;
  explicit BallView(const Balls& balls);
};

/// A place in a touch list: the next slot to look at, and its row.
struct Cursor {
  uint64_t slot;
  std::size_t row, last_row;
};

/// What the filter needs of a list.
struct FilterInput {
  const uint64_t* begin;
  const uint32_t *other, *where;
  const double (*shift)[3];  ///< by image code; null without periodic axes
  double reach;
};

/// Fills the batch with the pairs that touch, from the cursor on; stops when the batch or `drops` has no room for
/// another window or the block ends. A slot whose contact has just ended goes into `drops` (room for Scratch::padded):
/// its state must be forgotten.
using FilterStage = uint32_t (*)(const BallView&, const FilterInput&, Cursor&, uint8_t* active, Scratch&,
                                 uint32_t* drops, uint32_t& dropped);
/// From separations to everything a law reads. True when an overlap exceeds limit times the smaller radius.
using GeometryStage = bool (*)(const BallView&, uint32_t n, double dt, double overlap_limit, Scratch&);
/// Forces beyond this are as useless as those that are no number: their squares are none.
constexpr double largest_square = std::numeric_limits<double>::max();
inline bool usable(const std::array<double, 3>& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] <= largest_square; }

/// Adds the forces of the batch to the records of a block, row by row. True when a force or moment is no usable number:
/// not finite, or so large that its square is not.
using ScatterStage = bool (*)(uint32_t n, std::size_t first_row, double* slice, Scratch&);

/// The stages of one instruction set. All sets give the same bits.
struct StageTable {
  FilterStage filter[2];          ///< [periodic]
  GeometryStage geometry[2][2];   ///< [spin][turn]
  ScatterStage scatter[3][2][2];  ///< [lean record, spin record with normal law, spin][moment][sum of sizes]
};
const StageTable& stages(int isa);

}  // namespace scree::core
