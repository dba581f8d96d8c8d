#include "sizes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sizes {
namespace {

using scree::shortest;

constexpr uint64_t redraws = 1000;  // draws 0 to 999 of a ball belong to its radius

std::string named(const Bin& bin) { return "[" + shortest(bin.diameter[0]) + ", " + shortest(bin.diameter[1]) + "] m"; }

}  // namespace

double Range::draw(const scree::Sink& sink, uint64_t index) const {
  if (law == Law::gaussian) {
    for (uint64_t k = 0; k < redraws; ++k) {
      const double z = b > 0 ? sink.normal(index, k) : 0.0;
      const double radius = a + b * z;
      if (std::abs(z) <= 3 && radius > 0) return radius;
    }
    throw std::runtime_error("no positive radius in 1000 draws of a Gaussian with mean " + shortest(a) +
                             " m and deviation " + shortest(b) + " m: reduce the deviation");
  }
  const double u = sink.uniform(index, 0);
  if (law == Law::uniform || a == b) return a + u * (b - a);
  const double low = 1 / (a * a), high = 1 / (b * b);
  return std::clamp(1 / std::sqrt(low - u * (low - high)), a, b);
}

double Range::mean_cube() const {
  if (law == Law::gaussian) return a * a * a + 3 * a * b * b;
  if (law == Law::uniform_mass) return 2 * a * a * b * b / (a + b);
  return (a + b) * (a * a + b * b) / 4;
}

Grading::Grading(std::vector<Range> ranges, std::vector<double> shares, bool by_mass)
    : ranges_(std::move(ranges)), shares_(std::move(shares)), filled_(ranges_.size(), 0.0), by_mass_(by_mass) {}

double Grading::draw(const scree::Sink& sink, uint64_t index) {
  std::size_t next = 0;
  double least = 0;
  for (std::size_t k = 0; k < ranges_.size(); ++k) {
    const double half = 0.5 * (by_mass_ ? ranges_[k].mean_cube() : 1.0);
    const double lag = (filled_[k] + half) / shares_[k];
    if (k == 0 || lag < least) next = k, least = lag;
  }
  const double radius = ranges_[next].draw(sink, index);
  filled_[next] += by_mass_ ? radius * radius * radius : 1.0;
  return radius;
}

std::vector<Bin> checked(std::vector<Bin> bins) {
  double sum = 0;
  for (const Bin& bin : bins) {
    if (!(bin.diameter[0] > 0) || !(bin.diameter[1] >= bin.diameter[0]))
      throw std::runtime_error("'grading': diameter " + named(bin) + " must run from above 0 upwards");
    if (!(bin.share > 0))
      throw std::runtime_error("'grading': the fraction " + named(bin) + " has share " + shortest(bin.share) +
                               "; leave empty fractions out");
    sum += bin.share;
  }
  if (!(std::abs(sum - 1) <= 1e-6))
    throw std::runtime_error("'grading': the shares sum to " + shortest(sum) + ", not 1");
  std::stable_sort(bins.begin(), bins.end(), [](const Bin& a, const Bin& b) { return a.diameter < b.diameter; });
  for (std::size_t k = 1; k < bins.size(); ++k)
    if (bins[k].diameter[0] < bins[k - 1].diameter[1])
      throw std::runtime_error("'grading': the fractions " + named(bins[k - 1]) + " and " + named(bins[k]) +
                               " overlap");
  return bins;
}

}  // namespace sizes
