#include "core/scene/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "support/catch.hpp"
#include "unit/scene_fakes.hpp"

using namespace scree::core;
using Law = Distribution::Law;

namespace {

constexpr std::size_t count = 20000;

std::vector<double> draws(const Distribution& distribution) {
  const Random random(11, "rule/test/fric");
  std::vector<double> values;
  for (uint64_t k = 0; k < count; ++k) values.push_back(distribution.draw(random, k * 0x9e3779b97f4a7c15u));
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
  const double m = mean(values);
  double sum = 0;
  for (const double x : values) sum += (x - m) * (x - m);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// Largest distance of the empirical distribution from `below` (Kolmogorov-Smirnov), times the root of the count.
double distance(std::vector<double> values, const std::function<double(double)>& below) {
  std::sort(values.begin(), values.end());
  double worst = 0;
  const auto n = static_cast<double>(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double p = below(values[k]);
    worst = std::max({worst, std::abs(p - static_cast<double>(k) / n), std::abs(p - static_cast<double>(k + 1) / n)});
  }
  return worst * std::sqrt(n);
}

double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

std::string scene(const std::string& rule, const std::string& contact = "") {
  return "scree: 1\nwalls: {floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}}\nballs:\n  sand: {generator: "
         "random, box: [[0, 0, 0], [1, 1, 1]], radius: 1 cm, count: 5, density: 2600" +
         contact + "}\ncontacts:\n  - {name: all, between: [sand, [sand, floor]], model: linear" + rule + "}\n";
}

const Distribution& drawn_in(const Scene& scene, const std::string& name) {
  for (const Setting& setting : scene.contacts.at(0).model.settings)
    if (setting.name == name) return *setting.drawn;
  throw std::out_of_range(name);
}

/// 0.1 % of fair samples lie further away (Kolmogorov 1933).
constexpr double far_away = 1.95;

}  // namespace

TEST_CASE("a normal draw has the distribution that was asked for") {
  const Distribution normal(Law::normal, 30e6, 9e6);
  const auto values = draws(normal);
  CHECK(std::abs(mean(values) - 30e6) < 4 * 9e6 / std::sqrt(count));
  CHECK(std::abs(deviation(values) - 9e6) < 4 * 9e6 / std::sqrt(2.0 * count));
  CHECK(distance(values, [](double x) { return normal_below((x - 30e6) / 9e6); }) < far_away);
  CHECK(normal.kept() == 1);
}

TEST_CASE("a cut normal draw has the moments of the cut distribution") {
  // Closed form for the part above 0 of mean m, sd s with a = -m/s: mean m + s h, variance s^2 (1 + a h - h^2),
  // h = phi(a)/(1 - Phi(a)).
  const double m = 0.2, s = 1, a = -m / s;
  const double h = std::exp(-0.5 * a * a) / std::sqrt(2 * 3.14159265358979323846) / (1 - normal_below(a));
  Distribution normal(Law::normal, m, s);
  normal.cut(0, INFINITY);
  const auto values = draws(normal);
  const double expected = m + s * h, sd = s * std::sqrt(1 + a * h - h * h);
  CHECK(*std::min_element(values.begin(), values.end()) >= 0);
  CHECK(std::abs(mean(values) - expected) < 4 * sd / std::sqrt(count));
  CHECK(std::abs(deviation(values) - sd) < 4 * sd / std::sqrt(count));
  CHECK(distance(values, [&](double x) { return 1 - (1 - normal_below(x - m)) / (1 - normal_below(a)); }) < far_away);
  CHECK(normal.kept() == Approx(1 - normal_below(a)).epsilon(1e-12));
  CHECK(normal.moments().mean == Approx(expected).epsilon(1e-4));
  CHECK(normal.moments().sd == Approx(sd).epsilon(1e-3));
  normal.cut(-5, 0.75);
  const auto narrow = draws(normal);
  CHECK(*std::min_element(narrow.begin(), narrow.end()) >= 0);
  CHECK(*std::max_element(narrow.begin(), narrow.end()) <= 0.75);
  CHECK(normal.largest() == 0.75);
}

TEST_CASE("a uniform draw and a Weibull draw have the distribution that was asked for") {
  const Distribution uniform(Law::uniform, 0.2, 0.5);
  const auto even = draws(uniform);
  CHECK(std::abs(mean(even) - 0.35) < 4 * 0.3 / std::sqrt(12.0 * count));
  CHECK(distance(even, [](double x) { return (x - 0.2) / 0.3; }) < far_away);
  for (const double shape : {0.8, 3.0, 12.0}) {
    const Distribution weibull(Law::weibull, shape, 5e6);
    const auto values = draws(weibull);
    const double first = 5e6 * std::tgamma(1 + 1 / shape), second = 25e12 * std::tgamma(1 + 2 / shape);
    const double sd = std::sqrt(second - first * first);
    INFO("shape " << shape);
    CHECK(std::abs(mean(values) - first) < 4 * sd / std::sqrt(count));
    CHECK(distance(values, [&](double x) { return 1 - std::exp(-std::pow(x / 5e6, shape)); }) < far_away);
    CHECK(weibull.moments().mean == Approx(first).epsilon(1e-3));
    CHECK(weibull.moments().sd == Approx(sd).epsilon(1e-2));
    CHECK(*std::max_element(values.begin(), values.end()) < weibull.largest());
  }
}

TEST_CASE("a distribution without spread is its one value") {
  const Random random(1, "x");
  CHECK(Distribution(Law::normal, 3, 0).draw(random, 5) == 3);
  CHECK(Distribution(Law::uniform, 3, 3).draw(random, 5) == 3);
  Distribution outside(Law::normal, 3, 0);
  outside.cut(4, 5);
  CHECK(outside.kept() == 0);
  CHECK_THROWS_AS(outside.draw(random, 5), Refusal);
}

TEST_CASE("a rule's property may be drawn, in units, and stays in the range of the property") {
  const Scene read = read_text_scene(
      scene(", kn: {weibull: {shape: 3, scale: 2 MN/m, high: 5 MN/m}}, ks: {uniform: {low: 1 kN/m, high: 2 kN/m}}, "
            "fric: {normal: {mean: 0.4, sd: 0.2}}"));
  const Distribution& kn = drawn_in(read, "kn");
  CHECK(kn.law() == Law::weibull);
  CHECK(kn.first() == 3);
  CHECK(kn.second() == 2e6);
  CHECK(kn.high() == 5e6);
  CHECK(drawn_in(read, "ks").first() == 1000);
  CHECK(drawn_in(read, "ks").second() == 2000);
  CHECK(drawn_in(read, "fric").low() == 0);
  CHECK(drawn_in(read, "fric").kept() == Approx(normal_below(2)));
}

TEST_CASE("a ball set may draw a contact property for each ball; the laws it meets cut it") {
  const Scene read = read_text_scene(scene(", kn: 1, ks: 1", ", contact: {fric: {normal: {mean: 0.4, sd: 0.4}}}"));
  const PieceProperty& fric = read.balls.at(0).contact.at(0);
  REQUIRE(fric.drawn != nullptr);
  CHECK(fric.drawn->first() == 0.4);
  CHECK(fric.drawn->low() == 0);
  CHECK(refusal_of(scene(", kn: 1, ks: 1", ", contact: {fric: {normal: {mean: 40 cm, sd: 1}}}")).find("a length") !=
        std::string::npos);
}
