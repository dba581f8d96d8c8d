// The bound for any arrangement of contacts round a ball, against arrangements that are looked for on purpose: the
// eigenvalue of the sum of their blocks, as of core/contact/ball_block.hpp, must lie below it.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/philox.hpp"
#include "core/contact/ball_block.hpp"
#include "core/contact/cap_sum.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

using Direction = Eigen::Vector3d;
using Arrangement = std::vector<Direction>;

struct Springs {
  double kn, ks, kb, kt;
};

// Of a ball of radius 1 and mass 1.
double largest(const Arrangement& round, const Springs& k) {
  Block block = Block::Zero();
  for (const Direction& n : round) {
    Link link{};
    std::copy_n(n.data(), 3, link.normal);
    link.arm[0] = 1;
    add_end(block, link, 0, k.kn, k.ks, k.kb, k.kt, 1, 1);
  }
  const Block whole = block.selfadjointView<Eigen::Lower>();
  return Eigen::SelfAdjointEigenSolver<Block>(whole, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

double bound(const Springs& k, double angle) {
  ContactShape one;
  one.along = k.kn;
  one.across = k.ks;
  one.twist = 2.5 * k.kt;
  one.bend = 2.5 * (k.ks + k.kb);
  one.mixed = std::sqrt(2.5) * k.ks;
  return cap_sum(one, std::cos(0.5 * angle));
}

bool fits(const Arrangement& round, const Direction& n, std::size_t without, double cosine) {
  for (std::size_t k = 0; k < round.size(); ++k)
    if (k != without && round[k].dot(n) > cosine) return false;
  return true;
}

/// Throws directions until nearly none fits any more, then moves one after another where that raises the eigenvalue.
class Search {
 public:
  explicit Search(double angle) : cosine_(std::cos(angle) + 1e-12) {}
  double climb(const Springs& k, uint64_t start) {
    index_ = start;
    next_ = 0;
    Arrangement round;
    fill(round, 400);
    double most = largest(round, k);
    double reach = 0.3;
    for (int again = 0; again < 6000; ++again, reach = std::max(0.003, reach * 0.999)) {
      Arrangement trial = round;
      const auto which = static_cast<std::size_t>(draw() * static_cast<double>(round.size()));
      const Direction moved = (trial[which] + reach * random()).normalized();
      if (!fits(round, moved, which, cosine_)) continue;
      trial[which] = moved;
      if (again % 50 == 0) fill(trial, 40);
      const double now = largest(trial, k);
      if (now < most) continue;
      most = now;
      round = trial;
    }
    return most;
  }

 private:
  double draw() { return random_.uniform(index_, next_++); }
  Direction random() {
    const double z = 2 * draw() - 1, phi = 6.283185307179586 * draw(), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  void fill(Arrangement& round, int tries) {
    for (int k = 0; k < tries; ++k) {
      const Direction n = random();
      if (fits(round, n, round.size(), cosine_)) round.push_back(n);
    }
  }
  const double cosine_;
  const Random random_{3, "arrangements"};
  uint64_t index_ = 0, next_ = 0;
};

Arrangement twelve(bool icosahedron) {
  const double golden = 0.5 * (1 + std::sqrt(5.0));
  Arrangement round;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0}) {
      const double far = icosahedron ? b * golden : b;
      round.push_back(Direction(0, a, far).normalized());
      round.push_back(Direction(a, far, 0).normalized());
      round.push_back(Direction(far, 0, a).normalized());
    }
  return round;
}

constexpr double sixty = 1.0471975511965976;

}  // namespace

TEST_CASE("the bound for any arrangement of contacts lies above all that are found, and not far") {
  const Springs springs[] = {{1, 0, 0, 0},   {1, 2.0 / 7, 0, 0}, {1, 0.5, 0, 0}, {1, 1, 0, 0},     {1, 1.5, 0, 0},
                             {0.1, 1, 0, 0}, {1, 0.5, 0.2, 0.1}, {1, 0, 0.5, 0}, {0, 0, 0.2, 0.9}, {1, 0.01, 0, 0}};
  for (const double angle : {sixty, 0.9 * sixty, 0.5 * sixty})
    for (const Springs& k : springs) {
      const double above = bound(k, angle);
      double most = 0;
      if (angle == sixty) most = std::max(largest(twelve(false), k), largest(twelve(true), k));
      Search search(angle);
      for (uint64_t start = 0; start < (angle == sixty ? 4 : 1); ++start) most = std::max(most, search.climb(k, start));
      INFO(k.kn << " " << k.ks << " " << k.kb << " " << k.kt << " at " << angle << ": found " << most << ", bound "
                << above);
      CHECK(most < above);
      CHECK(above < 1.6 * most);
    }
}

TEST_CASE("springs of no direction count as many times as there are caps") {
  // With kn = ks and no arm to turn with the block is the same for every direction: caps = 2/(1 - cos 30) = 14.93.
  ContactShape one;
  one.along = one.across = 3;
  CHECK_THAT(cap_sum(one, std::cos(0.5 * sixty)), Catch::WithinRel(3 * 2 / (1 - std::cos(0.5 * sixty)), 1e-12));
  CHECK(cap_sum(ContactShape(), 0.5) == 0);
}
