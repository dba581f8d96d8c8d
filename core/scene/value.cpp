#include "core/scene/value.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/scene/drawn.hpp"
#include "core/scene/files.hpp"
#include "core/scene/mapping.hpp"
#include "core/scene/numbers.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

Wanted wanted_for(const scree_property& property) {
  return {property.name, unit_of(property), (property.flags & SCREE_POSITIVE_INFINITY) != 0, false};
}

bool in_range(const scree_property& property, double value, const Node& node, Context& context) {
  const auto why = range_error(property, value);
  if (why) context.report.error(node.place(), *why);
  return !why;
}

std::vector<std::string> choices_of(const scree_property& property) {
  std::vector<std::string> out;
  std::istringstream stream(property.choices ? property.choices : "");
  for (std::string word; stream >> word;) out.push_back(word);
  return out;
}

class ValueReader {
 public:
  ValueReader(const scree_property& property, Context& context) : property_(property), context_(context) {}

  bool number(const Node& node, bool varies, Setting& setting) {
    Wanted wanted = wanted_for(property_);
    wanted.position = varies;
    if (varies && node.is_map()) {
      const auto read = read_drawn(node, wanted, context_);
      if (!read || !cut_to_range(*read->distribution, property_, node.place(), context_)) return false;
      setting.drawn = read->distribution;
      return true;
    }
    const auto read = read_number(node, wanted, context_);
    if (!read) return false;
    if (read->formula) {
      setting.formula = read->formula;
      return true;
    }
    if (!in_range(property_, read->value, node, context_)) return false;
    return keep(setting.value, {read->value}, 1, 1);
  }

  bool integer(const Node& node, Value& value) {
    const auto read = read_plain(node, wanted_for(property_), context_);
    if (!read) return false;
    constexpr double largest = 9007199254740992.0;
    if (std::abs(*read) > largest || *read != std::floor(*read)) {
      context_.report.error(node.place(), "'" + name() + "' wants a whole number, not " + describe(node));
      return false;
    }
    return in_range(property_, *read, node, context_) && keep(value, {*read}, 1, 1);
  }

  bool boolean(const Node& node, Value& value) {
    const auto read = read_bool(node, name(), context_);
    return read && keep(value, {*read ? 1.0 : 0.0}, 1, 1);
  }

  bool vector(const Node& node, Value& value) {
    const auto read = read_triple(node, wanted_for(property_), context_);
    if (!read) return false;
    for (const double component : *read)
      if (!in_range(property_, component, node, context_)) return false;
    return keep(value, {(*read)[0], (*read)[1], (*read)[2]}, 1, 3);
  }

  bool numbers(const Node& node, Value& value) {
    std::vector<double> out;
    bool good = true;
    const auto one = [&](const Node& item) {
      const auto read = read_plain(item, wanted_for(property_), context_);
      good = good && read && in_range(property_, *read, item, context_);
      out.push_back(read.value_or(0.0));
    };
    if (node.is_list()) {
      for (const Node& item : node.items) one(item);
    } else {
      one(node);
    }
    const auto rows = static_cast<uint32_t>(out.size());
    return good && keep(value, std::move(out), rows, 1);
  }

  bool vectors(const Node& node, Value& value) {
    if (!node.is_list()) return wants_list(node, "a list of points, as in [[0, 0, 0], [1, 1, 1]]");
    std::vector<double> out;
    bool good = true;
    for (const Node& item : node.items) {
      const auto read = read_triple(item, wanted_for(property_), context_);
      good = good && read;
      for (const double component : read.value_or(Triple{})) out.push_back(component);
    }
    return good && keep(value, std::move(out), static_cast<uint32_t>(node.items.size()), 3);
  }

  bool text(const Node& node, Value& value) {
    auto word = read_word(node, name(), context_);
    if (!word || !is_choice(*word, node)) return false;
    if (property_.flags & SCREE_FILE) {
      word = find_file(*word, context_.folders.scene, node.place(), context_.folders, context_.report);
      if (!word) return false;
    }
    value.type = property_.type;
    value.texts = {*word};
    return true;
  }

  bool texts(const Node& node, Value& value) {
    value.type = property_.type;
    bool good = true;
    const auto one = [&](const Node& item) {
      const auto word = read_word(item, name(), context_);
      good = good && word && is_choice(*word, item);
      if (word) value.texts.push_back(*word);
    };
    if (node.is_list()) {
      for (const Node& item : node.items) one(item);
    } else {
      one(node);
    }
    return good;
  }

