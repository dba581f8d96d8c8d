#pragma once
#include <scree/abi.h>

#include "core/scene/context.hpp"

namespace scree::core {

/// Reads the value of one property by its type, unit, range and choices. False when it is wrong (reported).
/// `varies`: a number may be an expression of x, y, z, or drawn.
bool read_value(const scree_property& property, bool varies, const Node& node, Setting& setting, Context& context);

}  // namespace scree::core
