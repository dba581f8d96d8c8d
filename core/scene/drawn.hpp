#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/scene/numbers.hpp"

namespace scree::core {

/// Is it the name of a law of chance, as in `{normal: {...}}`?
bool is_distribution(const std::string& name);

struct Drawn {
  std::shared_ptr<Distribution> distribution;
  std::string unit;  ///< as written, "" for plain SI
};

/// `{normal: {mean: 30 MPa, sd: 9 MPa}}` and its like in place of a number. Errors are reported.
std::optional<Drawn> read_drawn(const Node& node, const Wanted& wanted, Context& context);

/// Keeps the values in the range of a property. False, and reported, when that leaves almost nothing or when a bound
/// that the scene gives lies outside.
bool cut_to_range(Distribution& distribution, const scree_property& property, const Place& place, Context& context);

}  // namespace scree::core
