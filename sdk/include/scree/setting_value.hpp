#pragma once
/// Checks of one value on its way from a scene into a member; used by settings.hpp.
#include <scree/abi.h>
#include <scree/math.hpp>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

namespace scree {

inline scree_property blank_property(uint32_t type, uint32_t words, const char* name, const char* unit,
                                     const char* doc) {
  scree_property property{};
  property.struct_size = sizeof property;
  property.type = type;
  property.name = name;
  property.unit = unit;
  property.doc = doc;
  property.words = words;
  return property;
}

inline Vec3 vec3(const double* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

/// Shortest decimal form that reads back as the same double, whatever the locale.
inline std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

template <class Whole>
Whole whole(const char* name, double value) {
  constexpr double low = static_cast<double>(std::numeric_limits<Whole>::min());
  constexpr double high = static_cast<double>(std::numeric_limits<Whole>::max());
  if (value != std::floor(value) || value < low || value >= high)
    throw std::runtime_error(std::string("'") + name + "' wants an integer from " + shortest(low) + " to " +
                             shortest(high) + ", not " + shortest(value));
  return static_cast<Whole>(value);
}

inline void check_corners(const char* name, const Vec3& low, const Vec3& high) {
  for (std::size_t k = 0; k < 3; ++k)
    if (!(low[k] < high[k]))
      throw std::runtime_error(std::string("'") + name + "' wants its lower corner first: " + "xyz"[k] + " goes from " +
                               shortest(low[k]) + " to " + shortest(high[k]));
}

inline void check_numbers(const scree_property& property, const double* numbers, std::size_t count) {
  const auto refuse = [&](double value, const std::string& why) {
    throw std::runtime_error(std::string("'") + property.name + "' is " + shortest(value) + ", but must be " + why);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const double value = numbers[k];
    const bool infinity_allowed = (property.flags & SCREE_POSITIVE_INFINITY) != 0 && value > 0;
    if (!std::isfinite(value) && !(std::isinf(value) && infinity_allowed)) refuse(value, "a finite number");
    if ((property.flags & SCREE_HAS_LOW) != 0) {
      const bool open = (property.flags & SCREE_LOW_OPEN) != 0;
      if (open ? value <= property.low : value < property.low)
        refuse(value, (open ? "above " : "at least ") + shortest(property.low));
    }
    if ((property.flags & SCREE_HAS_HIGH) != 0) {
      const bool open = (property.flags & SCREE_HIGH_OPEN) != 0;
      if (open ? value >= property.high : value > property.high)
        refuse(value, (open ? "below " : "at most ") + shortest(property.high));
    }
  }
}

inline void check_choice(const scree_property& property, std::string_view word) {
  if (property.choices == nullptr) return;
  std::string_view rest = property.choices;
  while (!rest.empty()) {
    const std::size_t space = rest.find(' ');
    if (rest.substr(0, space) == word) return;
    rest = space == std::string_view::npos ? std::string_view() : rest.substr(space + 1);
  }
  throw std::runtime_error(std::string("'") + property.name + "' is '" + std::string(word) +
                           "', but must be one of: " + property.choices);
}

/// The shape the type promises, then bounds and choices. Throws with the reason.
inline void check_value(const scree_property& property, const scree_value& value) {
  const bool textual = property.type == SCREE_TEXT || property.type == SCREE_TEXTS;
  bool fits = value.type == property.type;
  if (textual) {
    fits = fits && (property.type == SCREE_TEXTS || value.text_count == 1);
    fits = fits && (value.texts != nullptr || value.text_count == 0);
  } else {
    const std::size_t count = std::size_t{value.rows} * value.columns;
    const bool listed =
        property.type == SCREE_NUMBERS || property.type == SCREE_VECTORS || property.type == SCREE_TABLE;
    const uint32_t wide = property.type == SCREE_VECTORS ? 3 : property.type == SCREE_TABLE ? property.words : 1;
    if (listed) fits = fits && (value.rows == 0 || value.columns == wide);
    if (property.type != SCREE_TABLE && property.words != 0) fits = fits && count == property.words;
    fits = fits && (value.numbers != nullptr || count == 0);
  }
  if (!fits) throw std::runtime_error(std::string("'") + property.name + "' has a value of another type or length");
  if (textual) {
    for (uint32_t k = 0; k < value.text_count; ++k) check_choice(property, value.texts[k]);
  } else if (property.type != SCREE_TABLE) {
    check_numbers(property, value.numbers, std::size_t{value.rows} * value.columns);
  }
}

}  // namespace scree
