#include "core/base/philox.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <limits>

#include "core/base/hash.hpp"

namespace scree::core {

namespace {

uint32_t low_word(uint64_t x) { return static_cast<uint32_t>(x); }
uint32_t high_word(uint64_t x) { return static_cast<uint32_t>(x >> 32); }

template <size_t N>
double polynomial(const double (&c)[N], double x) {
  double sum = c[N - 1];
  for (size_t k = N - 1; k-- > 0;) sum = sum * x + c[k];
  return sum;
}

// Coefficients of AS 241 (PPND16), lowest power first: centre |p - 1/2| <= 0.425, then r = sqrt(-log(tail)) up to 5,
// then above.
constexpr double centre_top[] = {3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                                 1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                                 3.3430575583588128105e+4, 2.5090809287301226727e+3};
constexpr double centre_bottom[] = {1.0,
                                    4.2313330701600911252e+1,
                                    6.8718700749205790830e+2,
                                    5.3941960214247511077e+3,
                                    2.1213794301586595867e+4,
                                    3.9307895800092710610e+4,
                                    2.8729085735721942674e+4,
                                    5.2264952788528545610e+3};
constexpr double middle_top[] = {1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                                 3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                                 2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr double middle_bottom[] = {1.0,
                                    2.05319162663775882187e0,
                                    1.67638483018380384940e0,
                                    6.89767334985100004550e-1,
                                    1.48103976427480074590e-1,
                                    1.51986665636164571966e-2,
                                    5.47593808499534494600e-4,
                                    1.05075007164441684324e-9};
constexpr double far_top[] = {6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                              2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                              2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr double far_bottom[] = {1.0,
                                 5.99832206555887937690e-1,
                                 1.36929880922735805310e-1,
                                 1.48753612908506148525e-2,
                                 7.86869131145613259100e-4,
                                 1.84631831751005468180e-5,
                                 1.42151175831644588870e-7,
                                 2.04426310338993978564e-15};

}  // namespace

std::array<uint32_t, 4> philox(const std::array<uint32_t, 4>& counter, const std::array<uint32_t, 2>& key) {
  const r123::Philox4x32::ctr_type c = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type k = {{key[0], key[1]}};
  const auto r = r123::Philox4x32()(c, k);
  return {r[0], r[1], r[2], r[3]};
}

double inverse_normal(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(centre_top, r) / polynomial(centre_bottom, r);
  }
  const double r = std::sqrt(-plain_log(q < 0 ? p : 1.0 - p));
  const double z = r <= 5.0 ? polynomial(middle_top, r - 1.6) / polynomial(middle_bottom, r - 1.6)
                            : polynomial(far_top, r - 5.0) / polynomial(far_bottom, r - 5.0);
  return q < 0 ? -z : z;
}

Random::Random(uint64_t seed, std::string_view purpose) {
  Hasher hasher;
  hasher.add(seed);
  hasher.add(purpose);
  key_ = {low_word(hasher.value()), high_word(hasher.value())};
}

std::array<uint32_t, 4> Random::block(uint64_t index, uint64_t draw) const {
  return philox({low_word(index), high_word(index), low_word(draw), high_word(draw)}, key_);
}

uint64_t Random::bits(uint64_t index, uint64_t draw) const {
  const auto b = block(index, draw);
  return (uint64_t{b[1]} << 32) | b[0];
}

double Random::uniform(uint64_t index, uint64_t draw) const {
  return static_cast<double>(bits(index, draw) >> 11) * 0x1p-53;
}

double Random::normal(uint64_t index, uint64_t draw) const {
  // The other half of the block. 52 bits and a half step: exact, symmetric about 1/2, never 0 or 1.
  const auto b = block(index, draw);
  const uint64_t word = (uint64_t{b[3]} << 32) | b[2];
  return inverse_normal((static_cast<double>(word >> 12) + 0.5) * 0x1p-52);
}

scree_random Random::table() const {
  scree_random t{};
  t.struct_size = sizeof t;
  t.self = const_cast<Random*>(this);
  t.uniform = [](void* self, uint64_t index, uint64_t draw) {
    return static_cast<const Random*>(self)->uniform(index, draw);
  };
  t.normal = [](void* self, uint64_t index, uint64_t draw) {
    return static_cast<const Random*>(self)->normal(index, draw);
  };
  return t;
}

}  // namespace scree::core
