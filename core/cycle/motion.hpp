#pragma once
#include <cstdint>
#include <vector>

#include "core/contact/slices.hpp"
#include "core/cycle/energy_balance.hpp"
#include "core/cycle/process.hpp"
#include "core/world/balls.hpp"

namespace scree::core {

/// One motion pass: halo sum, row processes, kick, drift.
struct MotionInput {
  Balls* balls = nullptr;
  Slices* slices = nullptr;
  const std::vector<const Process*>* adders = nullptr;
  const std::vector<const Process*>* scalers = nullptr;
  int isa = 0;
  uint64_t cycle = 0;
  double time = 0, dt_back = 0, dt = 0;  ///< s; dt_back is 0 after a start or an edit
  std::size_t sum_words = 0;             ///< of the row processes, one after the other
  bool energy = false;                   ///< also the work of the forces
};

/// What the guards and the next cycle need to know of a pass, by block.
struct MotionResult {
  double fastest = 0;  ///< largest |v|, m/s
  bool finite = true;
  RowWork work;  ///< if asked for
};

/// Words of sums that all these processes have.
std::size_t sum_words(const std::vector<const Process*>& processes);

/// `sums`: input.sum_words numbers of this block, which are added to.
MotionResult move_block(const MotionInput& input, std::size_t block, double* sums);

/// Net forces of up to SCREE_ROWS rows in first-level cache, one array per component.
struct RowForces {
  double force[3][SCREE_ROWS], moment[3][SCREE_ROWS];
};
/// Contact forces (folded), applied forces and processes that add; then, unless `net` is asked for, those that scale.
/// `sums` is null on an evaluation for output.
void gather_forces(const MotionInput& input, std::size_t first, std::size_t n, RowForces& forces, bool scale,
                   double* sums);
/// Adds the work of the forces on rows [first, first + n) over a time `span` with the velocities of now: of what beside
/// the contacts acts (`net` less the contact forces), of the scalers (`full` less `net`), and of prescribed motion.
void add_work(const MotionInput& input, std::size_t first, std::size_t n, const RowForces& net, const RowForces& full,
              double span, RowWork& work);
void apply_scalers(const MotionInput& input, std::size_t first, std::size_t n, RowForces& forces, double* sums);

}  // namespace scree::core
