#pragma once
// Random networks of few balls, and their critical step without any knowledge of how the bound is made: the stiffness
// matrix is read off the forces after one cycle of a small prescribed motion.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/philox.hpp"
#include "core/contact/links.hpp"
#include "stability/lab.hpp"

namespace networks {

using namespace scree::core;

constexpr double overlap = 1e-6;  ///< of the radius: little enough for loads to add no stiffness of their own

struct Spec {
  std::string scene;
  std::size_t balls = 0;
};

/// Network `index`: two to six balls of 5 to 15 mm, each touching one or two that were there before, perhaps on a
/// floor. Every pair has a stiffness of its own, over twelve decades where `decades` says so, and shear between none
/// and 1.5. With bonds each pair of balls has a cement disc of its own size and stiffness too, sometimes alone; with a
/// glued floor so have those of a ball on the floor.
class Maker {
 public:
  Maker(uint64_t index, double decades, bool bonds, bool glued_floor = false)
      : random_(64, "networks"), index_(index), decades_(decades), bonds_(bonds), glued_floor_(glued_floor) {}

  Spec make(const TemporaryFolder& folder) {
    const std::size_t n = 2 + static_cast<std::size_t>(draw() * 5);
    const bool floor = draw() < 0.5;
    for (std::size_t k = 0; k < n; ++k) place(floor);
    std::string balls, rules, glue;
    for (std::size_t k = 0; k < at_.size(); ++k) {
      const std::string name = "b" + std::to_string(k), file = name + ".csv";
      write_text(folder / file, "x,y,z,radius\n" + digits(at_[k][0]) + "," + digits(at_[k][1]) + "," +
                                    digits(at_[k][2]) + "," + digits(radius_[k]) + "\n");
      balls += "  " + name + ": {generator: file, path: " + file + ", density: " + digits(500 + 8000 * draw()) + "}\n";
      for (std::size_t j = 0; j < k; ++j) {
        const std::string other = "b" + std::to_string(j);
        rules += bonds_ ? bonded_rule(name, other) : rule(name, other);
        if (bonds_) glue += (glue.empty() ? "" : ", ") + ("bond: {rule: " + name + "_" + other + "}");
      }
      if (floor) rules += glued_floor_ ? bonded_rule(name, "floor") : rule(name, "floor");
      if (floor && glued_floor_) glue += (glue.empty() ? "" : ", ") + ("bond: {rule: " + name + "_floor}");
    }
    return {"scree: 1\n" +
                std::string(floor ? "walls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n" : "") +
                "balls:\n" + balls + "contacts:\n" + rules +
                "  - {name: itself, between: [balls, balls], model: none}\n" + "stages:\n  - go: [" +
                (glue.empty() ? "cycle: 1" : glue) + "]\n",
            at_.size()};
  }

