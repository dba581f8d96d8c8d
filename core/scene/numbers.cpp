#include "core/scene/numbers.hpp"

#include <charconv>
#include <cmath>

#include "core/base/nearest.hpp"
#include "core/scene/drawn.hpp"
#include "core/scene/units.hpp"

namespace scree::core {
namespace {

constexpr double largest_count = 9007199254740992.0;  // 2^53: above it a double skips whole numbers

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// A number with an optional unit, or not one.
struct Literal {
  enum class Kind { none, number, infinity, nan, out_of_range } kind = Kind::none;
  double value = 0;
  std::string unit;
};

bool starts_unit(const std::string& rest) {
  const char c = rest[0];
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return letter || c == '%' || static_cast<unsigned char>(c) >= 0x80 || rest.rfind("1/", 0) == 0;
}

Literal literal(const std::string& text) {
  Literal out;
  const bool negative = !text.empty() && text[0] == '-';
  const std::string body = text.substr(negative || (!text.empty() && text[0] == '+') ? 1 : 0);
  if (body == ".inf" || body == ".Inf" || body == ".INF") {
    out.kind = Literal::Kind::infinity;
    out.value = negative ? -INFINITY : INFINITY;
    return out;
  }
  if (body == ".nan" || body == ".NaN" || body == ".NAN") {
    out.kind = Literal::Kind::nan;
    return out;
  }
  const auto digit = [&](size_t i) { return i < body.size() && body[i] >= '0' && body[i] <= '9'; };
  if (!digit(0) && !(body[0] == '.' && digit(1))) return out;
  double value = 0;
  const auto [end, error] = std::from_chars(body.data(), body.data() + body.size(), value);
  const std::string rest = trimmed(std::string(end, static_cast<size_t>(body.data() + body.size() - end)));
  if (!rest.empty() && !starts_unit(rest)) return out;
  out.kind = error == std::errc() ? Literal::Kind::number : Literal::Kind::out_of_range;
  out.value = negative ? -value : value;
  out.unit = rest;
  return out;
}

std::string wants(const Wanted& wanted) {
  return "'" + wanted.name + "' wants " + (wanted.unit.empty() ? "a number" : units::dimension(wanted.unit));
}

std::optional<Number> from_literal(const Literal& read, const Node& node, const Wanted& wanted, Context& context) {
  const auto refuse = [&](const std::string& why) {
    context.report.error(node.place(), why);
    return std::nullopt;
  };
  if (read.kind == Literal::Kind::nan) return refuse("'" + wanted.name + "' is .nan: not a number is never a value");
  if (read.kind == Literal::Kind::out_of_range)
    return refuse("'" + wanted.name + "': " + describe(node) + " is beyond the range of a double");
  if (read.kind == Literal::Kind::infinity) {
    if (wanted.infinity && read.value > 0) return Number{read.value, nullptr, ""};
    return refuse("'" + wanted.name + "' cannot be infinite");
  }
  if (read.unit.empty()) return Number{read.value, nullptr, ""};
  if (read.unit == "cycle" || read.unit == "cycles")
    return refuse(wants(wanted) + ", " + describe(node) + " is a count of cycles");
  if (!units::known(read.unit))
    return refuse(
        "'" + wanted.name + "': '" + read.unit + "' is not a unit that UDUNITS-2 knows" +
        (node.quoted && read.unit.find(' ') != std::string::npos
             ? ": units stand outside expressions, as in `vars: {a: 25 mm}`"
             : suggestion(read.unit, {"N m", "mm",  "m",   "cm",  "um",    "kg/m3", "m/s",  "mm/s", "m/s2", "Pa", "kPa",
                                      "MPa", "GPa", "N",   "kN",  "MN",    "N/m",   "kN/m", "MN/m", "s",    "ms", "us",
                                      "kg",  "g",   "deg", "rad", "rad/s", "rpm",   "Hz",   "%",    "J"})));
  if (wanted.unit.empty()) return Number{units::to_si(read.value, read.unit), nullptr, read.unit};
  const auto converted = units::convert(read.value, read.unit, wanted.unit);
  if (!converted) return refuse(wants(wanted) + ", " + describe(node) + " is " + units::dimension(read.unit));
  if (!std::isfinite(*converted)) return refuse("'" + wanted.name + "' is beyond the range of a double");
  return Number{*converted, nullptr, read.unit};
}

bool is_position(const std::string& name) { return name == "x" || name == "y" || name == "z"; }

/// Are all names of the expression known? The only unknowns it may have are x, y, z.
bool names_known(const Formula& formula, const Node& node, const Wanted& wanted, Context& context) {
  for (const std::string& name : formula.names()) {
    if (is_position(name) && wanted.position) continue;
    if (is_position(name)) {
      context.report.error(node.place(), "'" + wanted.name + "' cannot depend on position, and '" + name +
                                             "' is not a var: give a number, or add it to `vars:`");
      return false;
    }
    std::vector<std::string> candidates = Formula::functions();
    for (const auto& [var, value] : context.vars) candidates.push_back(var);
    const bool bare = !node.quoted && formula.text() == name;
    context.report.error(node.place(), (bare ? wants(wanted) + ", '" + name + "' is neither a number nor a var"
                                             : "'" + wanted.name + "': unknown name '" + name + "' in the expression") +
                                           suggestion(name, candidates));
    return false;
  }
  return true;
}

std::optional<Number> from_expression(const std::string& text, const Node& node, const Wanted& wanted,
                                      Context& context) {
  const auto unit = context.var_units.find(text);
  if (unit != context.var_units.end() && !unit->second.empty() && !wanted.unit.empty() &&
      !units::same_dimension(unit->second, wanted.unit)) {
    context.report.error(node.place(), wants(wanted) + ", the var '" + text + "' is " + units::dimension(unit->second));
    return std::nullopt;
  }
  auto formula = read_formula(text, node.place(), wanted.name, context);
  if (!formula || !names_known(*formula, node, wanted, context)) return std::nullopt;
  Number number;
  if (unit != context.var_units.end()) number.unit = unit->second;
  if (!formula->names().empty()) {
    number.formula = std::move(formula);
    return number;
  }
  number.value = formula->evaluate({});
  if (std::isfinite(number.value)) return number;
  context.report.error(node.place(), "'" + wanted.name + "': the expression '" + text + "' gives no finite number");
  return std::nullopt;
}

}  // namespace

std::string suggestion(const std::string& text, const std::vector<std::string>& candidates) {
  const std::string near = nearest_name(text, candidates);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

std::shared_ptr<Formula> read_formula(const std::string& text, const Place& place, const std::string& name,
                                      Context& context) {
  try {
    return std::make_shared<Formula>(trimmed(text), context.vars, place);
  } catch (const Refusal& refusal) {
    context.report.error(place, "'" + name + "': " + refusal.what());
    return nullptr;
  }
}

std::optional<Number> read_number(const Node& node, const Wanted& wanted, Context& context) {
  const std::string text = node.is_scalar() ? trimmed(node.text) : "";
  if (node.is_map() && !node.keys.empty() && is_distribution(node.keys[0].text)) {
    context.report.error(node.place(), "'" + wanted.name +
                                           "' cannot be drawn: only number properties of rules and of `contact:` of "
                                           "ball sets can");
    return std::nullopt;
  }
  if (text.empty()) {
    context.report.error(node.place(),
                         wants(wanted) + ", not " + (node.is_scalar() ? "an empty text" : describe(node)));
    return std::nullopt;
  }
  const Literal read = literal(text);
  if (read.kind != Literal::Kind::none) return from_literal(read, node, wanted, context);
  return from_expression(text, node, wanted, context);
}

std::optional<double> read_plain(const Node& node, const Wanted& wanted, Context& context) {
  Wanted plain = wanted;
  plain.position = false;
  const auto number = read_number(node, plain, context);
  if (!number) return std::nullopt;
  return number->value;
}

std::optional<Triple> read_triple(const Node& node, const Wanted& wanted, Context& context) {
  if (!node.is_list() || node.items.size() != 3) {
    const std::string got = node.is_list() ? "a list of " + std::to_string(node.items.size()) : describe(node);
    context.report.error(node.place(), "'" + wanted.name + "' wants three numbers, as in [0, 0, 1], not " + got);
    return std::nullopt;
  }
  Triple out{};
  bool good = true;
  for (size_t i = 0; i < 3; ++i) {
    const auto value = read_plain(node.items[i], wanted, context);
    good = good && value;
    out[i] = value.value_or(0.0);
  }
  if (!good) return std::nullopt;
  return out;
}

std::optional<uint64_t> read_count(const Node& node, const std::string& name, bool cycles, Context& context) {
  Node bare = node;
  if (cycles && node.is_scalar()) {
    const Literal read = literal(trimmed(node.text));
    if (read.unit == "cycle" || read.unit == "cycles") bare.text = number_text(read.value);
  }
  const auto value = read_plain(bare, {name}, context);
  if (!value) return std::nullopt;
  if (!(*value >= 0) || *value > largest_count || *value != std::floor(*value)) {
    context.report.error(node.place(), "'" + name + "' wants a whole number from 0 to 2^53, not " + describe(node));
    return std::nullopt;
  }
  return static_cast<uint64_t>(*value);
}

std::optional<Span> read_span(const Node& node, const std::string& name, bool zero_allowed, Context& context) {
  Span span;
  const Literal read = node.is_scalar() ? literal(trimmed(node.text)) : Literal{};
  if (read.unit == "cycle" || read.unit == "cycles") {
    span.cycles = read_count(node, name, true, context);
    if (!span.cycles) return std::nullopt;
  } else {
    span.time = read_plain(node, {name, "s"}, context);
    if (!span.time) return std::nullopt;
  }
  const double size = span.cycles ? static_cast<double>(*span.cycles) : *span.time;
  if (size > 0 || (zero_allowed && size == 0)) return span;
  context.report.error(node.place(),
                       "'" + name + "' must be " + (zero_allowed ? "at least" : "above") + " 0, not " + describe(node));
  return std::nullopt;
}

std::optional<bool> read_bool(const Node& node, const std::string& name, Context& context) {
  if (node.is_scalar() && !node.quoted && node.text == "true") return true;
  if (node.is_scalar() && !node.quoted && node.text == "false") return false;
  context.report.error(node.place(), "'" + name + "' wants true or false, not " + describe(node));
  return std::nullopt;
}

std::optional<std::string> read_word(const Node& node, const std::string& name, Context& context) {
  if (node.is_scalar() && !node.text.empty()) return node.text;
  context.report.error(node.place(), "'" + name + "' wants a text, not " +
                                         (node.is_scalar() ? std::string("an empty text") : describe(node)));
  return std::nullopt;
}

std::vector<Name> read_words(const Node& node, const std::string& name, Context& context) {
  std::vector<Name> out;
  if (node.is_list()) {
    for (const Node& item : node.items)
      if (const auto word = read_word(item, name, context)) out.push_back({*word, item.place()});
  } else if (const auto word = read_word(node, name, context)) {
    out.push_back({*word, node.place()});
  }
  return out;
}

}  // namespace scree::core
