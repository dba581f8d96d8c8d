#pragma once
#include <cstdint>
#include <optional>

#include "core/contact/step_bound.hpp"

namespace scree::core {

/// Chooses the step: a share of the stable bound, rounded down to six significant bits so that it scales exactly by
/// powers of two. It drops at once and rises when the bound has allowed more for long, so it is piecewise constant.
class StepControl {
 public:
  static constexpr double safety = 0.95;     ///< of the certified limit
  static constexpr double rise = 1.1;        ///< how much more the bound must allow
  static constexpr uint64_t patience = 500;  ///< cycles for which it must

  std::optional<double> fixed;  ///< the user's own step, s
  bool accurate = false;        ///< collisions get a tenth of a pair's limit, in dense scenes too
  /// A new bound was computed at this cycle. One that is open lets the step be, and is not kept.
  void take(const StepBound& bound, uint64_t cycle);
  /// The least bound that lets the step rise in time, s; 0: the next one has to be known, as the step may rise now.
  double enough(uint64_t cycle) const {
    const bool now = step_ == 0 || (since_ != never && cycle - since_ >= patience);
    return now ? 0 : 1.05 * rise / safety * step_;  // rounding to six bits takes at most a thirty-third
  }
  /// The least bound that the step of now follows from, s.
  double holding() const { return step_ / safety * (1 + 1e-12); }
  double step() const { return fixed ? *fixed : step_; }
  bool automatic() const { return !fixed; }
  const StepBound& bound() const { return bound_; }
  /// Largest step that the safety share allows, s; 0: no limit known.
  double allowed() const { return safety * bound_.step; }

  /// For checkpoints: step, since when more was allowed, and the bound that is reported.
  double saved_step() const { return step_; }
  uint64_t saved_since() const { return since_; }
  void restore(const StepBound& bound, double step, uint64_t since) {
    bound_ = bound;
    step_ = step;
    since_ = since;
  }
  static double six_bits(double value);

 private:
  StepBound bound_;
  double step_ = 0;
  uint64_t since_ = never;  ///< cycle from which more was allowed without break
  static constexpr uint64_t never = ~uint64_t{0};
};

}  // namespace scree::core
