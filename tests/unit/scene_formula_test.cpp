#include <array>
#include <cmath>
#include <numbers>

#include "core/scene/formula.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

std::string refusal(const std::string& text) {
  try {
    const Formula formula(text, {{"a", 2.0}}, {});
  } catch (const Refusal& error) {
    REQUIRE(error.code() == Exit::scene);
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a formula folds vars in and leaves dotted names as variables in the order of the text") {
  const Formula formula("(walls.top.force.z - walls.bottom.force.z) / (2*a^2) + walls.top.force.z", {{"a", 3.0}}, {});
  REQUIRE(formula.names() == std::vector<std::string>{"walls.top.force.z", "walls.bottom.force.z"});
  REQUIRE(formula.constants() == std::vector<std::string>{"a"});
  REQUIRE(formula.uses("walls.top.force.z"));
  REQUIRE_FALSE(formula.uses("a"));
  const std::array<double, 2> values{36.0, 18.0};
  REQUIRE(formula.evaluate(values) == 37.0);  // (36 - 18)/18 + 36
}

TEST_CASE("a formula knows pi, functions, comparisons and choices") {
  const Formula half_turn("cos(pi)", {}, {});
  REQUIRE(half_turn.evaluate({}) == std::cos(std::numbers::pi));
  const Formula choice("z > 0.1 && z <= 0.2 ? 1 : 0", {}, {});
  REQUIRE(choice.evaluate(std::array<double, 1>{0.15}) == 1.0);
  REQUIRE(choice.evaluate(std::array<double, 1>{0.25}) == 0.0);
  const Formula mixed("max(1e-3, .5, min(4, 2)) - 1.5E0", {}, {});
  REQUIRE(mixed.evaluate({}) == 0.5);
}

TEST_CASE("a formula refuses what it could misread") {
  REQUIRE(refusal("x = 3") == "'=' assigns nothing here: write == to compare");
  REQUIRE(refusal("a == 2") == "accepted");
  REQUIRE(refusal("sni(a)") == "unknown function 'sni'; did you mean 'sin'?");
  REQUIRE(refusal("sin") == "'sin' is a function: write sin(...)");
  REQUIRE(refusal("") == "the expression is empty");
  REQUIRE(refusal("(a") == "a '(' is not closed");
  REQUIRE(refusal("a)") == "a ')' without its '('");
  REQUIRE(refusal("\"text\"") == "'\"' has no meaning in an expression");
  REQUIRE(refusal("3a") ==
          "a sign is missing after a number; units stand outside expressions, as in `vars: {a: 25 mm}`");
  REQUIRE(refusal("1e999") == "a number is out of range");
  REQUIRE(refusal("a..b") == "'a..b' is not a name");
  REQUIRE(refusal("1, 2") == "more than one expression; a ',' belongs in a function");
  REQUIRE(refusal("a +").find("unexpected end") != std::string::npos);
  REQUIRE(refusal(std::string(5000, '1')) == "the expression is longer than 4096 characters");
  REQUIRE(refusal(std::string(100, '(') + "1" + std::string(100, ')')) == "more than 64 nested brackets");
}
