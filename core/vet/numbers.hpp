#pragma once
#include <scree/math.hpp>

#include <cmath>
#include <cstdint>

namespace scree::core::vet {

/// SplitMix64 (Steele, Lea and Flood 2014): the same cases on every machine, so that a failure can be seen again.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : state_(seed) {}
  uint64_t bits() {
    uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1.0p-53);
  }
  /// Even in the logarithm; both ends above 0.
  double spread(double low, double high) { return low * std::exp(between(0, std::log(high / low))); }
  uint64_t below(uint64_t count) { return bits() % count; }
  bool chance(double share) { return between(0, 1) < share; }
  Vec3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = vector(1);
      if (v.squaredNorm() < 1 && v.squaredNorm() > 0.01) return v.normalized();
    }
  }

 private:
  uint64_t state_;
};

}  // namespace scree::core::vet
