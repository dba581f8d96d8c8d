#pragma once
#include "core/contact/rule.hpp"
#include "core/contact/scratch.hpp"

namespace scree::core {

/// The scratch as the batch that a law is handed: only what it declared is there.
scree_batch batch_of(const BoundRule& rule, uint32_t n, double dt, Scratch& scratch, const double** property,
                     double** state);

/// Hands the batch in the scratch to the rule's law. Throws Refusal (exit 4) when the law threw.
void run_law(const BoundRule& rule, uint32_t n, double dt, Scratch& scratch);

}  // namespace scree::core
