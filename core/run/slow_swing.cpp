#include "core/run/slow_swing.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/contact/links.hpp"

namespace scree::core {

namespace {

constexpr std::size_t long_enough = 100;  ///< bonds from end to end: a shorter body swings in far less than 1e6 cycles
constexpr double slow = 1e6, endless = 1e10;  ///< cycles in a swing; beyond the second it is rounding of a mechanism
constexpr int powers = 5, bending = 2 * powers, fields = bending + 2;

using Vector = Eigen::Vector3d;
using Motion = Eigen::Matrix<double, 6, fields>;  ///< of one ball in each field: displacement, rotation
using Square = Eigen::Matrix<double, fields, fields>;

struct Bond {
  uint32_t end[2];
  Vector away;  ///< from the first to the second, m
};

std::vector<Bond> intact(const Engine& engine) {
  const ImageShifts shifts(engine.cell);
  const Balls& b = engine.balls;
  std::vector<Bond> out;
  for (const TouchList& list : engine.contacts.lists()) {
    if (!list.bonded || list.begin.size() != b.size() + 1) continue;
    for (std::size_t row = 0; row < b.size(); ++row)
      for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
        if (list.broken[slot] != 0) continue;
        const uint32_t other = list.other[slot];
        const double* shift = shifts.of[target::image(list.where[slot])];
        out.push_back(
            {{static_cast<uint32_t>(row), other},
             {b[Column::x][other] - b[Column::x][row] + shift[0], b[Column::y][other] - b[Column::y][row] + shift[1],
              b[Column::z][other] - b[Column::z][row] + shift[2]}});
      }
  }
  return out;
}

/// The balls that bonds join to one, outwards from it: rows in the order of their distance in bonds, and places in
/// which no bond jumps across a periodic cell.
struct Body {
  std::vector<uint32_t> rows;
  std::vector<Vector> place;  ///< by rows
  std::size_t length = 0;     ///< bonds to the farthest
  bool closed = false;        ///< round a periodic cell
};

class Network {
 public:
  Network(const std::vector<Bond>& bonds, std::size_t rows) : bonds_(bonds), begin_(rows + 1), level_(rows, none) {
    for (const Bond& bond : bonds)
      for (const uint32_t row : bond.end) ++begin_[row + 1];
    for (std::size_t row = 0; row < rows; ++row) begin_[row + 1] += begin_[row];
    end_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t k = 0; k < bonds.size(); ++k)
      for (uint32_t side = 0; side < 2; ++side) end_[next[bonds[k].end[side]]++] = static_cast<uint32_t>(2 * k + side);
    where_.resize(rows);
  }
  bool alone(std::size_t row) const { return begin_[row] == begin_[row + 1]; }
  bool seen(std::size_t row) const { return level_[row] != none; }
  Body around(uint32_t start);

 private:
  static constexpr uint32_t none = ~0u;
  const std::vector<Bond>& bonds_;
  std::vector<std::size_t> begin_;
  std::vector<uint32_t> end_, level_, where_;  ///< 2 * bond + side; distance in bonds; place in the body
};

Body Network::around(uint32_t start) {
  Body body;
  std::vector<uint32_t>& rows = body.rows;
  rows.push_back(start);
  body.place.push_back(Vector::Zero());
  where_[start] = 0;
  // A body that was walked before is walked anew: what is in this walk has its own number there.
  const auto here = [&](uint32_t row) { return where_[row] < rows.size() && rows[where_[row]] == row; };
  level_[start] = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const uint32_t row = rows[k];
    for (std::size_t e = begin_[row]; e < begin_[row + 1]; ++e) {
      const Bond& bond = bonds_[end_[e] / 2];
      const uint32_t side = end_[e] & 1u, other = bond.end[1 - side];
      const Vector place = body.place[k] + (side == 0 ? bond.away : Vector(-bond.away));
      if (here(other)) {
        body.closed = body.closed || (body.place[where_[other]] - place).norm() > 0.5 * bond.away.norm();
        continue;
      }
      where_[other] = static_cast<uint32_t>(rows.size());
      level_[other] = level_[row] + 1;
      rows.push_back(other);
      body.place.push_back(place);
    }
  }
  body.length = level_[rows.back()];
  return body;
}

