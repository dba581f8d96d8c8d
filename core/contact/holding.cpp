#include "core/contact/holding.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/array.hpp"
#include "core/contact/ball_block.hpp"

namespace scree::core {

namespace {

/// h^2 stiffness + h damping of one ball's contacts over its mass and inertia, in single precision: there is one for
/// every row and for every halo. The lower triangles of the two diagonal blocks, each with two words that stay zero so
/// that vectors hold them, the vector of the skew block between them, and the count of contacts, each of which may add
/// an error of rounding.
struct Sum {
  float moved[8], turned[8], mixed[4];
  double count() const { return static_cast<double>(mixed[3]); }
};
constexpr double root = 1.5811388300841898;  ///< of 2.5, the mass over the inertia of a sphere of radius 1
constexpr double rounding = 1e-6;            ///< of the sum, for each contact, with much to spare

/// What the contacts of a batch add to the sums of their two balls.
struct Parts {
  static constexpr std::size_t size = LinkColumns::size;
  float square[size][8], vector[size][4];  ///< of the normal
  struct End {
    float along[size], across[size], twist[size], turn[size], mixed[size];
  } end[2];
};

class Question {
 public:
  Question(const Contacts& contacts, const Balls& balls, double step)
      : slices_(contacts.slices()), balls_(balls), h_(0.5 * step), sums_(slices_.records()) {}
  /// Links of pairs that a block owns, or of balls of any block with walls.
  void add(const LinkColumns& links);
  void fold(std::size_t block);
  /// Does `share` times the mass bear the sums of all balls of the block, and does `less` times the mass?
  void ask(std::size_t block, double share, double less, uint8_t& all, uint8_t& all_less) const;

 private:
  void ends_of(const LinkColumns& links, int end, Parts& parts) const;
  bool bears(const Sum& sum, double share) const;

