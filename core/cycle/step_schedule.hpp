#pragma once
#include <cstdint>

#include "core/contact/network_bound.hpp"

namespace scree::core {

/// When the step is estimated, over which contacts and with how much effort. An estimate covers all pairs that touch or
/// whose gap is below a margin, and holds until pieces may have come nearer by that margin: nothing that was left out
/// can touch before. Depends on motion and cycles alone.
class StepSchedule {
 public:
  /// What the plan looks at.
  struct Motion {
    double closing = 0;    ///< m, by which pieces may approach in the coming cycle
    double skin_left = 0;  ///< m, that an estimate may look ahead: at most to where lists are rebuilt
    double radius = 0;     ///< m, least
  };
  /// Margin and sweeps of the estimate at this cycle, which is taken as made.
  NetworkQuery plan(uint64_t cycle, const Motion& motion);
  /// The scene has changed for good, and the next estimate is worth the effort of the first.
  void begin_anew() { made_ = 0; }
  /// Balls and walls have moved by at most this, m.
  void moved(double balls, double walls);
  bool due(uint64_t cycle) const { return closed() > margin_ || cycle - last_ >= longest; }

  /// For checkpoints.
  struct State {
    double margin = 0, balls = 0, walls = 0;
    uint64_t last = 0;
    uint64_t made = 0;  ///< 0: no estimate yet; else one more than the sweeps of the last
  };
  State state() const { return {margin_, balls_, walls_, last_, made_}; }
  void restore(const State& state);

 private:
  double closed() const;
  static constexpr uint64_t longest = 2000;  ///< cycles between estimates, at most, so that the step can rise
  double margin_ = 0, balls_ = 0, walls_ = 0;
  uint64_t last_ = 0;
  uint64_t made_ = 0;
};

}  // namespace scree::core
