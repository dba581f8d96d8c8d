#pragma once
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace scree::core {

/// An arithmetic expression, compiled once. Names may hold dots (`walls.top.force.z`), so every quantity is a variable.
/// Scene `vars` are folded in as constants, and `pi`. Independent of the locale. [one thread]
class Formula {
 public:
  /// Throws Refusal(Exit::scene) whose text is the reason without a place.
  Formula(const std::string& text, const std::map<std::string, double>& constants, Place place);
  ~Formula();
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;

  const std::string& text() const { return text_; }
  const Place& place() const { return place_; }
  /// The variables it uses, each once, in the order `evaluate` wants their values: that of the text.
  const std::vector<std::string>& names() const { return names_; }
  /// The constants it uses (`pi` left out).
  const std::vector<std::string>& constants() const { return constants_; }
  bool uses(const std::string& name) const;
  double evaluate(std::span<const double> values) const;

  /// Functions an expression may call, for messages and for refusing vars of such a name.
  static const std::vector<std::string>& functions();

 private:
  struct Impl;
  std::string text_;
  Place place_;
  std::vector<std::string> names_, constants_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree::core
