#pragma once
#include <string>

#include "core/contact/rule.hpp"
#include "core/contact/scratch.hpp"

namespace scree::core {

/// The scratch as the batch that a law is handed: only what it declared is there.
scree_batch batch_of(const BoundRule& rule, uint32_t n, double dt, Scratch& scratch, const double** property,
                     double** state);

/// Tangents of a batch, as a law reports them: N/m, N/m, N m/rad, N m/rad, and shares of critical damping.
struct Tangents {
  double normal[SCREE_BATCH], shear[SCREE_BATCH], bending[SCREE_BATCH], twist[SCREE_BATCH];
  double ratio_normal[SCREE_BATCH], ratio_shear[SCREE_BATCH];
};
void tangents(const BoundRule& rule, uint32_t n, Scratch& scratch, Tangents& out);

/// Hands the batch in the scratch to the rule's law; false when the law threw for one of the contacts.
bool run_law(const BoundRule& rule, uint32_t n, double dt, Scratch& scratch);

/// The contact of the batch for which the law throws: each is tried alone. The state must be that of before the law
/// ran. `n` when it throws for none alone.
uint32_t find_thrower(const BoundRule& rule, uint32_t n, double dt, Scratch& scratch);

/// Throws Refusal (exit 4): the law threw for the contact of these pieces ("" when it is not known) at this cycle.
[[noreturn]] void refuse_thrower(const BoundRule& rule, const std::string& pieces, uint64_t cycle);

}  // namespace scree::core
