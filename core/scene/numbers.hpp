#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/context.hpp"

namespace scree::core {

/// What a key wants where a number stands.
struct Wanted {
  std::string name;        ///< of the key, for messages
  std::string unit = "1";  ///< SI; "" takes any unit and gives its SI value
  bool infinity = false;   ///< .inf is allowed
  bool position = false;   ///< an expression of x, y, z is allowed
};

struct Number {
  double value = 0;
  std::shared_ptr<Formula> formula;  ///< set when it depends on position; `value` then means nothing
  std::string unit;                  ///< as written, "" if none
};

/// A number as written: `25 mm`, `60 %`, `1e-5`, a var, arithmetic of vars, a quoted expression. Errors are reported.
std::optional<Number> read_number(const Node& node, const Wanted& wanted, Context& context);
/// The same without position.
std::optional<double> read_plain(const Node& node, const Wanted& wanted, Context& context);
std::optional<Triple> read_triple(const Node& node, const Wanted& wanted, Context& context);

/// A whole number from 0 to 2^53, also written `200000 cycles` where `cycles` is true.
std::optional<uint64_t> read_count(const Node& node, const std::string& name, bool cycles, Context& context);

/// `0.1 ms` or `200 cycles`; a plain number is in seconds.
std::optional<Span> read_span(const Node& node, const std::string& name, bool zero_allowed, Context& context);

std::optional<bool> read_bool(const Node& node, const std::string& name, Context& context);
std::optional<std::string> read_word(const Node& node, const std::string& name, Context& context);
/// A list of words, or one word.
std::vector<Name> read_words(const Node& node, const std::string& name, Context& context);

/// An expression over named quantities; any names. `vars` are folded in. Null when it is wrong (reported).
std::shared_ptr<Formula> read_formula(const std::string& text, const Place& place, const std::string& name,
                                      Context& context);

/// "; did you mean 'x'?" or "".
std::string suggestion(const std::string& text, const std::vector<std::string>& candidates);
std::string list_of(const std::vector<std::string>& names);
/// The shortest text that reads back to the same double.
std::string number_text(double value);

}  // namespace scree::core
