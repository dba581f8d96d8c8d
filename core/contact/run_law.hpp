#pragma once
#include <limits>
#include <string>

#include "core/contact/rule.hpp"
#include "core/contact/scratch.hpp"

namespace scree::core {

/// How a law is called: in which of its two forms, and whether it also fills the energies.
struct LawCall {
  double dt = 0;  ///< of the drift that led here, s
  bool bonded = false, energy = false;
};

/// Where the batch points to its columns; must outlive it.
struct BatchColumns {
  const double* property[2 * Scratch::state_words];
  double *state[Scratch::state_words], *energy[4];
};
/// The scratch as the batch that a law is handed: only what it declared is there.
scree_batch batch_of(const BoundRule& rule, uint32_t n, const LawCall& call, Scratch& scratch, BatchColumns& columns);

/// Tangents of a batch, as a law reports them: N/m, N/m, N m/rad, N m/rad, and shares of critical damping.
struct Tangents {
  double normal[SCREE_BATCH], shear[SCREE_BATCH], bending[SCREE_BATCH], twist[SCREE_BATCH];
  double ratio_normal[SCREE_BATCH], ratio_shear[SCREE_BATCH];
};
void tangents(const BoundRule& rule, uint32_t n, bool bonded, Scratch& scratch, Tangents& out);

/// What run_law answers when the law threw for one of the contacts.
constexpr uint32_t law_threw = std::numeric_limits<uint32_t>::max();
/// Hands the batch in the scratch to the rule's law; how many bonds broke (their modes are in `event`), or law_threw.
/// A law without energies leaves them at zero.
uint32_t run_law(const BoundRule& rule, uint32_t n, const LawCall& call, Scratch& scratch);

/// The contact of the batch for which the law throws: each is tried alone. The state must be that of before the law
/// ran. `n` when it throws for none alone.
uint32_t find_thrower(const BoundRule& rule, uint32_t n, const LawCall& call, Scratch& scratch);

/// Throws Refusal (exit 4): the law threw for the contact of these pieces ("" when it is not known) at this cycle.
[[noreturn]] void refuse_thrower(const BoundRule& rule, const std::string& pieces, uint64_t cycle);

}  // namespace scree::core
