#pragma once
#include <scree/abi.h>
#include <scree/plain_math.hpp>

#include <array>
#include <cstdint>
#include <string_view>

namespace scree::core {

/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011): a block of 128 random bits from a counter and a key. [any thread]
std::array<uint32_t, 4> philox(const std::array<uint32_t, 4>& counter, const std::array<uint32_t, 2>& key);

using scree::plain_arctan;
using scree::plain_exp;
using scree::plain_log;

/// The z with P(Z <= z) = p for a standard normal Z, 0 < p < 1: algorithm AS 241, PPND16 (Wichura 1988), about 1e-16
/// relative. [any thread]
double inverse_normal(double p);

/// Random numbers that are a function of (seed, purpose, index, draw), so they depend neither on threads nor on the
/// order of calls. Uniform and normal draws of one (index, draw) are independent of each other. [any thread]
class Random {
 public:
  /// `purpose` names the use, as in "generator/aggregate" or "rule/grains/pb_ten".
  Random(uint64_t seed, std::string_view purpose);
  /// In [0, 1), a multiple of 2^-53.
  double uniform(uint64_t index, uint64_t draw) const;
  /// Mean 0, deviation 1, |z| < 8.3.
  double normal(uint64_t index, uint64_t draw) const;
  /// 64 random bits, those that `uniform` is made from.
  uint64_t bits(uint64_t index, uint64_t draw) const;
  /// As plug-ins see it; valid as long as this object.
  scree_random table() const;

 private:
  std::array<uint32_t, 4> block(uint64_t index, uint64_t draw) const;
  std::array<uint32_t, 2> key_;
};

}  // namespace scree::core
