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

/// What one contact adds to the sums of its two balls.
struct Part {
  float square[8], vector[4];  ///< of the normal
  struct End {
    float along, across, twist, turn, mixed;
  } end[2];
};

class Question {
 public:
  Question(const Contacts& contacts, const Balls& balls, double step)
      : slices_(contacts.slices()), balls_(balls), h_(0.5 * step), sums_(slices_.records()) {}
  /// Links of pairs that a block owns, or of balls of any block with walls.
  void add(const Link* links, std::size_t count);
  void fold(std::size_t block);
  /// Does `share` times the mass bear the sums of all balls of the block?
  bool bears(std::size_t block, double share) const;

 private:
  Part::End end_of(const Link& link, int end) const;
  bool bears(const Sum& sum, double share) const;

  const Slices& slices_;
  const Balls& balls_;
  const double h_;
  Array<Sum> sums_;
};

// As add_end of ball_block.hpp, with dashpots as the springs they are to this step.
Part::End Question::end_of(const Link& link, int end) const {
  const uint32_t row = link.row[end], other = link.row[1 - end];
  const double* inverse = balls_[Column::inverse_mass];
  if (row == no_row || inverse[row] == 0) return {0, 0, 0, 0, 0};
  const double times = h_ * (other == no_row || inverse[other] == 0 ? 1.0 : 2.0) * inverse[row];
  const double per_radius = 1 / balls_[Column::radius][row], arm = link.arm[end] * per_radius;
  const double kn = times * (h_ * link.kn + link.cn), ks = times * (h_ * link.ks + link.cs);
  const double per_inertia = 2.5 * per_radius * per_radius * times * h_,
               turn = 2.5 * ks * arm * arm + per_inertia * link.kb;
  return {static_cast<float>(kn - ks), static_cast<float>(ks), static_cast<float>(per_inertia * link.kt - turn),
          static_cast<float>(turn), static_cast<float>((end == 0 ? root : -root) * ks * arm)};
}

void add_part(Sum& sum, const Part& part, const Part::End& end) {
  constexpr float diagonal[8] = {1, 0, 1, 0, 0, 1, 0, 0}, one[4] = {0, 0, 0, 1};
  for (int k = 0; k < 8; ++k) sum.moved[k] += end.along * part.square[k] + end.across * diagonal[k];
  for (int k = 0; k < 8; ++k) sum.turned[k] += end.twist * part.square[k] + end.turn * diagonal[k];
  for (int k = 0; k < 4; ++k) sum.mixed[k] += end.mixed * part.vector[k] + one[k];
}

// A vector that is read right after its words were written one by one waits for all of them: first what the links add,
// then the sums.
void Question::add(const Link* links, std::size_t count) {
  Part parts[SCREE_BATCH];
  for (std::size_t begin = 0; begin < count; begin += SCREE_BATCH) {
    const std::size_t n = std::min<std::size_t>(SCREE_BATCH, count - begin);
    for (std::size_t k = 0; k < n; ++k) {
      const Link& link = links[begin + k];
      const auto x = static_cast<float>(link.normal[0]), y = static_cast<float>(link.normal[1]),
                 z = static_cast<float>(link.normal[2]);
      parts[k] = {{x * x, y * x, y * y, z * x, z * y, z * z, 0, 0}, {x, y, z, 0}, {end_of(link, 0), end_of(link, 1)}};
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Link& link = links[begin + k];
      const std::size_t block = link.row[0] / block_rows, first = slices_.first_record(block);
      add_part(sums_[first + (link.row[0] - block * block_rows)], parts[k], parts[k].end[0]);
      if (link.row[1] != no_row) add_part(sums_[first + link.record], parts[k], parts[k].end[1]);
    }
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
  Block b;
  b << p[0], p[1], p[3], 0, m[2], -m[1],  //
      p[1], p[2], p[4], -m[2], 0, m[0],   //
      p[3], p[4], p[5], m[1], -m[0], 0,   //
      0, -m[2], m[1], t[0], t[1], t[3],   //
      m[2], 0, -m[0], t[1], t[2], t[4],   //
      -m[1], m[0], 0, t[3], t[4], t[5];
  const double limit = share * (1 - rounding * (1 + s.count()));
  // Where no row of the block outweighs the limit no eigenvalue does.
  return b.cwiseAbs().rowwise().sum().maxCoeff() < limit || stable(b, Block::Zero(), 1, limit);
}

bool Question::bears(std::size_t block, double share) const {
  const Sum* own = sums_.data() + slices_.first_record(block);
  for (std::size_t row = 0; row < slices_.block_size(block); ++row)
    if (!bears(own[row], share)) return false;
  return true;
}

}  // namespace

Holding step_holds(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                   const PeriodicCell& cell, const LinkQuery& query, double local_damping, double step, double factor,
                   Team& team) {
  Question question(contacts, balls, step);
  const std::size_t blocks = contacts.slices().blocks();
  std::vector<std::size_t> counts(blocks, 0);
  const Links rest =
      stream_links(contacts, balls, walls, cell, query, team, [&](std::size_t block, const std::vector<Link>& links) {
        question.add(links.data(), links.size());
        counts[block] += links.size();
      });
  question.add(rest.links.data(), rest.links.size());
  const double share = 1 / (1 + local_damping);
  std::vector<uint8_t> holds(blocks), larger(blocks);
  team.each_block(blocks, [&](std::size_t block) {
    question.fold(block);
    // Springs grow with the square of the step and dashpots more slowly.
    larger[block] = question.bears(block, share / (factor * factor));
    holds[block] = larger[block] != 0 || question.bears(block, share);
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