  const Slices& slices_;
  const Balls& balls_;
  const double h_;
  Array<Sum> sums_;
};

// As add_end of ball_block.hpp, with dashpots as the springs they are to this step.
void Question::ends_of(const LinkColumns& links, int end, Parts& parts) const {
  const double *inverse = balls_[Column::inverse_mass], *radius = balls_[Column::radius];
  const auto n = static_cast<uint32_t>(links.count);
  double times[Parts::size], per_radius[Parts::size];
  for (uint32_t k = 0; k < n; ++k) {
    const uint32_t row = links.row[end][k], other = links.row[1 - end][k];
    const bool none = row == no_row;
    times[k] = none ? 0.0 : h_ * (other == no_row || inverse[other] == 0 ? 1.0 : 2.0) * inverse[row];
    per_radius[k] = 1 / (none ? 1.0 : radius[row]);
  }
  const double h = h_, side = end == 0 ? root : -root;
  const double *arm = links.arm[end], *kn = links.kn, *ks = links.ks, *kb = links.kb, *kt = links.kt, *cn = links.cn,
               *cs = links.cs;
  float *along = parts.end[end].along, *across = parts.end[end].across, *twist = parts.end[end].twist,
        *turn = parts.end[end].turn, *mixed = parts.end[end].mixed;
#pragma omp simd
  for (uint32_t k = 0; k < n; ++k) {
    const double lever = arm[k] * per_radius[k], stiff = times[k] * (h * kn[k] + cn[k]),
                 shear = times[k] * (h * ks[k] + cs[k]),
                 per_inertia = 2.5 * per_radius[k] * per_radius[k] * times[k] * h,
                 turned = 2.5 * shear * lever * lever + per_inertia * kb[k];
    along[k] = static_cast<float>(stiff - shear);
    across[k] = static_cast<float>(shear);
    twist[k] = static_cast<float>(per_inertia * kt[k] - turned);
    turn[k] = static_cast<float>(turned);
    mixed[k] = static_cast<float>(side * shear * lever);
  }
}

void add_part(Sum& sum, const Parts& parts, int side, std::size_t k) {
  constexpr float diagonal[8] = {1, 0, 1, 0, 0, 1, 0, 0}, one[4] = {0, 0, 0, 1};
  const Parts::End& end = parts.end[side];
  const float along = end.along[k], across = end.across[k], twist = end.twist[k], turn = end.turn[k],
              mixed = end.mixed[k];
  const float *square = parts.square[k], *vector = parts.vector[k];
  for (int w = 0; w < 8; ++w) sum.moved[w] += along * square[w] + across * diagonal[w];
  for (int w = 0; w < 8; ++w) sum.turned[w] += twist * square[w] + turn * diagonal[w];
  for (int w = 0; w < 4; ++w) sum.mixed[w] += mixed * vector[w] + one[w];
}

// A vector that is read right after its words were written one by one waits for all of them: first what the links add,
// then the sums.
void Question::add(const LinkColumns& links) {
  Parts parts;
  ends_of(links, 0, parts);
  ends_of(links, 1, parts);
  for (std::size_t k = 0; k < links.count; ++k) {
    const auto x = static_cast<float>(links.x[k]), y = static_cast<float>(links.y[k]),
               z = static_cast<float>(links.z[k]);
    const float square[8] = {x * x, y * x, y * y, z * x, z * y, z * z, 0, 0}, vector[4] = {x, y, z, 0};
    std::copy_n(square, 8, parts.square[k]);
    std::copy_n(vector, 4, parts.vector[k]);
  }
  for (std::size_t k = 0; k < links.count; ++k) {
    const uint32_t own = links.row[0][k], other = links.row[1][k];
    const std::size_t block = own / block_rows, first = slices_.first_record(block);
    add_part(sums_[first + (own - block * block_rows)], parts, 0, k);
    if (other != no_row) add_part(sums_[first + links.record[k]], parts, 1, k);
  }
}

void Question::fold(std::size_t block) {
  Sum* own = sums_.data() + slices_.first_record(block);
  slices_.each_halo(block, [&](std::size_t row, std::size_t record) {
    Sum& sum = own[row];
    const Sum& part = sums_[record];
    for (int k = 0; k < 8; ++k) sum.moved[k] += part.moved[k];
    for (int k = 0; k < 8; ++k) sum.turned[k] += part.turned[k];
    for (int k = 0; k < 4; ++k) sum.mixed[k] += part.mixed[k];
  });
}

bool Question::bears(const Sum& s, double share) const {
  const float *p = s.moved, *t = s.turned, *m = s.mixed;
  const double limit = share * (1 - rounding * (1 + s.count()));
  // Where no row of the block outweighs the limit no eigenvalue does.
  const auto size = [](float a, float b, float c, float d, float e) {
    return static_cast<double>(std::fabs(a)) + static_cast<double>(std::fabs(b)) + static_cast<double>(std::fabs(c)) +
           static_cast<double>(std::fabs(d)) + static_cast<double>(std::fabs(e));
  };
  const double moved = std::max(
      {size(p[0], p[1], p[3], m[2], m[1]), size(p[1], p[2], p[4], m[2], m[0]), size(p[3], p[4], p[5], m[1], m[0])});
  const double turned = std::max(
      {size(t[0], t[1], t[3], m[2], m[1]), size(t[1], t[2], t[4], m[2], m[0]), size(t[3], t[4], t[5], m[1], m[0])});
  if (std::max(moved, turned) < limit) return true;
  Block b;
  b << p[0], p[1], p[3], 0, m[2], -m[1],  //
      p[1], p[2], p[4], -m[2], 0, m[0],   //
      p[3], p[4], p[5], m[1], -m[0], 0,   //
      0, -m[2], m[1], t[0], t[1], t[3],   //
      m[2], 0, -m[0], t[1], t[2], t[4],   //
      -m[1], m[0], 0, t[3], t[4], t[5];
  return stable(b, Block::Zero(), 1, limit);
}

void Question::ask(std::size_t block, double share, double less, uint8_t& all, uint8_t& all_less) const {
  const Sum* own = sums_.data() + slices_.first_record(block);
  all = all_less = 1;
  for (std::size_t row = 0; row < slices_.block_size(block); ++row) {
    if (all_less != 0 && bears(own[row], less)) continue;
    all_less = 0;
    if (bears(own[row], share)) continue;
    all = 0;
    return;
  }
}

}  // namespace

Holding step_holds(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                   const PeriodicCell& cell, const LinkQuery& query, double local_damping, double step, double factor,
                   Team& team) {
  Question question(contacts, balls, step);
  const std::size_t blocks = contacts.slices().blocks();
  std::vector<std::size_t> counts(blocks, 0);
  const Links rest =
      stream_links(contacts, balls, walls, cell, query, team, [&](std::size_t block, const LinkColumns& links) {
        question.add(links);
        counts[block] += links.count;
      });
  LinkColumns with_walls;
  for (const Link& link : rest.links) {
    with_walls.add(link);
    if (with_walls.count < LinkColumns::size) continue;
    question.add(with_walls);
    with_walls.count = 0;
  }
  question.add(with_walls);
  const double share = 1 / (1 + local_damping);
  std::vector<uint8_t> holds(blocks), larger(blocks);
  team.each_block(blocks, [&](std::size_t block) {
    question.fold(block);
    // Springs grow with the square of the step and dashpots more slowly.
    question.ask(block, share, share / (factor * factor), holds[block], larger[block]);
  });
  Holding out;
  out.impact = rest.impact;
  out.kinematic = rest.kinematic;
  out.links = rest.links.size();
  for (std::size_t block = 0; block < blocks; ++block) {
    out.links += counts[block];
    out.holds = out.holds && holds[block] != 0;
    out.larger = out.larger && larger[block] != 0;
  }
  return out;
}

}  // namespace scree::core
