#pragma once
#include "core/contact/rule.hpp"
#include "core/run/archive.hpp"

namespace scree::core {

/// Words of laws as they were bound. Which of them vary, and the values that stand for all, follow from probing the
/// balls of that moment, so binding anew later might say otherwise.
void save_bound(const RuleBook& book, ArchiveWriter& out);
/// Into rules that were bound anew, before refresh().
void load_bound(RuleBook& book, const ArchiveReader& archive);

}  // namespace scree::core
