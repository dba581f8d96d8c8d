#include "core/contact/network_bound.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/ball_block.hpp"

namespace scree::core {

namespace {

// Beyond this ratio two weights count as equal to it: nothing is gained, and products of sweeps stay in range.
constexpr double least_weight = 1e-30;
constexpr double worthwhile = 0.002;  ///< share that two sweeps must gain, or they end
constexpr double rounding = 1e-10;    ///< share that covers rounding in the blocks and their factors

/// Which end of which link: the ends of each row, row by row, in the order of links.
struct Ends {
  std::vector<uint32_t> begin, end;  ///< end: 2 * link + side
  Ends(const std::vector<Link>& links, std::size_t first, std::size_t last) : begin(last - first + 1, 0) {
    const auto each = [&](auto f) {
      for (std::size_t k = 0; k < links.size(); ++k)
        for (uint32_t side = 0; side < 2; ++side) {
          const uint32_t row = links[k].row[side];
          if (row != no_row && row >= first && row < last) f(row - first, static_cast<uint32_t>(2 * k + side));
        }
    };
    each([&](std::size_t row, uint32_t) { ++begin[row + 1]; });
    for (std::size_t row = 1; row < begin.size(); ++row) begin[row] += begin[row - 1];
    end.resize(begin.back());
    std::vector<uint32_t> next(begin.begin(), begin.end() - 1);
    each([&](std::size_t row, uint32_t which) { end[next[row]++] = which; });
  }
};

/// The links of a stretch of rows, and the rows' blocks under weights.
struct Portion {
  std::size_t first = 0, last = 0;
  Links found;
  Ends ends;
  Portion(std::size_t from, std::size_t to, Links links)
      : first(from), last(to), found(std::move(links)), ends(found.links, from, to) {}
};

class Network {
 public:
  Network(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls, const PeriodicCell& cell,
          const NetworkQuery& query, Team& team)
      : contacts_(contacts), balls_(balls), walls_(walls), cell_(cell), query_(query), team_(team) {
    // Rows in portions: the links of all balls at once would be the largest array of a run.
    portion_rows_ = std::max<std::size_t>(65536, balls.size() / 16);
  }
  NetworkBound bound();

 private:
  struct Worst {
    double h = 0;  ///< half the step; 0: no limit
    std::size_t row = 0;
  };
  template <class F>
  void each_portion(F f);
  double weight(const Link& link, int end, const std::vector<double>& weights) const;
  double extent(const Portion& portion, std::size_t row, const std::vector<double>& weights, bool doubled) const;
  double sweep(std::vector<double>& largest, const std::vector<double>& weights, bool doubled);
  Worst certify(const Portion& portion, const std::vector<double>& weights, double start) const;
  void blocks(const Portion& portion, std::size_t row, const std::vector<double>& weights, Block& stiffness,
              Block& damping) const;
  void name(const Portion& portion, const Worst& worst, const std::vector<double>& weights, StepBound& bound) const;
  std::vector<double> best_weights();
  std::vector<double> equal_weights();