 private:
  double draw() { return random_.uniform(index_, next_++); }
  static std::string digits(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
  }
  std::string rule(const std::string& a, const std::string& b) {
    const double kn = 1e6 * std::pow(10.0, decades_ * (draw() - 0.5)), ratio = draw() < 0.3 ? 0.0 : 1.5 * draw();
    return "  - {name: " + a + "_" + b + ", between: [" + a + ", " + b + "], model: linear, kn: " + digits(kn) +
           ", ks: " + digits(kn * ratio) + ", fric: 1e9}\n";
  }
  std::string bonded_rule(const std::string& a, const std::string& b) {
    const auto stiffness = [&] { return 1e6 * std::pow(10.0, decades_ * (draw() - 0.5)); };
    const double kn = draw() < 0.2 ? 0.0 : stiffness(), ratio = draw() < 0.3 ? 0.0 : 1.5 * draw();
    const double disc = stiffness() / (3.14 * 1e-4), bond_ratio = draw() < 0.2 ? 0.0 : 1.5 * draw();
    return "  - {name: " + a + "_" + b + ", between: [" + a + ", " + b + "], model: parallel_bond, kn: " + digits(kn) +
           ", ks: " + digits(kn * ratio) + ", fric: 1e9, pb_kn: " + digits(disc) +
           ", pb_ks: " + digits(disc * bond_ratio) + ", pb_rmul: " + digits(0.2 + 1.3 * draw()) +
           ", pb_ten: .inf, pb_coh: .inf}\n";
  }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v;
    do v = {2 * draw() - 1, 2 * draw() - 1, 2 * draw() - 1};
    while (v.norm() > 1 || v.norm() < 0.1);
    return v.normalized();
  }
  bool fits(const Eigen::Vector3d& x, double r, bool floor) const {
    if (floor && x[2] < r * (1 - 1.01 * overlap)) return false;
    for (std::size_t j = 0; j < at_.size(); ++j)
      if ((x - at_[j]).norm() < r + radius_[j] - 1.01 * overlap * std::min(r, radius_[j])) return false;
    return true;
  }
  // On the sphere around one ball, or on the circle around two; also on the floor where that can be.
  Eigen::Vector3d proposal(double r) {
    const auto pick = [&] { return static_cast<std::size_t>(draw() * static_cast<double>(at_.size())); };
    const std::size_t a = pick(), b = pick();
    const auto reach = [&](std::size_t j) { return r + radius_[j] - overlap * std::min(r, radius_[j]); };
    const Eigen::Vector3d free = at_[a] + reach(a) * direction();
    const Eigen::Vector3d axis = at_[b] - at_[a];
    const double d = axis.norm(), ra = reach(a), rb = reach(b);
    if (a == b || d >= ra + rb || draw() < 0.3) return free;
    const double along = (ra * ra - rb * rb + d * d) / (2 * d), square = ra * ra - along * along;
    if (square <= 0) return free;
    const Eigen::Vector3d across = axis.cross(direction()).normalized();
    return at_[a] + along * axis / d + std::sqrt(square) * across;
  }
  void place(bool floor) {
    const double r = 0.005 + 0.01 * draw();
    for (int again = 0; again < 200; ++again) {
      Eigen::Vector3d x(0, 0, floor ? r * (1 - overlap) : 0);
      if (!at_.empty()) x = proposal(r);
      if (!fits(x, r, floor)) continue;
      at_.push_back(x);
      radius_.push_back(r);
      return;
    }
  }
  const Random random_;
  const uint64_t index_;
  const double decades_;
  const bool bonds_, glued_floor_;
  uint64_t next_ = 0;
  std::vector<Eigen::Vector3d> at_;
  std::vector<double> radius_;
};