/// The longest way through a body begins near the ball that is farthest from any other (exactly so in a tree).
std::vector<Body> long_bodies(const std::vector<Bond>& bonds, std::size_t rows) {
  Network network(bonds, rows);
  std::vector<Body> out;
  for (std::size_t row = 0; row < rows; ++row) {
    if (network.alone(row) || network.seen(row)) continue;
    const uint32_t end = network.around(static_cast<uint32_t>(row)).rows.back();
    Body body = network.around(end);
    if (body.length >= long_enough && !body.closed) out.push_back(std::move(body));
  }
  return out;
}

/// Motions in which every section across the longest axis stays rigid and turns with the axis: s^0 to s^4 along each of
/// two directions, and the body's shift along the axis and turn about it, so that all rigid motions are among them.
class Sections {
 public:
  explicit Sections(const Body& body) {
    centre_.setZero();
    for (const Vector& at : body.place) centre_ += at / static_cast<double>(body.place.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector& at : body.place) spread += (at - centre_) * (at - centre_).transpose();
    axes_ = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
    for (const Vector& at : body.place) half_ = std::max(half_, std::abs((at - centre_).dot(axes_.col(2))));
  }
  Motion motion(const Vector& at) const {
    const Vector x = at - centre_, axis = axes_.col(2);
    const double s = x.dot(axis) / half_;
    Motion out;
    for (int direction = 0; direction < 2; ++direction) {
      const Vector aside = axes_.col(direction);
      double power = 1, below = 0;
      for (int p = 0; p < powers; ++p) {
        const double slope = p * below / half_;
        out.col(direction * powers + p) << power * aside - slope * x.dot(aside) * axis, slope * axis.cross(aside);
        below = power;
        power *= s;
      }
    }
    out.col(bending) << axis, Vector::Zero();
    out.col(bending + 1) << axis.cross(x) / half_, axis / half_;
    return out;
  }
  static constexpr std::array<int, 6> rigid{0, 1, powers, powers + 1, bending, bending + 1};

 private:
  Vector centre_;
  Eigen::Matrix3d axes_;
  double half_ = 0;
};

/// Masses and springs of a body in its fields, and what its fields may not do.
class Swing {
 public:
  Swing(const Engine& engine, const Body& body) : balls_(engine.balls), of_row_(balls_.size(), none) {
    const Sections sections(body);
    for (std::size_t k = 0; k < body.rows.size(); ++k) {
      const uint32_t row = body.rows[k];
      of_row_[row] = static_cast<uint32_t>(k);
      motion_.push_back(sections.motion(body.place[k]));
      const double mass = balls_[Column::mass][row], r = balls_[Column::radius][row];
      const Motion& f = motion_.back();
      masses_ += mass * f.topRows<3>().transpose() * f.topRows<3>() +
                 0.4 * mass * r * r * f.bottomRows<3>().transpose() * f.bottomRows<3>();
      const uint8_t bits = balls_.fixed() != nullptr ? balls_.fixed()[row] : uint8_t{0};
      for (int c = 0; c < 6; ++c)
        if ((bits >> c & 1u) != 0) forbid(f.row(c));
    }
  }
  void add(const Link& link) {
    const bool first = holds(link.row[0]), second = holds(link.row[1]);
    if (!first && !second) return;
    held_ = held_ || !first || !second;
    const Vector n(link.normal[0], link.normal[1], link.normal[2]);
    Eigen::Matrix3d across;  // across * rotation = rotation x n
    across << 0, n[2], -n[1], -n[2], 0, n[0], n[1], -n[0], 0;
    Motion apart = Motion::Zero();
    if (second) apart += carried(link.row[1], -link.arm[1] * across);
    if (first) apart -= carried(link.row[0], link.arm[0] * across);
    const Eigen::Matrix<double, 1, fields> along = n.transpose() * apart.topRows<3>(),
                                           about = n.transpose() * apart.bottomRows<3>();
    springs_ += link.ks * apart.topRows<3>().transpose() * apart.topRows<3>() +
                (link.kn - link.ks) * along.transpose() * along +
                link.kb * apart.bottomRows<3>().transpose() * apart.bottomRows<3>() +
                (link.kt - link.kb) * about.transpose() * about;
  }
  double square();

