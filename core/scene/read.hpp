#pragma once
#include "core/scene/context.hpp"

namespace scree::core {

/// `read_scene` with components from anywhere; tests and the fuzzer give tables of their own.
Scene read_scene(const ReadOptions& options, const OpenComponent& open);

}  // namespace scree::core
