#pragma once
#include "core/contact/rule.hpp"
#include "core/contact/scratch.hpp"

namespace scree::core {

/// Puts a contact that could be at place k of the batch: pieces at rest along x, as born, nothing remembered. `gap` in
/// m.
void load_trial(const BoundRule& rule, const Birth& birth, double gap, uint32_t k, Scratch& s);

}  // namespace scree::core
