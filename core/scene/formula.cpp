#include "core/scene/formula.hpp"

#include <muParser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/base/nearest.hpp"

namespace scree::core {
namespace {

constexpr size_t longest_text = 4096;
constexpr int deepest_brackets = 64;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct Word {
  std::string text;
  bool called = false;  ///< a bracket follows
};

/// A look at the text before muParser sees it: it would take assignments, strings and any sign.
class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}

  std::vector<Word> words() {
    if (text_.find_first_not_of(' ') == std::string::npos) refuse("the expression is empty");
    if (text_.size() > longest_text) refuse("the expression is longer than 4096 characters");
    while (at_ < text_.size()) step();
    if (depth_ != 0) refuse("a '(' is not closed");
    return std::move(words_);
  }

 private:
  [[noreturn]] static void refuse(const std::string& why) { throw Refusal(Exit::scene, why); }

  void step() {
    const char c = text_[at_];
    const bool point_number = c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]);
    if (is_digit(c) || point_number) {
      number();
    } else if (is_letter(c)) {
      word();
    } else {
      sign(c);
      ++at_;
    }
  }

  void number() {
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) refuse("a number is out of range");
    at_ = static_cast<size_t>(end - text_.data());
    if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.'))
      refuse("a sign is missing after a number; units stand outside expressions, as in `vars: {a: 25 mm}`");
  }

  void word() {
    const size_t start = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
    Word word{text_.substr(start, at_ - start), false};
    if (word.text.back() == '.' || word.text.find("..") != std::string::npos)
      refuse("'" + word.text + "' is not a name");
    const size_t next = text_.find_first_not_of(' ', at_);
    word.called = next != std::string::npos && text_[next] == '(';
    words_.push_back(std::move(word));
  }

  void sign(char c) {
    static const std::string allowed = " +-*/^(),<>=!&|?:";
    if (allowed.find(c) == std::string::npos) refuse(std::string("'") + c + "' has no meaning in an expression");
    if (c == '(' && ++depth_ > deepest_brackets) refuse("more than 64 nested brackets");
    if (c == ')' && --depth_ < 0) refuse("a ')' without its '('");
    if (c == '=') {
      const char before = at_ > 0 ? text_[at_ - 1] : ' ', after = at_ + 1 < text_.size() ? text_[at_ + 1] : ' ';
      if (after != '=' && std::string("=<>!").find(before) == std::string::npos)
        refuse("'=' assigns nothing here: write == to compare");
    }
  }

  const std::string& text_;
  size_t at_ = 0;
  int depth_ = 0;
  std::vector<Word> words_;
};

void add_once(std::vector<std::string>& list, const std::string& text) {
  if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

std::string lower_first(std::string text) {
  if (!text.empty() && text[0] >= 'A' && text[0] <= 'Z') text[0] = static_cast<char>(text[0] - 'A' + 'a');
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

}  // namespace

struct Formula::Impl {
  mu::Parser parser;
  std::vector<double> values;
};

const std::vector<std::string>& Formula::functions() {
  static const std::vector<std::string> names = {
      "sin",  "cos",   "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
      "log2", "log10", "ln",  "exp",  "sqrt", "sign", "rint",  "abs",  "sum",  "avg",  "min",   "max"};
  return names;
}

Formula::Formula(const std::string& text, const std::map<std::string, double>& constants, Place place)
    : text_(text), place_(std::move(place)), impl_(std::make_unique<Impl>()) {
  const std::vector<std::string>& known = functions();
  mu::Parser& parser = impl_->parser;
  parser.ClearConst();
  parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  try {
    for (const Word& word : Scanner(text).words()) {
      if (word.called) {
        if (std::find(known.begin(), known.end(), word.text) != known.end()) continue;
        const std::string near = nearest_name(word.text, known);
        throw Refusal(Exit::scene,
                      "unknown function '" + word.text + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
      }
      if (std::find(known.begin(), known.end(), word.text) != known.end())
        throw Refusal(Exit::scene, "'" + word.text + "' is a function: write " + word.text + "(...)");
      const auto constant = constants.find(word.text);
      if (constant != constants.end()) {
        if (std::find(constants_.begin(), constants_.end(), word.text) != constants_.end()) continue;
        parser.DefineConst(word.text, constant->second);
        constants_.push_back(word.text);
      } else if (word.text != "pi") {
        add_once(names_, word.text);
      }
    }
    if (!constants.contains("pi")) parser.DefineConst("pi", std::numbers::pi);
    impl_->values.assign(names_.size(), 0.0);
    for (size_t i = 0; i < names_.size(); ++i) parser.DefineVar(names_[i], &impl_->values[i]);
    parser.SetExpr(text_);
    parser.Eval();  // compiles
    if (parser.GetNumResults() != 1)
      throw Refusal(Exit::scene, "more than one expression; a ',' belongs in a function");
  } catch (const mu::ParserError& error) {
    throw Refusal(Exit::scene, lower_first(error.GetMsg()));
  }
}

Formula::~Formula() = default;

bool Formula::uses(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

double Formula::evaluate(std::span<const double> values) const {
  if (values.size() != names_.size())
    throw Refusal(Exit::internal, "expression '" + text_ + "' wants " + std::to_string(names_.size()) + " values");
  std::copy(values.begin(), values.end(), impl_->values.begin());
  return impl_->parser.Eval();
}

}  // namespace scree::core
