#include <cmath>

#include "support/ball_sink.hpp"
#include "support/catch.hpp"
#include "support/opened.hpp"

namespace {

using support::BallSink;
using support::Object;
using support::opened;
using support::Vector;

constexpr double pi = 3.14159265358979324;

struct Case {
  const char* kind;
  std::array<double, 3> edge;  // of the orthogonal cell, in spacings
  int balls, neighbours;
  double porosity;
};
// Porosities and coordination numbers: Conway & Sloane, Sphere Packings, Lattices and Groups; sc 1 - pi/6,
// bcc 1 - pi sqrt 3/8, fcc and hcp 1 - pi/(3 sqrt 2).
const Case cases[] = {
    {"sc", {1, 1, 1}, 1, 6, 1 - pi / 6},
    {"bcc", {2 / std::sqrt(3.0), 2 / std::sqrt(3.0), 2 / std::sqrt(3.0)}, 2, 8, 1 - pi* std::sqrt(3.0) / 8},
    {"fcc", {std::sqrt(2.0), std::sqrt(2.0), std::sqrt(2.0)}, 4, 12, 1 - pi / (3 * std::sqrt(2.0))},
    {"hcp", {1, std::sqrt(3.0), std::sqrt(8.0 / 3.0)}, 4, 12, 1 - pi / (3 * std::sqrt(2.0))},
};

const scree_generator& lattice() { return opened<scree_generator>("generator", "lattice"); }

std::string generate(const Object& object, BallSink& sink) {
  support::Refused refused;
  return lattice().generate(object.self(), sink.table(), &refused.table) != 0 ? std::string("refused: ") + refused.text
                                                                              : "";
}

}  // namespace

TEST_CASE("lattice: whole periodic cells have the known porosity, and every ball the known neighbours", "[plugin]") {
  const double d = 0.02;
  for (const Case& c : cases) {
    Object object(lattice().object);
    const int cells = 4;
    Vector high{};
    for (std::size_t k = 0; k < 3; ++k) high[k] = cells * c.edge[k] * d;
    REQUIRE(object.text("kind", c.kind) == "");
    REQUIRE(object.number("radius", d / 2) == "");
    REQUIRE(object.box("box", {0, 0, 0}, high) == "");
    REQUIRE(object.number("fit", 0) == "");
    BallSink sink;
    REQUIRE(generate(object, sink) == "");
    const auto count = static_cast<std::size_t>(cells * cells * cells * c.balls);
    REQUIRE(sink.balls.size() == count);
    const double solid = static_cast<double>(count) * pi / 6 * d * d * d;
    CHECK(1 - solid / (high[0] * high[1] * high[2]) == Approx(c.porosity).epsilon(1e-12));
    for (const auto& a : sink.balls) {
      int near = 0;
      for (const auto& b : sink.balls) {
        double squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          double gap = std::abs(a.ball.position[k] - b.ball.position[k]);
          gap = std::min(gap, high[k] - gap);
          squared += gap * gap;
        }
        if (&a == &b) continue;
        REQUIRE(squared > d * d * (1 - 1e-9));  // nothing overlaps
        near += squared < d * d * (1 + 1e-9);
      }
      REQUIRE(near == c.neighbours);
    }
  }
}

TEST_CASE("lattice: with fit every ball lies inside, and one layer more would not", "[plugin]") {
  Object object(lattice().object);
  REQUIRE(object.text("kind", "sc") == "");
  REQUIRE(object.number("radius", 0.05) == "");
  REQUIRE(object.box("box", {-1, 0, 2}, {-0.3, 0.35, 2.1}) == "");  // 0.7 x 0.35 x 0.1: 7 x 3 x 1 balls
  BallSink sink;
  REQUIRE(generate(object, sink) == "");
  REQUIRE(sink.balls.size() == 21);
  CHECK(sink.balls[0].ball.position[0] == Approx(-0.95));
  CHECK(sink.balls[0].ball.position[1] == Approx(0.05));
  CHECK(sink.balls[1].ball.position[0] == Approx(-0.85));  // x runs fastest
}

TEST_CASE("lattice: origin and spacing", "[plugin]") {
  Object object(lattice().object);
  REQUIRE(object.text("kind", "sc") == "");
  REQUIRE(object.number("radius", 0.1) == "");
  REQUIRE(object.number("spacing", 0.5) == "");
  REQUIRE(object.vector("origin", {10, 0, 0}) == "");  // far outside: the lattice is the same
  REQUIRE(object.box("box", {0, 0, 0}, {1, 1, 1}) == "");
  REQUIRE(object.number("fit", 0) == "");
  BallSink sink;
  REQUIRE(generate(object, sink) == "");
  REQUIRE(sink.balls.size() == 8);
  for (const auto& b : sink.balls)
    for (const double p : b.ball.position) CHECK((p == 0 || p == 0.5));
}

TEST_CASE("lattice: nothing fits, or the host has had enough", "[plugin]") {
  Object object(lattice().object);
  REQUIRE(object.text("kind", "fcc") == "");
  REQUIRE(object.number("radius", 0.6) == "");
  REQUIRE(object.box("box", {0, 0, 0}, {1, 1, 1}) == "");
  BallSink none;
  CHECK(generate(object, none).find("refused: no ball of radius 0.6 m fits") == 0);
  REQUIRE(object.number("radius", 0.1) == "");
  BallSink full;
  full.room = 3;
  CHECK(generate(object, full) == "refused: ");
  CHECK(full.balls.size() == 3);
  CHECK(object.text("kind", "diamond") == "'kind' is 'diamond', but must be one of: sc bcc fcc hcp");
}
