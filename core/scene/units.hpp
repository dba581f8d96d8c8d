#pragma once
#include <optional>
#include <string>

namespace scree::core {

/// Units of measure with their dimensions, by UDUNITS-2; its database is loaded when the first unit is met.
/// Throws Refusal(Exit::io) when it cannot be. Not affected by the locale. [one thread]
namespace units {

bool known(const std::string& unit);

/// `value` in `unit`, in the SI unit `wanted`; nothing when the dimensions differ (an angle is not a pure number).
std::optional<double> convert(double value, const std::string& unit, const std::string& wanted);

/// `value` in `unit`, in SI base units. The unit must be known.
double to_si(double value, const std::string& unit);

/// Do both name the same kind of quantity?
bool same_dimension(const std::string& one, const std::string& other);

/// "a length", "a pressure", ...: for messages.
std::string dimension(const std::string& unit);

}  // namespace units
}  // namespace scree::core
