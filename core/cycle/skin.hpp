#pragma once
#include <cstdint>

namespace scree::core {

/// How much further than touching the lists reach, m. Wider in scenes that use it up quickly: lists are longer then,
/// but made less often. Follows from the motion alone.
class Skin {
 public:
  struct Sizes {
    double mean = 0, least = 0;  ///< radii, m
    double room = 0;             ///< m, that periodic edges leave at most
  };
  /// `wanted`, m: the user's own, which stays; 0: chosen from the sizes.
  void begin(double wanted, const Sizes& sizes);
  /// The lists are about to be made anew because balls and walls have moved.
  void used_up(uint64_t cycle);
  /// They are made, for whatever reason.
  void renewed(uint64_t cycle) { since_ = cycle; }
  double width() const { return width_; }
  /// The width it begins with.
  double narrow() const { return narrow_; }
  /// The widest it would get by itself, m: estimates of the step look no further, as what they count as touching
  /// shortens it.
  double far() const { return far_; }

  /// For checkpoints.
  struct State {
    double width = 0, narrow = 0, wide = 0, far = 0;
    uint64_t since = 0;
  };
  State state() const { return {width_, narrow_, wide_, far_, since_}; }
  void restore(const State& state);

 private:
  double width_ = 0, narrow_ = 0, wide_ = 0, far_ = 0;
  uint64_t since_ = 0;  ///< cycle of the lists of now
};

}  // namespace scree::core
