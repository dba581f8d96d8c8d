#pragma once
#include <cstdint>
#include <string>

namespace scree::core {

/// A limit of the step and what sets it.
struct StepBound {
  double step = 0;     ///< s, without any safety share; 0: nothing limits the step
  uint64_t ball = 0;   ///< id of the ball that governs, 0: none
  uint64_t other = 0;  ///< id of the ball it meets in the contact that governs, 0: none or a wall
  std::string wall;    ///< the wall it meets, "" when it is a ball or unknown
  std::string term;    ///< "network", "damping", "crowd", "pair", "kinematic" or "possible pair"
  bool open = false;   ///< the limit is larger, and what sets it was not looked for

  /// As in "network of ball 4, contact with ball 9"; "" when nothing limits the step.
  std::string text() const;
};

/// Of two bounds the smaller step; a step of 0 means no limit.
const StepBound& smaller(const StepBound& a, const StepBound& b);

}  // namespace scree::core
