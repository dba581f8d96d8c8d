#include "core/contact/holding.hpp"

#include <cmath>

#include "core/base/array.hpp"
#include "core/contact/ball_block.hpp"

namespace scree::core {

namespace {

/// h^2 stiffness + h damping of one ball's contacts over its mass and inertia, in single precision: there is one for
/// every row and for every halo. The lower triangles of the two diagonal blocks, the vector of the skew one between
/// them, and the count of contacts, each of which may add an error of rounding.
struct Sum {
  float word[16];
  const float* moved() const { return word; }
  const float* turned() const { return word + 6; }
  const float* mixed() const { return word + 12; }
  float count() const { return word[15]; }
};
constexpr double root = 1.5811388300841898;  ///< of 2.5, the mass over the inertia of a sphere of radius 1
constexpr double rounding = 1e-6;            ///< of the sum, for each contact, with much to spare

class Question {
 public:
  Question(const Contacts& contacts, const Balls& balls, double step)
      : slices_(contacts.slices()), balls_(balls), h_(0.5 * step), sums_(slices_.records()) {}
  void add(std::size_t block, const Link& link);
  void fold(std::size_t block);
  /// Does `share` times the mass bear the sums of all balls of the block?
  bool bears(std::size_t block, double share) const;

 private:
  void add_end(Sum& sum, const Link& link, int end, const float* shape) const;
  bool bears(const Sum& sum, double share) const;

  const Slices& slices_;
  const Balls& balls_;
  const double h_;
  Array<Sum> sums_;
};

// As add_end of ball_block.hpp, with dashpots as the springs they are to this step.
void Question::add_end(Sum& sum, const Link& link, int end, const float* shape) const {
  const uint32_t row = link.row[end], other = link.row[1 - end];
  const double* inverse = balls_[Column::inverse_mass];
  if (inverse[row] == 0) return;
  const double times = h_ * (other == no_row || inverse[other] == 0 ? 1.0 : 2.0) * inverse[row];
  const double per_radius = 1 / balls_[Column::radius][row], arm = link.arm[end] * per_radius;
  const double kn = times * (h_ * link.kn + link.cn), ks = times * (h_ * link.ks + link.cs);
  const double per_inertia = 2.5 * per_radius * per_radius * times * h_,
               turn = 2.5 * ks * arm * arm + per_inertia * link.kb;
  const auto along = static_cast<float>(kn - ks), across = static_cast<float>(ks), spin = static_cast<float>(turn),
             twist = static_cast<float>(per_inertia * link.kt - turn),
             mixed = static_cast<float>((end == 0 ? root : -root) * ks * arm);
  const float by[16] = {along, along, along, along, along, along, twist, twist,
                        twist, twist, twist, twist, mixed, mixed, mixed, 0};
  const float plus[16] = {across, 0, across, 0, 0, across, spin, 0, spin, 0, 0, spin, 0, 0, 0, 1};
  for (int k = 0; k < 16; ++k) sum.word[k] += by[k] * shape[k] + plus[k];
}

void Question::add(std::size_t block, const Link& link) {
  const std::size_t first = slices_.first_record(block);
  const auto x = static_cast<float>(link.normal[0]), y = static_cast<float>(link.normal[1]),
             z = static_cast<float>(link.normal[2]);
  const float shape[16] = {x * x, y * x, y * y, z * x, z * y, z * z, x * x, y * x,
                           y * y, z * x, z * y, z * z, x,     y,     z,     0};
  add_end(sums_[first + (link.row[0] - block * block_rows)], link, 0, shape);
  if (link.row[1] != no_row) add_end(sums_[first + link.record], link, 1, shape);
}

void Question::fold(std::size_t block) {
  Sum* own = sums_.data() + slices_.first_record(block);
  slices_.each_halo(block, [&](std::size_t row, std::size_t record) {
    for (int k = 0; k < 16; ++k) own[row].word[k] += sums_[record].word[k];
  });
}

bool Question::bears(const Sum& s, double share) const {
  const float *p = s.moved(), *t = s.turned(), *m = s.mixed();
  Block b;
  b << p[0], p[1], p[3], 0, m[2], -m[1],  //
      p[1], p[2], p[4], -m[2], 0, m[0],   //
      p[3], p[4], p[5], m[1], -m[0], 0,   //
      0, -m[2], m[1], t[0], t[1], t[3],   //
      m[2], 0, -m[0], t[1], t[2], t[4],   //
      -m[1], m[0], 0, t[3], t[4], t[5];
  const double limit = share * (1 - rounding * (1 + static_cast<double>(s.count())));
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
        for (const Link& link : links) question.add(block, link);
        counts[block] += links.size();
      });
  for (const Link& link : rest.links) question.add(link.row[0] / block_rows, link);
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
