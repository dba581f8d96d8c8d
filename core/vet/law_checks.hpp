#pragma once
#include "core/vet/check.hpp"
#include "core/vet/journey.hpp"

/// The checks of contact models, by what they look at. Each is a row of component_checks.
namespace scree::core::vet {

// law_symmetry.cpp
Outcome exchange(const Subject& subject);
Outcome frame_turn(const Subject& subject);
Outcome turns_along(const Subject& subject);
// law_stiffness.cpp
Outcome stiffness_touch(const Subject& subject);
Outcome stiffness_rotation(const Subject& subject);
Outcome stiffness_bonded(const Subject& subject);
Outcome stiffness_generous(const Subject& subject);
Outcome dashpot_share(const Subject& subject);
// law_energy.cpp
Outcome nothing_back(const Subject& subject);
Outcome nothing_back_bonded(const Subject& subject);
Outcome energy_balance(const Subject& subject);
Outcome energy_balance_bonded(const Subject& subject);
// law_continuity.cpp
Outcome continuity(const Subject& subject);
Outcome reach_honest(const Subject& subject);
Outcome bond_breaks_once(const Subject& subject);
// law_bits.cpp
Outcome batch_sizes(const Subject& subject);
Outcome instruction_sets(const Subject& subject);
Outcome varying_properties(const Subject& subject);
Outcome energy_variant(const Subject& subject);
Outcome normal_only_variant(const Subject& subject);
Outcome bonded_variants(const Subject& subject);
// law_purity.cpp
Outcome state_round_trip(const Subject& subject);
Outcome repeatable(const Subject& subject);
Outcome law_allocates(const Subject& subject);
Outcome law_global_state(const Subject& subject);
Outcome law_float_mode(const Subject& subject);
Outcome law_trespass(const Subject& subject);
// law_extremes.cpp
Outcome accepts_inputs(const Subject& subject);
Outcome extremes_finite(const Subject& subject);
Outcome nan_passes(const Subject& subject);
// law_speed.cpp
Outcome law_speed(const Subject& subject);

/// Calls f(case, part) for random cases of the model and every part that it has.
template <class F>
void for_cases(const Subject& subject, std::size_t count, uint64_t seed, F f) {
  const scree_contact_model& model = subject.component->contact_model();
  const std::vector<Case> all = cases(model, count, seed);
  for (const Part part : parts(model))
    for (const Case& c : all) f(c, part);
}

inline std::string text_of(const Case& c, Part part, const Seen& seen) {
  return std::string(part_name(part)) + ", " + c.text + "; " + text_of(seen);
}

}  // namespace scree::core::vet