  const Contacts& contacts_;
  const Balls& balls_;
  const std::vector<Wall>& walls_;
  const PeriodicCell& cell_;
  const NetworkQuery query_;
  Team& team_;
  std::size_t portion_rows_;
  std::unique_ptr<Portion> kept_;  ///< the only portion, where there is one
  NetworkBound out_;
  bool dashpots_ = false, looked_ = false;
  double h_ = 0;  ///< half the step that dashpots are seen with while weights are sought
};

template <class F>
void Network::each_portion(F f) {
  const bool single = balls_.size() <= portion_rows_;
  if (single && kept_) return f(*kept_);
  for (std::size_t first = 0; first < balls_.size(); first += portion_rows_) {
    const std::size_t last = std::min(balls_.size(), first + portion_rows_);
    auto portion = std::make_unique<Portion>(
        first, last, gather_links(contacts_, balls_, walls_, cell_, query_.links, first, last, team_));
    if (!looked_) {
      out_.impact = smaller(out_.impact, portion->found.impact);
      out_.kinematic = smaller(out_.kinematic, portion->found.kinematic);
      dashpots_ = dashpots_ || portion->found.dashpots;
      out_.links += portion->found.links.size();
    }
    f(*portion);
    if (single) kept_ = std::move(portion);
  }
  looked_ = true;
}

// How often an end counts: once where the other side does not move.
double Network::weight(const Link& link, int end, const std::vector<double>& weights) const {
  const uint32_t other = link.row[1 - end];
  if (other == no_row || balls_[Column::inverse_mass][other] == 0) return 1;
  const double mine = weights[link.row[end]], theirs = weights[other];
  return mine > 0 && theirs > 0 ? 1 + theirs / mine : 2;
}

// Largest eigenvalue of a row's block, dashpots as the springs they are to a step of 2 h.
double Network::extent(const Portion& portion, std::size_t row, const std::vector<double>& weights,
                       bool doubled) const {
  const double inverse = balls_[Column::inverse_mass][row], radius = balls_[Column::radius][row];
  if (inverse == 0) return 0;
  const double per_h = h_ > 0 ? 1 / h_ : 0.0;
  Block block = Block::Zero();
  const std::size_t at = row - portion.first;
  for (uint32_t k = portion.ends.begin[at]; k < portion.ends.begin[at + 1]; ++k) {
    const Link& link = portion.found.links[portion.ends.end[k] / 2];
    const int end = static_cast<int>(portion.ends.end[k] & 1u);
    add_end(block, link, end, link.kn + per_h * link.cn, link.ks + per_h * link.cs, link.kb, link.kt,
            (doubled ? weight(link, end, weights) : 1.0) * inverse, radius);
  }
  return nearly_largest(block);
}

// The largest eigenvalue of every row under these weights, and the largest of all.
double Network::sweep(std::vector<double>& largest, const std::vector<double>& weights, bool doubled) {
  double most = 0;
  each_portion([&](const Portion& portion) {
    const std::size_t rows = portion.last - portion.first;
    team_.each_block((rows + block_rows - 1) / block_rows, [&](std::size_t block) {
      const std::size_t begin = portion.first + block * block_rows;
      for (std::size_t row = begin; row < std::min(portion.last, begin + block_rows); ++row)
        largest[row] = extent(portion, row, weights, doubled);
    });
    for (std::size_t row = portion.first; row < portion.last; ++row) most = std::max(most, largest[row]);
  });
  return most;
}

// Weights that equalise the balls' eigenvalues: each sweep moves weight from those above to those below.
std::vector<double> Network::best_weights() {
  const std::size_t n = balls_.size();
  std::vector<double> largest(n), weights(n), best;
  const double single = sweep(largest, weights, false), factor = 1 + query_.local_damping;
  if (!(single > 0)) return {};
  for (std::size_t row = 0; row < n; ++row) weights[row] = std::sqrt(largest[row] / single);
  if (dashpots_) h_ = 1 / std::sqrt(2 * single * factor);
  double held = 0, earlier = 0;
  for (unsigned k = 0; k < std::max(1u, query_.sweeps); ++k) {
    const double most = sweep(largest, weights, true), root = 1 / std::sqrt(most * factor);
    // Seen with h, dashpots allow at least this: they weigh more in a shorter step, but no more than in proportion.
    const double allowed = !dashpots_ || root >= h_ ? root : root * root / h_;
    out_.sweeps = k + 1;
    if (allowed > held) {
      held = allowed;
      best = weights;
    }
    if (k % 2 == 0) {
      if (k > 0 && held < earlier * (1 + worthwhile)) break;
      earlier = held;
    }
    if (dashpots_) h_ = root;
    for (std::size_t row = 0; row < n; ++row)
      if (largest[row] > 0) weights[row] = std::max(least_weight, weights[row] * std::sqrt(largest[row] / most));
  }
  h_ = 0;
  // A little more than the largest of all: the blocks are then looked at one by one.
  out_.network.step = 2 * (dashpots_ ? 1 / std::sqrt(single * factor) : held * (1 + 1e-3));
  return best;
}

// The same weight for all: one look at the contacts, for estimates that follow each other closely.
std::vector<double> Network::equal_weights() {
  double stiffest = 0;
  each_portion([&](const Portion& portion) {
    for (const Link& link : portion.found.links)
      for (const uint32_t row : link.row)
        if (row != no_row)
          stiffest = std::max(stiffest, std::max(link.kn, link.ks) * balls_[Column::inverse_mass][row]);
  });
  if (!(stiffest > 0)) return best_weights();
  // A single spring moves a ball at least this fast, so the limit lies below.
  out_.network.step = 2 / std::sqrt(stiffest * (1 + query_.local_damping)) * (1 + 1e-3);
  out_.network.open = query_.enough > 0 && query_.enough < out_.network.step;
  if (out_.network.open) out_.network.step = query_.enough;
  return std::vector<double>(balls_.size(), 1.0);
}

void Network::blocks(const Portion& portion, std::size_t row, const std::vector<double>& weights, Block& stiffness,
                     Block& damping) const {
  const double inverse = balls_[Column::inverse_mass][row], radius = balls_[Column::radius][row];
  stiffness.setZero();
  damping.setZero();
  const std::size_t at = row - portion.first;
  for (uint32_t k = portion.ends.begin[at]; k < portion.ends.begin[at + 1]; ++k) {
    const Link& link = portion.found.links[portion.ends.end[k] / 2];
    const int end = static_cast<int>(portion.ends.end[k] & 1u);
    const double times = weight(link, end, weights) * inverse;
    add_end(stiffness, link, end, link.kn, link.ks, link.kb, link.kt, times, radius);
    if (dashpots_) add_end(damping, link, end, link.cn, link.cs, 0, 0, times, radius);
  }
}

// The largest h that every block of the portion allows, below `start`: a Cholesky test spares the eigenvalues of all
// but a few.
Network::Worst Network::certify(const Portion& portion, const std::vector<double>& weights, double start) const {
  const double limit = 1 / (1 + query_.local_damping);
  const std::size_t rows = portion.last - portion.first, parts = (rows + block_rows - 1) / block_rows;
  std::vector<Worst> worst(parts);
  team_.each_block(parts, [&](std::size_t part) {
    double h = start;
    Block stiffness, damping;
    const std::size_t begin = portion.first + part * block_rows;
    for (std::size_t row = begin; row < std::min(portion.last, begin + block_rows); ++row) {
      const std::size_t at = row - portion.first;
      if (balls_[Column::inverse_mass][row] == 0 || portion.ends.begin[at] == portion.ends.begin[at + 1]) continue;
      blocks(portion, row, weights, stiffness, damping);
      if (stable(stiffness, damping, h, limit)) continue;
      h = largest_stable(stiffness, damping, h, limit);
      worst[part] = {h, row};
    }
  });
  Worst all;
  for (const Worst& one : worst)
    if (one.h > 0 && (all.h == 0 || one.h < all.h)) all = one;
  return all;
}

void Network::name(const Portion& portion, const Worst& worst, const std::vector<double>& weights,
                   StepBound& bound) const {
  Block stiffness, damping;
  blocks(portion, worst.row, weights, stiffness, damping);
  const double limit = 1 / (1 + query_.local_damping);
  // Would its springs alone allow a ninth more?
  bound.term = dashpots_ && stable(stiffness, Block::Zero(), worst.h / 0.9, limit) ? "damping" : "network";
  bound.ball = balls_.id()[worst.row];
  bound.other = 0;
  bound.wall.clear();
  double most = 0;
  const std::size_t at = worst.row - portion.first;
  for (uint32_t k = portion.ends.begin[at]; k < portion.ends.begin[at + 1]; ++k) {
    const Link& link = portion.found.links[portion.ends.end[k] / 2];
    const int end = static_cast<int>(portion.ends.end[k] & 1u);
    const double size = weight(link, end, weights) * (link.kn + 2 * link.ks);
    if (size <= most) continue;
    most = size;
    const uint32_t other = link.row[1 - end];
    bound.other = other == no_row ? 0 : balls_.id()[other];
    bound.wall = other == no_row ? walls_[link.wall].name : "";
  }
}

NetworkBound Network::bound() {
  const std::vector<double> weights = query_.sweeps == 0 ? equal_weights() : best_weights();
  if (weights.empty()) return out_;
  StepBound& bound = out_.network;
  const double start = 0.5 * bound.step;
  Worst all;
  bound.term = "network";
  each_portion([&](const Portion& portion) {
    const Worst worst = certify(portion, weights, start);
    if (!(worst.h > 0) || (all.h > 0 && all.h <= worst.h)) return;
    all = worst;
    name(portion, worst, weights, bound);
  });
  const double h = all.h > 0 ? all.h : start;
  bound.open = bound.open && !(all.h > 0);
  bound.step = 2 * h * (1 - rounding);
  return out_;
}

}  // namespace

NetworkBound network_bound(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                           const PeriodicCell& cell, const NetworkQuery& query, Team& team) {
  return Network(contacts, balls, walls, cell, query, team).bound();
}

}  // namespace scree::core