/// Critical step of the scene as it stands: each free direction of each ball is moved a little in one short cycle.
inline double true_limit(Simulation& simulation, double step) {
  Engine& engine = simulation.engine;
  Balls& balls = engine.balls;
  engine.step.fixed = step;
  engine.clock.change_step(step);
  const std::size_t n = balls.size(), m = 6 * n;
  const bool spin = balls.has(Column::wx);
  const auto column = [&](std::size_t dof) {
    const std::size_t first = static_cast<std::size_t>(dof % 6 < 3 ? Column::vx : Column::wx);
    return balls[static_cast<Column>(first + dof % 3)];
  };
  Balls start = balls;
  const auto respond = [&](std::size_t dof, double speed) {
    balls = start;
    for (const Column c : {Column::vx, Column::vy, Column::vz, Column::wx, Column::wy, Column::wz})
      if (balls.has(c)) std::fill_n(balls[c], n, 0.0);
    if (dof < m) column(dof)[dof / 6] = speed;
    engine.contacts.forget();
    engine.clock.dt_back = engine.clock.dt_law = 0;
    engine.forces_outdated();
    for (std::size_t rule = 0; rule < engine.contacts.book.rules.size(); ++rule)
      if (engine.contacts.book.rules[rule].can_bond()) engine.bond({static_cast<uint16_t>(rule), 0, true, {}}, false);
    engine.advance();
    engine.forces();
    Slices& slices = engine.contacts.slices();
    for (std::size_t block = 0; block < slices.blocks(); ++block) slices.fold(block);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(m));
    for (std::size_t row = 0; row < n; ++row)
      for (std::size_t c = 0; c < (spin ? 6 : 3); ++c)
        force[static_cast<Eigen::Index>(6 * row + c)] = slices.record(row)[c];
    return force;
  };
  const auto unit = [&](std::size_t dof) {
    const double mass = balls[Column::mass][dof / 6], r = balls[Column::radius][dof / 6];
    return dof % 6 < 3 ? 1 / std::sqrt(mass) : 1 / std::sqrt(0.4 * mass * r * r);
  };
  const Eigen::VectorXd still = respond(m, 0);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(m));
  for (std::size_t dof = 0; dof < m; ++dof) {
    if (dof % 6 >= 3 && !spin) continue;
    const double way = 1e-3 * overlap * (dof % 6 < 3 ? 0.005 : 1.0);
    const Eigen::VectorXd change = (still - respond(dof, way / step)) / way;
    for (std::size_t other = 0; other < m; ++other)
      k(static_cast<Eigen::Index>(other), static_cast<Eigen::Index>(dof)) =
          change[static_cast<Eigen::Index>(other)] * unit(other) * unit(dof);
  }
  const Eigen::MatrixXd even = 0.5 * (k + k.transpose());
  return 2 / std::sqrt(
                 Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(even, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

/// Translation and rotation of all balls, or what resists them: forces and moments.
struct Motion {
  std::vector<Eigen::Vector3d> u, w;
  explicit Motion(std::size_t n) : u(n, Eigen::Vector3d::Zero()), w(n, Eigen::Vector3d::Zero()) {}
};

inline Motion resistance(const Links& all, const Motion& m) {
  Motion f(m.u.size());
  for (const Link& link : all.links) {
    const std::size_t i = link.row[0], j = link.row[1];
    const Eigen::Vector3d normal(link.normal[0], link.normal[1], link.normal[2]);
    const Eigen::Vector3d slip = m.u[j] - m.u[i] - (link.arm[0] * m.w[i] + link.arm[1] * m.w[j]).cross(normal);
    const double along = slip.dot(normal);
    const Eigen::Vector3d force = link.kn * along * normal + link.ks * (slip - along * normal);
    const Eigen::Vector3d turn = m.w[j] - m.w[i];
    const Eigen::Vector3d moment = link.kb * turn + (link.kt - link.kb) * turn.dot(normal) * normal;
    f.u[i] -= force;
    f.u[j] += force;
    f.w[i] -= link.arm[0] * normal.cross(force) + moment;
    f.w[j] -= link.arm[1] * normal.cross(force) - moment;
  }
  return f;
}

/// Critical step of links between balls by powers of their operator: its quotient lies below the largest eigenvalue, so
/// the step lies above the critical one, and nears it.
inline double limit_by_powers(const Balls& balls, const Links& all) {
  const std::size_t n = balls.size();
  Motion m(n);
  const Random random(1, "start");
  for (std::size_t k = 0; k < n; ++k)
    for (int c = 0; c < 3; ++c) {
      m.u[k][c] = random.normal(k, static_cast<uint64_t>(c));
      m.w[k][c] = random.normal(k, static_cast<uint64_t>(3 + c));
    }
  const double *mass = balls[Column::mass], *radius = balls[Column::radius];
  double largest = 0;
  for (int again = 0; again < 400; ++again) {
    Motion f = resistance(all, m);
    double above = 0, below = 0, size = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double inertia = 0.4 * mass[k] * radius[k] * radius[k];
      above += m.u[k].dot(f.u[k]) + m.w[k].dot(f.w[k]);
      below += mass[k] * m.u[k].squaredNorm() + inertia * m.w[k].squaredNorm();
      f.u[k] /= mass[k];
      f.w[k] /= inertia;
      size = std::max({size, f.u[k].norm(), radius[k] * f.w[k].norm()});
    }
    largest = above / below;
    for (std::size_t k = 0; k < n; ++k) {
      m.u[k] = f.u[k] / size;
      m.w[k] = f.w[k] / size;
    }
  }
  return 2 / std::sqrt(largest);
}

}  // namespace networks
