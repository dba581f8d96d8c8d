#pragma once
// Radii drawn at random: uniform, Gaussian or by a sieve grading.
#include <scree/generator.hpp>

#include <array>
#include <string>
#include <vector>

namespace sizes {

/// One fraction of a grading: its diameters and its share.
struct Bin {
  std::array<double, 2> diameter{};
  double share = 0;
};

enum class Law {
  uniform,       // every diameter between the ends as likely by number
  uniform_mass,  // every diameter between the ends with the same mass: density of number ~ d^-3
  gaussian       // mean and deviation, cut at three deviations and at zero
};

/// Sizes between `a` and `b` (uniform) or with mean `a` and deviation `b` (Gaussian), as radii, m.
struct Range {
  Law law = Law::uniform;
  double a = 0, b = 0;

  double draw(const scree::Sink& sink, uint64_t index) const;
  double mean_cube() const;  // expected radius^3, m3; the Gaussian's before it is cut
};

/// Shares that are counted by number or by mass. The next ball goes to the fraction that lags most behind its share
/// (Webster's rule), so the shares are met as closely as whole balls allow.
class Grading {
 public:
  Grading(std::vector<Range> ranges, std::vector<double> shares, bool by_mass);
  double draw(const scree::Sink& sink, uint64_t index);

 private:
  std::vector<Range> ranges_;
  std::vector<double> shares_, filled_;
  bool by_mass_;
};

/// Checks a grading and sorts it by size. Throws on bins that overlap or hold nothing, and on shares that do not sum
/// to 1.
std::vector<Bin> checked(std::vector<Bin> bins);

}  // namespace sizes
