#include "core/cli/property_text.hpp"

#include <cmath>
#include <string_view>

#include "core/base/log.hpp"

namespace scree::core {

namespace {

std::string unit_of(const scree_property& property) {
  const std::string_view unit = property.unit ? property.unit : "";
  return unit.empty() || unit == "1" ? "" : " " + std::string(unit);
}

std::string number_text(double value) {
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return fmt::format("{}", value == 0 ? 0.0 : value);
}

std::string first_choice(const scree_property& property) {
  const std::string_view words = property.choices ? property.choices : "";
  return std::string(words.substr(0, words.find(' ')));
}

/// Inside the range: 1 if that is allowed, else next to a bound.
double inside(const scree_property& property) {
  const bool low = (property.flags & SCREE_HAS_LOW) != 0, high = (property.flags & SCREE_HAS_HIGH) != 0;
  if (low && property.low >= 1) return (property.flags & SCREE_LOW_OPEN) != 0 ? property.low + 1 : property.low;
  if (high && property.high <= 1) return low ? 0.5 * (property.low + property.high) : property.high - 1;
  return 1;
}

std::string row_text(const scree_property& property) {
  std::string out;
  for (uint32_t k = 0; k < property.column_count; ++k) {
    const scree_property& column = property.columns[k];
    out += (k == 0 ? "" : ", ") + std::string(column.name) + ": " + sample_text(column);
  }
  return "[{" + out + "}]";
}

}  // namespace

bool is_input(const scree_property& property) { return (property.flags & SCREE_DERIVED) == 0 || property.forms != 0; }

std::string type_text(const scree_property& property) {
  switch (property.type) {
    case SCREE_NUMBER:
      return "number";
    case SCREE_INTEGER:
      return "whole number";
    case SCREE_BOOLEAN:
      return "true or false";
    case SCREE_VECTOR:
      return "vector";
    case SCREE_TEXT:
      return (property.flags & SCREE_FILE) != 0 ? "path of a file" : "word";
    case SCREE_NUMBERS:
      return property.words == 2 ? "two numbers" : "list of numbers";
    case SCREE_VECTORS:
      return property.words == 6 ? "box: two corners" : "list of vectors";
    case SCREE_TEXTS:
      return "list of words";
    case SCREE_TABLE:
      return "list of records";
    default:
      return "unknown";
  }
}

std::string range_text(const scree_property& property) {
  if (property.choices != nullptr && *property.choices != '\0') {
    std::string words = property.choices;
    for (std::size_t at = 0; (at = words.find(' ', at)) != std::string::npos; at += 2) words.replace(at, 1, ", ");
    return "one of " + words;
  }
  std::string out;
  if ((property.flags & SCREE_HAS_LOW) != 0)
    out = ((property.flags & SCREE_LOW_OPEN) != 0 ? "above " : "at least ") + number_text(property.low);
  if ((property.flags & SCREE_HAS_HIGH) != 0)
    out += (out.empty() ? "" : ", ") + std::string((property.flags & SCREE_HIGH_OPEN) != 0 ? "below " : "at most ") +
           number_text(property.high);
  if ((property.flags & SCREE_POSITIVE_INFINITY) != 0) out += (out.empty() ? "" : ", ") + std::string("or .inf");
  return out;
}

std::string mix_text(uint32_t mix) {
  switch (mix) {
    case SCREE_MIX_SERIES:
      return "in series: a b / (a + b)";
    case SCREE_MIX_LEAST:
      return "the smaller one";
    case SCREE_MIX_MEAN:
      return "mean: (a + b) / 2";
    case SCREE_MIX_HARMONIC:
      return "harmonic: 2 a b / (a + b)";
    default:
      return "";
  }
}

std::string fallback_text(const scree_property& property) {
  if ((property.flags & SCREE_HAS_FALLBACK) == 0) return "";
  if (property.type == SCREE_BOOLEAN) return property.fallback != 0 ? "true" : "false";
  return number_text(property.fallback) + unit_of(property);
}

std::string sample_text(const scree_property& property, uint32_t corner) {
  if (const std::string fallback = fallback_text(property); !fallback.empty()) return fallback;
  const std::string number = number_text(inside(property)), unit = unit_of(property);
  switch (property.type) {
    case SCREE_BOOLEAN:
      return "true";
    case SCREE_VECTOR:
      if (unit.empty()) return "[0, 0, 1]";
      return fmt::format("[{0}{1}, {0}{1}, {0}{1}]", corner, unit);
    case SCREE_TEXT:
      if ((property.flags & SCREE_FILE) != 0) return "balls.csv";
      return property.choices != nullptr ? first_choice(property) : "word";
    case SCREE_NUMBERS:
      return property.words == 2 ? "[" + number + unit + ", " + number + unit + "]" : "[" + number + unit + "]";
    case SCREE_VECTORS:
      return property.words == 6 ? "[[0, 0, 0], [1" + unit + ", 1" + unit + ", 1" + unit + "]]" : "[[0, 0, 0]]";
    case SCREE_TEXTS:
      return property.choices != nullptr ? "[" + first_choice(property) + "]" : "[word]";
    case SCREE_TABLE:
      return row_text(property);
    default:
      return number + unit;
  }
}

}  // namespace scree::core
