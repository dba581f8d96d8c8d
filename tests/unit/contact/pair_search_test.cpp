// Pair search against brute force: the same pairs, the same periodic images, each once, on sets that hurt a hash.
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "core/base/isa.hpp"
#include "core/base/philox.hpp"
#include "core/contact/pair_search.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

using Pair = std::tuple<uint32_t, uint32_t, uint8_t>;  // lower row, higher row, image of the higher one

struct Set {
  Balls balls;
  PeriodicCell cell;
  double margin = 0;
  Random random{17, "pair search"};
  uint64_t drawn = 0;

  double draw(double low, double high) { return low + (high - low) * random.uniform(drawn++, 0); }
  void add(double x, double y, double z, double radius) {
    const std::size_t row = balls.size();
    balls.resize(row + 1);
    balls[Column::x][row] = x;
    balls[Column::y][row] = y;
    balls[Column::z][row] = z;
    balls[Column::radius][row] = radius;
    balls.id()[row] = row + 1;
  }
  void scatter(int count, double low, double high, double least, double most) {
    for (int k = 0; k < count; ++k) {
      const double x = draw(low, high), y = draw(low, high), z = draw(low, high);
      add(x, y, z, draw(least, most));
    }
  }
};

std::vector<Pair> brute_force(const Set& set) {
  std::vector<Pair> pairs;
  const Balls& balls = set.balls;
  for (uint32_t i = 0; i < balls.size(); ++i)
    for (uint32_t j = i + 1; j < balls.size(); ++j) {
      // All 27 images; the code is 1 for the image a whole edge further, 2 for the one before.
      for (int image = 0; image < 64; ++image) {
        double square = 0;
        bool possible = true;
        for (int axis = 0; axis < 3; ++axis) {
          const int code = (image >> (2 * axis)) & 3;
          if (code == 3 || (code != 0 && !set.cell.periodic[axis])) possible = false;
          const auto column = static_cast<Column>(static_cast<int>(Column::x) + axis);
          const double shift = code == 0 ? 0.0 : code == 1 ? set.cell.length(axis) : -set.cell.length(axis);
          const double d = balls[column][j] - balls[column][i] + shift;
          square += d * d;
        }
        const double limit = balls[Column::radius][i] + balls[Column::radius][j] + set.margin;
        if (possible && square < limit * limit) pairs.emplace_back(i, j, static_cast<uint8_t>(image));
      }
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<Pair> found(const Set& set, unsigned threads, int isa) {
  Team team(threads);
  const PairTable table = find_pairs(set.balls, set.cell, set.margin, team, isa);
  REQUIRE(table.begin.size() == set.balls.size() + 1);
  std::vector<Pair> pairs;
  for (uint32_t row = 0; row < set.balls.size(); ++row)
    for (uint64_t slot = table.begin[row]; slot < table.begin[row + 1]; ++slot)
      pairs.emplace_back(row, table.other[slot], table.image[slot]);
  return pairs;
}

void compare(const Set& set, std::size_t at_least) {
  const std::vector<Pair> expected = brute_force(set);
  CHECK(expected.size() >= at_least);
  for (const unsigned threads : {1u, 3u})
    for (int isa = 0; isa <= static_cast<int>(detect_isa()); ++isa) {
      INFO(threads << " threads, " << set.balls.size() << " balls, " << isa_name(static_cast<Isa>(isa)));
      // In row order already: sorted, and each pair once.
      CHECK(found(set, threads, isa) == expected);
    }
}

}  // namespace

TEST_CASE("pairs of a dense set equal brute force", "[pairs]") {
  Set set;
  set.margin = 0.1;
  set.scatter(1500, 0, 20, 0.5, 0.9);
  compare(set, 1000);
}

TEST_CASE("pairs of clusters far apart equal brute force", "[pairs]") {
  Set set;
  set.margin = 0.02;
  for (int cluster = 0; cluster < 12; ++cluster) {
    const double x = set.draw(-1e4, 1e4), y = set.draw(-1e4, 1e4), z = set.draw(-1e4, 1e4);
    for (int k = 0; k < 100; ++k)
      set.add(x + set.draw(0, 4), y + set.draw(0, 4), z + set.draw(0, 4), set.draw(0.2, 0.39));
  }
  compare(set, 500);
}

TEST_CASE("pairs of a sparse set equal brute force", "[pairs]") {
  Set set;
  set.margin = 0.3;
  set.scatter(1500, -40, 40, 0.5, 1);
  set.add(set.balls[Column::x][0] + 0.5, set.balls[Column::y][0], set.balls[Column::z][0], 0.7);
  compare(set, 1);
}

TEST_CASE("pairs of many small balls around a giant one equal brute force", "[pairs]") {
  Set set;
  set.margin = 0.05;
  set.scatter(1500, -12, 12, 0.1, 0.4);
  set.add(0, 0, 0, 10);
  set.scatter(20, -12, 12, 0.1, 0.4);
  compare(set, 500);
}

TEST_CASE("pairs of radii 1 to 100 equal brute force", "[pairs]") {
  Set set;
  set.margin = 0.005;
  for (int k = 0; k < 1500; ++k) {
    // As many balls in each factor of size.
    const double radius = 0.01 * std::exp2(set.draw(0, 6.643856));
    set.add(set.draw(0, 4), set.draw(0, 4), set.draw(0, 4), radius);
  }
  compare(set, 1000);
}

TEST_CASE("a set with balls that escape keeps its pairs", "[pairs]") {
  Set set;
  set.margin = 0.1;
  set.scatter(1000, 0, 15, 0.4, 0.7);
  const double far[] = {1e3, -1e6, 1e9, -1e12, 1e15};
  for (const double d : far) {
    set.add(d, 0, 0, 0.5);
    set.add(d, d, -d, 0.5);
  }
  // Two that escape together.
  set.add(1e6, 1e6, 0, 0.5);
  set.add(1e6 + 0.25, 1e6, 0, 0.5);
  compare(set, 500);
}

TEST_CASE("pairs across the faces, edges and corners of a periodic cell equal brute force", "[pairs]") {
  for (int axes = 1; axes < 8; ++axes) {
    Set set;
    set.margin = 0.1;
    for (int axis = 0; axis < 3; ++axis) {
      set.cell.low[axis] = -3 - axis;
      set.cell.high[axis] = 5 + axis;
      set.cell.periodic[axis] = (axes >> axis & 1) != 0;
    }
    for (int k = 0; k < 600; ++k) set.add(set.draw(-3, 5), set.draw(-4, 6), set.draw(-5, 7), set.draw(0.2, 0.5));
    // On the faces and in a corner.
    set.add(-3, -4, -5, 0.5);
    set.add(4.999, 5.999, 6.999, 0.5);
    INFO("periodic axes " << axes);
    compare(set, 300);
  }
}

TEST_CASE("a periodic cell of only four diameters keeps its pairs", "[pairs]") {
  Set set;
  set.margin = 0.1;
  for (int axis = 0; axis < 3; ++axis) {
    set.cell.high[axis] = 2 * (2 * 0.5 + set.margin);
    set.cell.periodic[axis] = true;
  }
  for (int k = 0; k < 30; ++k) set.add(set.draw(0, 2.2), set.draw(0, 2.2), set.draw(0, 2.2), set.draw(0.3, 0.5));
  compare(set, 30);
}

TEST_CASE("few balls, equal places and no balls", "[pairs]") {
  Set none;
  compare(none, 0);
  Set one;
  one.add(0, 0, 0, 1);
  compare(one, 0);
  Set same;
  for (int k = 0; k < 5; ++k) same.add(1, 2, 3, 0.5);
  compare(same, 10);
}