  bool table(const Node& node, Value& value) {
    if (!node.is_list()) return wants_list(node, "a list of records");
    uint32_t width = 0;
    for (uint32_t c = 0; c < property_.column_count; ++c)
      width = std::max(width, property_.columns[c].word + property_.columns[c].words);
    std::vector<double> out;
    bool good = true;
    for (const Node& item : node.items) {
      out.resize(out.size() + width, 0.0);
      good = record(item, out.data() + (out.size() - width)) && good;
    }
    return good && keep(value, std::move(out), static_cast<uint32_t>(node.items.size()), width);
  }

 private:
  std::string name() const { return property_.name; }

  bool keep(Value& value, std::vector<double> numbers, uint32_t rows, uint32_t columns) {
    value.type = property_.type;
    value.numbers = std::move(numbers);
    value.rows = rows;
    value.columns = columns;
    return true;
  }

  bool wants_list(const Node& node, const std::string& what) {
    context_.report.error(node.place(), "'" + name() + "' wants " + what + ", not " + describe(node));
    return false;
  }

  bool is_choice(const std::string& word, const Node& node) {
    const std::vector<std::string> choices = choices_of(property_);
    if (choices.empty() || std::find(choices.begin(), choices.end(), word) != choices.end()) return true;
    context_.report.error(node.place(), "'" + name() + "' cannot be '" + word + "'" + suggestion(word, choices) +
                                            "  (" + list_of(choices) + ")");
    return false;
  }

  bool record(const Node& node, double* row) {
    Mapping mapping(node, "a record of '" + name() + "'", context_);
    bool good = mapping.is_map();
    for (uint32_t c = 0; c < property_.column_count; ++c) {
      const scree_property& column = property_.columns[c];
      const bool required = (column.flags & SCREE_REQUIRED) != 0;
      const Node* cell = required ? mapping.need(column.name) : mapping.take(column.name);
      if (cell) {
        good = cells(column, *cell, row + column.word) && good;
      } else {
        good = good && !required;
        const double missing = (column.flags & SCREE_HAS_FALLBACK) ? column.fallback : 0.0;
        std::fill(row + column.word, row + column.word + column.words, missing);
      }
    }
    mapping.finish();
    return good;
  }

  bool cells(const scree_property& column, const Node& node, double* out) {
    const bool list = node.is_list();
    if (list && node.items.size() != column.words) {
      context_.report.error(node.place(), "'" + std::string(column.name) + "' wants " + std::to_string(column.words) +
                                              (column.words == 1 ? " number" : " numbers") + ", not " +
                                              std::to_string(node.items.size()));
      return false;
    }
    for (uint32_t i = 0; i < column.words; ++i) {
      const Node& item = list ? node.items[i] : node;
      const auto read = read_plain(item, wanted_for(column), context_);
      if (!read || !in_range(column, *read, item, context_)) return false;
      out[i] = *read;
    }
    if (column.words != 2 || out[0] <= out[1]) return true;
    context_.report.error(node.place(), "'" + std::string(column.name) + "' wants the smaller number first");
    return false;
  }

  const scree_property& property_;
  Context& context_;
};

}  // namespace

bool read_value(const scree_property& property, bool varies, const Node& node, Setting& setting, Context& context) {
  ValueReader reader(property, context);
  switch (property.type) {
    case SCREE_NUMBER:
      return reader.number(node, varies, setting);
    case SCREE_INTEGER:
      return reader.integer(node, setting.value);
    case SCREE_BOOLEAN:
      return reader.boolean(node, setting.value);
    case SCREE_VECTOR:
      return reader.vector(node, setting.value);
    case SCREE_TEXT:
      return reader.text(node, setting.value);
    case SCREE_NUMBERS:
      return reader.numbers(node, setting.value);
    case SCREE_VECTORS:
      return reader.vectors(node, setting.value);
    case SCREE_TEXTS:
      return reader.texts(node, setting.value);
    case SCREE_TABLE:
      return reader.table(node, setting.value);
    default:
      context.report.error(node.place(),
                           "'" + std::string(property.name) + "' has a type that this scree does not know");
      return false;
  }
}

}  // namespace scree::core
