#include <scree/generator.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sizes.hpp"

namespace {

using namespace scree;

constexpr uint64_t first_place_draw = 1000;  // those before belong to the radius

double volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

/// Random sequential placement without overlap, larger balls first.
struct Random {
  std::array<Vec3, 2> box{};
  std::vector<double> radius;
  std::string distribution = "uniform";
  std::vector<sizes::Bin> grading;
  std::string by = "mass";
  std::optional<uint64_t> count;
  std::optional<double> porosity;
  uint64_t tries = 20000;
  double shrink = 1;

  static void describe(Settings<Random>& settings) {
    settings.box("box", &Random::box, "m", "lower and upper corner; every ball lies wholly inside").required();
    settings.numbers("radius", &Random::radius, "m", "[lowest, highest], or [mean, deviation] of a Gaussian")
        .at_least(0);
    settings.text("distribution", &Random::distribution, "of `radius`").choices("uniform gaussian");
    settings.table(
        "grading", &Random::grading, "sieve fractions, instead of `radius`", [](Columns<sizes::Bin>& columns) {
          columns.interval("diameter", &sizes::Bin::diameter, "m", "smallest and largest diameter").above(0).required();
          columns.number("share", &sizes::Bin::share, "1", "share of this fraction; all sum to 1")
              .above(0)
              .at_most(1)
              .required();
        });
    settings.text("by", &Random::by, "what the shares of `grading` count").choices("mass number");
    settings.integer("count", &Random::count, "1", "number of balls").at_least(0).at_most(1e9);
    settings.number("porosity", &Random::porosity, "1", "of the box, at the full radii").above(0).below(1);
    settings.integer("tries", &Random::tries, "1", "places tried for one ball before giving up").at_least(1);
    settings.number("shrink", &Random::shrink, "1", "balls are placed at this share of their radius")
        .above(0)
        .at_most(1);
  }

  void check() {
    if (radius.empty() == grading.empty())
      throw std::runtime_error("give either 'radius: [lowest, highest]' or 'grading', and not both");
    if (count.has_value() == porosity.has_value())
      throw std::runtime_error("give either 'count' or 'porosity', and not both");
    if (!grading.empty()) {
      grading = sizes::checked(std::move(grading));
      return;
    }
    if (radius.size() > 2) throw std::runtime_error("'radius' wants one or two numbers");
    if (!(radius[0] > 0)) throw std::runtime_error("'radius' must be above 0");
    if (radius.size() == 2 && distribution == "uniform" && radius[1] < radius[0])
      throw std::runtime_error("'radius' must name the lower end first");
  }

  sizes::Grading make_sizes() const {
    std::vector<sizes::Range> ranges;
    std::vector<double> shares;
    const bool by_mass = by == "mass";
    for (const sizes::Bin& bin : grading) {
      const auto law = by_mass ? sizes::Law::uniform_mass : sizes::Law::uniform;
      ranges.push_back({law, bin.diameter[0] / 2, bin.diameter[1] / 2});
      shares.push_back(bin.share);
    }
    if (ranges.empty()) {
      const bool gaussian = distribution == "gaussian";
      const double second = radius.size() == 2 ? radius[1] : (gaussian ? 0.0 : radius[0]);
      ranges.push_back({gaussian ? sizes::Law::gaussian : sizes::Law::uniform, radius[0], second});
      shares.push_back(1);
      return {std::move(ranges), std::move(shares), false};
    }
    return {std::move(ranges), std::move(shares), by_mass};
  }

  double box_volume() const {
    const Vec3 edge = box[1] - box[0];
    return edge.x * edge.y * edge.z;
  }

  /// The radii asked for, in the order of their draws; the porosity is met to within half of the last ball.
  std::vector<double> draw_radii(const Sink& sink) const {
    sizes::Grading source = make_sizes();
    std::vector<double> radii;
    if (count) {
      for (uint64_t k = 0; k < *count; ++k) radii.push_back(source.draw(sink, k));
      return radii;
    }
    const double wanted = (1 - *porosity) * box_volume();
    for (double solid = 0; solid < wanted;) {
      const double next = source.draw(sink, radii.size());
      if (solid + volume(next) / 2 > wanted) break;
      solid += volume(next);
      radii.push_back(next);
      if (radii.size() == 1000 && wanted > 1e6 * solid)
        throw std::runtime_error("this porosity needs more than 1e9 balls: enlarge the radii or reduce 'box'");
    }
    return radii;
  }

  void generate(Sink& sink) const {
    const std::vector<double> radii = draw_radii(sink);
    std::vector<std::size_t> order(radii.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
    double solid = 0;
    for (std::size_t placed = 0; placed < order.size(); ++placed) {
      const std::size_t index = order[placed];
      const double size = radii[index] * shrink;
      if (!place(sink, index, size)) refuse(radii, placed, size, solid);
      solid += volume(size);
    }
  }

  bool place(const Sink& sink, uint64_t index, double size) const {
    Vec3 low = box[0], high = box[1];
    const auto cell = sink.cell();
    for (std::size_t k = 0; k < 3; ++k) {
      // Where the box spans a periodic axis there is no face to keep away from.
      if (cell && cell->periodic[k] && low[k] <= cell->low[k] && high[k] >= cell->high[k]) continue;
      low[k] += size;
      high[k] -= size;
      if (low[k] > high[k]) return false;
    }
    for (uint64_t t = 0; t < tries; ++t) {
      Ball ball{.position = low, .radius = size};
      for (std::size_t k = 0; k < 3; ++k)
        ball.position[k] += sink.uniform(index, first_place_draw + 3 * t + k) * (high[k] - low[k]);
      if (sink.try_ball(ball)) return true;
    }
    return false;
  }

  [[noreturn]] void refuse(const std::vector<double>& radii, std::size_t placed, double size, double solid) const {
    double asked = 0;
    for (const double r : radii) asked += volume(r * shrink);
    std::string why = "placed " + std::to_string(placed) + " of " + std::to_string(radii.size()) +
                      " balls (largest first) in a box of " + shortest(box_volume()) + " m3: porosity " +
                      rounded(1 - solid / box_volume()) + " reached, " + rounded(1 - asked / box_volume()) + " asked";
    const Vec3 edge = box[1] - box[0];
    if (2 * size > min(edge.x, min(edge.y, edge.z)))
      throw std::runtime_error(why + "; a ball of radius " + shortest(size) +
                               " m is larger than the box: enlarge 'box'");
    throw std::runtime_error(
        why + "; a ball of radius " + shortest(size) + " m found no place in " + std::to_string(tries) +
        " tries. Ask for fewer balls or a higher porosity (placement without overlap ends near 0.65), "
        "enlarge 'box', place them smaller with 'shrink', or raise 'tries'");
  }

  /// Three decimals are enough for a message.
  static std::string rounded(double value) { return shortest(std::round(value * 1000) / 1000); }
};

}  // namespace

SCREE_PLUGIN(scree::generator<Random>("random", "1.0.0", "random placement without overlap"))
