#include <algorithm>
#include <cmath>

#include "core/scene/parts.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

const char* const reductions[] = {"sum", "min", "max", "mean", "count"};

std::shared_ptr<Formula> formula_of(const Node& node, const std::string& name, Context& context) {
  const auto text = read_word(node, name, context);
  return text ? read_formula(*text, node.place(), name, context) : nullptr;
}

std::optional<double> any_number(const Node& node, const std::string& name, Context& context) {
  return read_plain(node, {name, ""}, context);
}

void read_bounds(Mapping& mapping, Expect& expect, Context& context) {
  if (const Node* between = mapping.take("between")) {
    if (!between->is_list() || between->items.size() != 2) {
      context.report.error(between->place(), "'between' wants two numbers, as in [5 MPa, 35 MPa]");
    } else {
      expect.low = any_number(between->items[0], "between", context);
      expect.high = any_number(between->items[1], "between", context);
      if (expect.low && expect.high && *expect.low > *expect.high)
        context.report.error(between->place(), "'between' wants the smaller number first");
    }
  }
  if (const Node* low = mapping.take("at_least")) expect.low = any_number(*low, "at_least", context);
  if (const Node* high = mapping.take("at_most")) expect.high = any_number(*high, "at_most", context);
}

void read_equals(Mapping& mapping, Expect& expect, Context& context) {
  const Node* equals = mapping.take("equals");
  const Node* within = mapping.take("within");
  if (equals) expect.equals = any_number(*equals, "equals", context);
  if (equals && !within)
    context.report.error(equals->place(), "'equals' wants 'within' beside it, as in within: 0.1 %");
  if (within && !equals) context.report.error(within->place(), "'within' wants 'equals' beside it");
  if (!within || !expect.equals) return;
  auto size = any_number(*within, "within", context);
  if (!size) return;
  const bool relative = within->is_scalar() && !within->text.empty() && within->text.find('%') != std::string::npos;
  if (!(*size >= 0)) context.report.error(within->place(), "'within' must be at least 0, not " + describe(*within));
  if (relative && *expect.equals == 0)
    context.report.error(within->place(), "'within' in % of an expected 0 allows nothing: give an absolute tolerance");
  expect.tolerance = relative ? *size * std::abs(*expect.equals) : *size;
}

/// The expectation on one line, as the report prints it.
std::string written(const Node& node) {
  std::string out;
  for (size_t i = 0; i < node.keys.size(); ++i) {
    if (node.keys[i].text == "source") continue;
    std::string value = node.items[i].text;
    if (node.items[i].is_list()) {
      value = "[";
      for (size_t k = 0; k < node.items[i].items.size(); ++k) value += (k ? ", " : "") + node.items[i].items[k].text;
      value += "]";
    }
    if (node.keys[i].text == "quantity")
      out.insert(0, value + (out.empty() ? "" : " "));
    else
      out += (out.empty() ? "" : " ") + node.keys[i].text + " " + value;
  }
  return out;
}

}  // namespace

const std::vector<std::string>& ball_columns() {
  static const std::vector<std::string> names = {"x",  "y",      "z",    "vx",     "vy",    "vz", "wx",      "wy",
                                                 "wz", "radius", "mass", "volume", "speed", "id", "contacts"};
  return names;
}

std::shared_ptr<Formula> read_over_balls(const Node& node, const std::string& name, Context& context) {
  auto formula = formula_of(node, name, context);
  if (!formula) return nullptr;
  const std::vector<std::string>& columns = ball_columns();
  bool good = true;
  for (const std::string& used : formula->constants()) {
    if (std::find(columns.begin(), columns.end(), used) == columns.end()) continue;
    context.report.error(node.place(),
                         "'" + name + "': '" + used + "' is a var and a column of the balls: rename the var");
    good = false;
  }
  for (const std::string& used : formula->names()) {
    if (std::find(columns.begin(), columns.end(), used) != columns.end()) continue;
    std::vector<std::string> candidates = columns;
    for (const auto& [var, value] : context.vars) candidates.push_back(var);
    context.report.error(node.place(), "'" + name + "': unknown name '" + used + "' in an expression over balls" +
                                           suggestion(used, candidates) + "  (" + list_of(columns) + ")");
    good = false;
  }
  return good ? formula : nullptr;
}

