#pragma once
#include <scree/abi.h>

#include <string>

namespace scree::core {

std::string type_text(const scree_property& property);   ///< "number", "box", "list of numbers", ...
std::string range_text(const scree_property& property);  ///< "at least 0, below 1", "one of a, b", "" when free
std::string mix_text(uint32_t mix);                      ///< "" where only the rule may give it
/// The default: a number with its unit; "" when there is none or it does not fit into one number.
std::string fallback_text(const scree_property& property);
/// A value as a scene would write it: the default, or the simplest one that the range allows.
/// `corner` tells vectors with a length apart: the k-th is (k, k, k), so that corners of a box come in order.
std::string sample_text(const scree_property& property, uint32_t corner = 0);
/// True when a scene may give it: not computed by the law alone.
bool is_input(const scree_property& property);

}  // namespace scree::core
