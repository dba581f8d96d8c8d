#include <algorithm>
#include <cmath>

#include "support/ball_sink.hpp"
#include "support/catch.hpp"
#include "support/opened.hpp"

namespace {

using support::BallSink;
using support::Object;
using support::opened;

constexpr double pi = 3.14159265358979324;

const scree_generator& generator() { return opened<scree_generator>("generator", "random"); }

std::string generate(const Object& object, BallSink& sink) {
  support::Refused refused;
  return generator().generate(object.self(), sink.table(), &refused.table) != 0
             ? std::string("refused: ") + refused.text
             : "";
}
double solid(const BallSink& sink) {
  double sum = 0;
  for (const auto& b : sink.balls) sum += 4 * pi / 3 * b.ball.radius * b.ball.radius * b.ball.radius;
  return sum;
}

}  // namespace

TEST_CASE("random: porosity, box and no overlap", "[plugin]") {
  Object object(generator().object);
  REQUIRE(object.box("box", {0, 0, 0}, {1, 2, 1}) == "");
  REQUIRE(object.list("radius", {0.05, 0.1}) == "");
  REQUIRE(object.number("porosity", 0.8) == "");
  REQUIRE(object.check() == "");
  BallSink sink;
  REQUIRE(generate(object, sink) == "");
  CHECK(std::abs(1 - solid(sink) / 2 - 0.8) <= 4 * pi / 3 * 1e-3 / 2 / 2);  // half of the largest ball
  double before = 1;
  for (const auto& b : sink.balls) {
    const double r = b.ball.radius;
    CHECK(r >= 0.05);
    CHECK(r <= before);  // the larger first
    before = r;
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(b.ball.position[k] >= r);
      CHECK(b.ball.position[k] <= (k == 1 ? 2 : 1) - r);
    }
  }
  BallSink again, other(2);
  REQUIRE(generate(object, again) == "");
  REQUIRE(generate(object, other) == "");
  REQUIRE(again.balls.size() == sink.balls.size());
  CHECK(again.balls.back().ball.position[0] == sink.balls.back().ball.position[0]);
  CHECK(other.balls.back().ball.position[0] != sink.balls.back().ball.position[0]);
}

TEST_CASE("random: moments of the size distributions", "[plugin]") {
  // Uniform on [a, b]: mean (a+b)/2, variance (b-a)^2/12. Gaussian cut at 3 deviations: variance 0.9733 sd^2.
  // Tolerances: five standard errors of 20 000 draws.
  const double n = 20000;
  for (const bool gaussian : {false, true}) {
    Object object(generator().object);
    REQUIRE(object.box("box", {0, 0, 0}, {1e4, 1e4, 1e4}) == "");
    REQUIRE(object.list("radius", gaussian ? std::vector<double>{0.1, 0.02} : std::vector<double>{0.05, 0.15}) == "");
    REQUIRE(object.text("distribution", gaussian ? "gaussian" : "uniform") == "");
    REQUIRE(object.number("count", n) == "");
    REQUIRE(object.check() == "");
    BallSink sink;
    sink.room = 0;
    // Sizes only: the first refused ball ends the run, so let a sink take all of them without a search.
    struct All {
      std::vector<double> radius;
    } all;
    scree_sink table = *sink.table();
    const scree_random random = *table.random;
    table.random = &random;
    table.self = &all;
    table.try_ball = [](void* self, const scree_ball* ball) {
      static_cast<All*>(self)->radius.push_back(ball->radius);
      return 1;
    };
    REQUIRE(generator().generate(object.self(), &table, nullptr) == 0);
    REQUIRE(all.radius.size() == 20000);
    double sum = 0, squares = 0;
    for (const double r : all.radius) sum += r, squares += r * r;
    const double mean = sum / n, variance = squares / n - mean * mean;
    const double expected = gaussian ? 0.9733 * 0.02 * 0.02 : 0.01 / 12;
    CHECK(std::abs(mean - 0.1) < 5 * std::sqrt(expected / n));
    CHECK(variance == Approx(expected).epsilon(0.05));
    const auto [least, most] = std::minmax_element(all.radius.begin(), all.radius.end());
    CHECK(*least >= (gaussian ? 0.04 : 0.05));
    CHECK(*most <= (gaussian ? 0.16 : 0.15));
  }
}

TEST_CASE("random: a grading by mass gives the number fractions of its sieves", "[plugin]") {
  // Mass shares 0.2/0.5/0.3 at d = 4/8/16: numbers as w/d^3, 128 : 40 : 3, here 0.748538 0.233918 0.017544.
  Object object(generator().object);
  REQUIRE(object.box("box", {0, 0, 0}, {0.2, 0.2, 0.2}) == "");
  REQUIRE(object.numbers("grading", {0.016, 0.016, 0.3, 0.004, 0.004, 0.2, 0.008, 0.008, 0.5}, 3, 3) == "");
  REQUIRE(object.number("count", 171) == "");
  REQUIRE(object.check() == "");
  BallSink sink;
  REQUIRE(generate(object, sink) == "");
  const auto of = [&](double r) {
    return std::count_if(sink.balls.begin(), sink.balls.end(), [r](const auto& b) { return b.ball.radius == r; });
  };
  CHECK(of(0.002) == 128);
  CHECK(of(0.004) == 40);
  CHECK(of(0.008) == 3);
}