Quantity read_quantity(const Key& name, const Node& node, Context& context) {
  Quantity quantity;
  quantity.name = name.text;
  quantity.place = name.spot.place();
  check_name(name, "quantity", context);
  const auto& functions = Formula::functions();
  if (name.text == "pi" || std::find(functions.begin(), functions.end(), name.text) != functions.end())
    context.report.error(quantity.place, "'" + name.text + "' is taken by expressions: choose another name");
  if (context.vars.contains(name.text))
    context.report.error(quantity.place, "'" + name.text + "' is a var already: rename the var or the quantity");
  if (!node.is_map()) {
    quantity.formula = formula_of(node, name.text, context);
    return quantity;
  }
  Mapping mapping(node, "quantity '" + name.text + "'", context);
  for (const char* const word : reductions) {
    const Node* found = mapping.take(word);
    if (!found) continue;
    if (!quantity.reduction.empty()) {
      context.report.error(found->place(), mapping.what() + " has both '" + quantity.reduction + "' and '" + word +
                                               "': one quantity is one number");
      continue;
    }
    quantity.reduction = word;
    if (quantity.reduction == "count")
      quantity.over = read_word(*found, word, context).value_or("");
    else
      quantity.each = read_over_balls(*found, word, context);
  }
  if (quantity.reduction.empty())
    context.report.error(node.place(), mapping.what() + " wants one of sum, min, max, mean, count, or an expression");
  if (quantity.reduction != "count") {
    const Node* over = mapping.take("over");
    quantity.over = over ? read_word(*over, "over", context).value_or("") : "balls";
  }
  if (const Node* where = mapping.take("where")) quantity.where = read_over_balls(*where, "where", context);
  mapping.finish();
  return quantity;
}

Record read_record(const Key& name, const Node& node, Context& context) {
  Record record;
  record.name = name.text;
  record.place = name.spot.place();
  check_file_name(name.text, record.place, "record", context);
  Mapping mapping(node, "record '" + name.text + "'", context);
  if (const Node* every = mapping.need("every"))
    if (const auto span = read_span(*every, "every", false, context)) record.every = *span;
  if (const Node* quantities = mapping.take("quantities")) {
    for (const Name& text : read_words(*quantities, "quantities", context))
      if (auto formula = read_formula(text.text, text.place, "quantities", context))
        record.quantities.push_back(std::move(formula));
  }
  if (const Node* fields = mapping.take("fields")) record.fields = read_words(*fields, "fields", context);
  if (mapping.is_map() || node.is_null()) record.writer = read_use(mapping, Kind::writer, "writer", context);
  mapping.finish();
  return record;
}

Expect read_expect(const Node& node, Context& context) {
  Expect expect;
  expect.place = node.place();
  Mapping mapping(node, "an entry of `expect`", context);
  if (const Node* quantity = mapping.need("quantity")) expect.quantity = formula_of(*quantity, "quantity", context);
  read_bounds(mapping, expect, context);
  read_equals(mapping, expect, context);
  if (const Node* source = mapping.take("source")) expect.source = read_word(*source, "source", context).value_or("");
  if (mapping.is_map() && !(mapping.has("between") || mapping.has("at_least") || mapping.has("at_most") ||
                            mapping.has("equals") || mapping.has("within")))
    context.report.error(node.place(), "an entry of `expect` wants between, at_least, at_most, or equals and within");
  if (mapping.has("between") && (mapping.has("at_least") || mapping.has("at_most")))
    context.report.error(node.place(), "'between' says both bounds: drop at_least and at_most");
  mapping.finish();
  if (node.is_map()) expect.text = written(node);
  return expect;
}

Cell read_cell(const Node& node, Context& context) {
  Cell cell;
  cell.place = node.place();
  Mapping mapping(node, "`cell`", context);
  const Node* low = mapping.need("low");
  const Node* high = mapping.need("high");
  const auto corner = low ? read_triple(*low, {"low", "m"}, context) : std::nullopt;
  const auto other = high ? read_triple(*high, {"high", "m"}, context) : std::nullopt;
  if (corner && other) {
    cell.low = *corner;
    cell.high = *other;
    for (size_t i = 0; i < 3; ++i)
      if (!(cell.low[i] < cell.high[i]))
        context.report.error(high->place(),
                             std::string("`cell` is empty along ") + "xyz"[i] + ": 'low' must be below 'high'");
  }
  if (const Node* periodic = mapping.take("periodic")) {
    for (const Name& axis : read_words(*periodic, "periodic", context)) {
      if (axis.text != "x" && axis.text != "y" && axis.text != "z")
        context.report.error(axis.place, "'periodic' wants axes, as in [x, y], not '" + axis.text + "'");
      else
        cell.periodic[static_cast<size_t>(axis.text[0] - 'x')] = true;
    }
  }
  mapping.finish();
  return cell;
}

}  // namespace scree::core