 private:
  static constexpr uint32_t none = ~0u;
  bool holds(uint32_t row) const { return row != no_row && of_row_[row] != none; }
  /// Of the surface at the contact point, and of the ball's rotation.
  Motion carried(uint32_t row, const Eigen::Matrix3d& lever) const {
    Motion out = motion_[of_row_[row]];
    out.topRows<3>() += lever * out.bottomRows<3>();
    return out;
  }
  void forbid(const Eigen::Matrix<double, 1, fields>& row) {
    Eigen::Matrix<double, fields + 1, fields> all;
    all << forbidden_, row;
    forbidden_ = Eigen::HouseholderQR<decltype(all)>(all).matrixQR().topRows<fields>().triangularView<Eigen::Upper>();
    held_ = true;
  }

  const Balls& balls_;
  std::vector<uint32_t> of_row_;
  std::vector<Motion> motion_;
  Square masses_ = Square::Zero(), springs_ = Square::Zero(), forbidden_ = Square::Zero();
  bool held_ = false;
};

double Swing::square() {
  // What is free must not move as a whole: it is orthogonal to all rigid motions.
  if (!held_)
    for (const int rigid : Sections::rigid) forbid(masses_.row(rigid) / masses_(rigid, rigid));
  const Eigen::JacobiSVD<Square> svd(forbidden_, Eigen::ComputeFullV);
  const auto& sizes = svd.singularValues();
  const Eigen::Index rank = (sizes.array() > 1e-12 * sizes[0]).count();
  if (rank == fields) return 0;
  const Eigen::MatrixXd allowed = svd.matrixV().rightCols(fields - rank);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> values(
      allowed.transpose() * springs_ * allowed, allowed.transpose() * masses_ * allowed, Eigen::EigenvaluesOnly);
  return values.info() == Eigen::Success ? std::max(0.0, values.eigenvalues()[0]) : 0.0;
}

}  // namespace

SlowSwing slow_swing(Engine& engine) {
  SlowSwing out;
  if (!engine.contacts.built() || engine.clock.dt == 0) return out;
  const std::vector<Body> bodies = long_bodies(intact(engine), engine.balls.size());
  if (bodies.empty()) return out;
  const Links all =
      gather_links(engine.contacts, engine.balls, engine.walls, engine.cell, {}, 0, engine.balls.size(), engine.team);
  for (const Body& body : bodies) {
    Swing swing(engine, body);
    for (const Link& link : all.links) swing.add(link);
    const double square = swing.square(), cycles = 2 * std::numbers::pi / std::sqrt(square) / engine.clock.dt;
    if (!(cycles < endless) || (out.square > 0 && square >= out.square)) continue;
    out = {square, body.rows.size(), body.length, engine.balls.id()[body.rows.front()]};
  }
  return out;
}

std::string slow_bonds(Engine& engine) {
  const SlowSwing swing = slow_swing(engine);
  if (swing.square == 0) return "";
  const double cycles = 2 * std::numbers::pi / std::sqrt(swing.square) / engine.clock.dt;
  if (!(cycles > slow)) return "";
  return fmt::format(
      "the body of {} bonded balls that ends at ball {} is {} bonds long, and its slowest swing takes at least {:.2g} "
      "cycles: to come to rest takes several swings, so give it fewer and larger balls along its length, or judge it "
      "before it rests",
      swing.balls, swing.id, swing.length, cycles);
}

}  // namespace scree::core
