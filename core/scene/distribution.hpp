#pragma once
#include <limits>
#include <string>

#include "core/base/philox.hpp"

namespace scree::core {

/// A law of chance that stands for a number, in SI units: its name and two parameters.
class Distribution {
 public:
  enum class Law { normal, uniform, weibull };
  /// normal: mean, standard deviation >= 0. uniform: low <= high. weibull: shape > 0, scale > 0, with
  /// P(X > x) = exp(-(x/scale)^shape).
  Distribution(Law law, double first, double second) : law_(law), first_(first), second_(second) {}

  Law law() const { return law_; }
  double first() const { return first_; }
  double second() const { return second_; }
  double low() const { return low_; }
  double high() const { return high_; }
  /// From now on no value below `low` or above `high`; only ever cuts more off.
  void cut(double low, double high);

  /// The value of one index, a function of (random, index) with the same bits on every machine: what falls outside the
  /// cut is drawn again. [any thread]
  double draw(const Random& random, uint64_t index) const;
  /// No draw is larger.
  double largest() const;
  /// Share of the law that the cut keeps, in [0, 1].
  double kept() const;

  struct Moments {
    double mean = 0, sd = 0;
  };
  /// Of what is drawn, the cut included; to about four digits.
  Moments moments() const;
  /// For people: "normal, mean 3e+07 Pa, sd 9e+06 Pa", with the cut and what it does to the moments.
  std::string text(const std::string& unit) const;

 private:
  double below(double x) const;
  double quantile(double p) const;
  Law law_;
  double first_, second_;
  double low_ = -std::numeric_limits<double>::infinity(), high_ = std::numeric_limits<double>::infinity();
};

}  // namespace scree::core