TEST_CASE("random: inside a fraction by mass every interval of diameter holds the same mass", "[plugin]") {
  Object object(generator().object);
  REQUIRE(object.box("box", {0, 0, 0}, {1, 1, 1}) == "");
  REQUIRE(object.numbers("grading", {0.02, 0.04, 1}, 1, 3) == "");
  REQUIRE(object.number("count", 3000) == "");
  REQUIRE(object.check() == "");
  BallSink sink;
  REQUIRE(generate(object, sink) == "");
  double lower = 0, all = 0;
  for (const auto& b : sink.balls) {
    const double d = 2 * b.ball.radius, mass = d * d * d;
    CHECK(d >= 0.02);
    CHECK(d <= 0.04);
    all += mass;
    if (d < 0.03) lower += mass;
  }
  CHECK(lower / all == Approx(0.5).margin(0.03));
  // Density of number c d^-3 on [a, b]: mean of d^3 is 2 a^2 b^2/(a + b).
  CHECK(all / 3000 == Approx(2 * 4e-4 * 16e-4 / 0.06).epsilon(0.03));
}

TEST_CASE("random: shrink, periodic axes, and giving up", "[plugin]") {
  Object object(generator().object);
  REQUIRE(object.box("box", {0, 0, 0}, {1, 1, 1}) == "");
  REQUIRE(object.list("radius", {0.2}) == "");
  REQUIRE(object.number("count", 40) == "");
  REQUIRE(object.number("tries", 500) == "");
  REQUIRE(object.check() == "");
  BallSink crowded;
  const std::string why = generate(object, crowded);
  CHECK(why.find("refused: placed " + std::to_string(crowded.balls.size()) +
                 " of 40 balls (largest first) in a box of 1 m3") == 0);
  CHECK(why.find("-0.34 asked") != std::string::npos);  // 40 * 4 pi/3 * 0.008 = 1.3404
  CHECK(why.find("found no place in 500 tries") != std::string::npos);
  REQUIRE(object.number("shrink", 0.25) == "");
  BallSink sink;
  REQUIRE(generate(object, sink) == "");
  CHECK(sink.balls.size() == 40);
  CHECK(sink.balls[0].ball.radius == 0.05);

  const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
  const uint8_t periodic[3] = {1, 0, 0};
  REQUIRE(object.number("count", 200) == "");
  BallSink wrapped;
  wrapped.cell(low, high, periodic);
  REQUIRE(generate(object, wrapped) == "");
  bool near_face = false;
  for (const auto& b : wrapped.balls) {
    near_face = near_face || b.ball.position[0] < 0.05;
    CHECK(b.ball.position[1] >= 0.05);
  }
  CHECK(near_face);

  REQUIRE(object.list("radius", {3}) == "");
  BallSink large;
  CHECK(generate(object, large).find("is larger than the box") != std::string::npos);
}

TEST_CASE("random: settings that contradict each other are refused", "[plugin]") {
  const auto refusal = [](const std::vector<double>& radius, const std::vector<double>& grading, bool count,
                          bool porosity) {
    Object object(generator().object);
    REQUIRE(object.list("radius", radius) == "");
    const std::string at_once = object.numbers("grading", grading, static_cast<uint32_t>(grading.size() / 3), 3);
    if (!at_once.empty()) return at_once;
    if (count) REQUIRE(object.number("count", 5) == "");
    if (porosity) REQUIRE(object.number("porosity", 0.5) == "");
    return object.check();
  };
  CHECK(refusal({}, {}, true, false) == "give either 'radius: [lowest, highest]' or 'grading', and not both");
  CHECK(refusal({1}, {1, 2, 1}, true, false) == "give either 'radius: [lowest, highest]' or 'grading', and not both");
  CHECK(refusal({1}, {}, true, true) == "give either 'count' or 'porosity', and not both");
  CHECK(refusal({1}, {}, false, false) == "give either 'count' or 'porosity', and not both");
  CHECK(refusal({2, 1}, {}, true, false) == "'radius' must name the lower end first");
  CHECK(refusal({0, 1}, {}, true, false) == "'radius' must be above 0");
  CHECK(refusal({1, 2, 3}, {}, true, false) == "'radius' wants one or two numbers");
  CHECK(refusal({}, {1, 2, 0.5, 2, 3, 0.4}, true, false) == "'grading': the shares sum to 0.9, not 1");
  CHECK(refusal({}, {1, 2, 0.5, 1.5, 3, 0.5}, true, false) ==
        "'grading': the fractions [1, 2] m and [1.5, 3] m overlap");
  CHECK(refusal({}, {2, 1, 1}, true, false) == "'grading': diameter [2, 1] m must run from above 0 upwards");
  CHECK(refusal({}, {1, 2, 0}, true, false) == "'share' is 0, but must be above 0");
  CHECK(refusal({}, {1, 2, 0.5, 2, 3, 0.5}, true, false) == "");
}
