#pragma once
/// Functions of one number by plain arithmetic: the same bits with every C library and compiler, where those of the
/// library differ in the last digits. For what a law computes once, in `prepare`; a law itself needs none of them.
#include <cmath>
#include <limits>

namespace scree {

/// Natural logarithm of a positive, finite, normal number by plain arithmetic: the same bits with every C library, and
/// within 1e-15 of the true value. Not for zero, negative, subnormal or infinite x. [any thread]
inline double plain_log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // exact, m in [1/2, 1)
  if (m < 0.70710678118654752440) {
    m = m + m;
    --exponent;
  }
  // log m = 2 atanh(f), f = (m-1)/(m+1), |f| <= 0.1716: the first term left out is below 2e-18 of the sum. m - 1 is
  // exact, and its leading term is kept apart: 2f = (m-1) - f (m-1), which has no rounding of its own size.
  const double d = m - 1.0;
  const double f = d / (m + 1.0);
  const double f2 = f * f;
  double tail = 0;
  for (int k = 25; k >= 3; k -= 2) tail = tail * f2 + 2.0 / k;
  const double e = exponent;
  // ln 2 in two parts; the first has 21 trailing zero bits, so its product with an exponent is exact.
  const double high = 6.93147180369123816490e-01, low = 1.90821492927058770002e-10;
  return e * high + (d - f * (d - f2 * tail) + e * low);
}

/// e to the x by plain arithmetic: the same bits with every C library, and within 1e-15 of the true value relative.
/// 0 below -708, infinite above 709. [any thread]
inline double plain_exp(double x) {
  if (x < -708) return 0;
  if (x > 709) return std::numeric_limits<double>::infinity();
  // x = n ln 2 + r, |r| < 0.347: the first term left out is below 5e-18 of the sum.
  const double n = std::floor(x * 1.44269504088896340736 + 0.5);
  const double high = 6.93147180369123816490e-01, low = 1.90821492927058770002e-10;
  const double r = (x - n * high) - n * low;
  double sum = 1;
  for (int k = 13; k >= 1; --k) sum = 1 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(n));
}

/// The angle in [0, pi/2] whose tangent is x >= 0 (infinite: pi/2), by plain arithmetic, within 1e-15 relative. [any
/// thread]
inline double plain_arctan(double x) {
  constexpr double quarter = 1.57079632679489661923;  // pi/2
  if (x > 1) return quarter - plain_arctan(1 / x);
  // Three halvings of the angle leave a tangent below 0.0985; the first term left out is below 1e-18 of the sum.
  double t = x;
  for (int halving = 0; halving < 3; ++halving) t = t / (1 + std::sqrt(1 + t * t));
  const double square = t * t;
  double sum = 0;
  for (int k = 15; k >= 1; k -= 2) sum = 1.0 / k - square * sum;
  return 8 * t * sum;
}

}  // namespace scree
