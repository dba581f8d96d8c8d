#pragma once
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

/// Hands the batch in the scratch to the rule's law. Throws Refusal (exit 4) when the law threw.
void run_law(const BoundRule& rule, uint32_t n, double dt, Scratch& scratch);

}  // namespace scree::core
