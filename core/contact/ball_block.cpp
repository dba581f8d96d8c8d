#include "core/contact/ball_block.hpp"

#include <algorithm>
#include <cmath>

namespace scree::core {

void add_end(Block& b, const Link& link, int end, double kn, double ks, double kb, double kt, double weight_per_mass,
             double radius) {
  const double sign = end == 0 ? 1.0 : -1.0, arm = link.arm[end];
  const double n[3] = {sign * link.normal[0], sign * link.normal[1], sign * link.normal[2]};
  const double along = weight_per_mass * (kn - ks), across = weight_per_mass * ks;
  const double per_inertia = weight_per_mass * 2.5 / (radius * radius);
  const double turn = per_inertia * (ks * arm * arm + kb), twist = per_inertia * kt - turn;
  // Shear motion of the surface is across u + rotation x (arm n).
  const double mixed = weight_per_mass * std::sqrt(2.5) / radius * ks * arm;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c <= r; ++c) {
      const double nn = n[r] * n[c];
      b(r, c) += along * nn;
      b(3 + r, 3 + c) += twist * nn;
    }
    b(r, r) += across;
    b(3 + r, 3 + r) += turn;
  }
  b(3, 1) -= mixed * n[2];
  b(3, 2) += mixed * n[1];
  b(4, 0) += mixed * n[2];
  b(4, 2) -= mixed * n[0];
  b(5, 0) -= mixed * n[1];
  b(5, 1) += mixed * n[0];
}

double nearly_largest(const Block& block) {
  const double trace = block.trace();
  if (!(trace > 0)) return 0;
  Block b = block.selfadjointView<Eigen::Lower>();
  b /= trace;
  Block power = b * b;
  power = (power * power).eval();
  Eigen::Index most = 0;
  power.diagonal().maxCoeff(&most);
  Eigen::Matrix<double, 6, 1> w = power.col(most);
  w /= w.cwiseAbs().maxCoeff();
  w = (power * w).eval();
  return trace * w.dot(b * w) / w.squaredNorm();
}

bool stable(const Block& stiffness, const Block& damping, double h, double limit) {
  Block rest = -(h * h) * stiffness - h * damping;
  rest.diagonal().array() += limit;
  // Cholesky without roots: positive pivots tell.
  for (int c = 0; c < 6; ++c) {
    const double pivot = rest(c, c);
    if (!(pivot > 0)) return false;
    for (int r = c + 1; r < 6; ++r) {
      const double factor = rest(r, c) / pivot;
      for (int q = r; q < 6; ++q) rest(q, r) -= factor * rest(q, c);
    }
  }
  return true;
}

double largest_stable(const Block& stiffness, const Block& damping, double high, double limit) {
  double h = high;
  // Each root is that of one direction, so it lies above the one sought, and the next direction is a better one.
  for (int again = 0; again < 60; ++again) {
    const Block both = h * h * stiffness + h * damping;
    const Eigen::SelfAdjointEigenSolver<Block> solver(both);
    const Eigen::Matrix<double, 6, 1> w = solver.eigenvectors().col(5);
    const double k = w.dot(stiffness.selfadjointView<Eigen::Lower>() * w),
                 c = std::max(0.0, w.dot(damping.selfadjointView<Eigen::Lower>() * w));
    // Written without the cancellation of -c + sqrt(c^2 + 4 k limit).
    const double root = 2 * limit / (c + std::sqrt(c * c + 4 * k * limit));
    if (!(root < h * (1 - 1e-14))) return std::min(root, h);
    h = root;
  }
  return h;
}

}  // namespace scree::core
