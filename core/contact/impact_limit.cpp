#include "core/contact/impact_limit.hpp"

#include <algorithm>

namespace scree::core {

namespace {

/// The way into one collision, in trapezoids over depth.
struct Way {
  double depth = 0, stiffness = 0, force = 0, work = 0;
};

// Advances to a depth with the stiffness there; true when the work has reached `energy`, and then at its peak.
bool advance(Way& way, double depth, double stiffness, double energy) {
  const double h = depth - way.depth;
  const double force = way.force + 0.5 * h * (way.stiffness + stiffness);
  const double work = way.work + 0.5 * h * (way.force + force);
  if (work >= energy && work > way.work) {
    way.stiffness += (stiffness - way.stiffness) * (energy - way.work) / (work - way.work);
    return true;
  }
  way = {depth, stiffness, force, work};
  return false;
}

}  // namespace

void peak_stiffness(const BoundRule& rule, uint32_t n, const double* v, const Tangents& now, Scratch& s, double* peak) {
  std::copy_n(now.normal, n, peak);
  if ((rule.model->flags & SCREE_NONLINEAR) == 0) return;
  double gaps[Scratch::size];
  std::copy_n(s.gap, n, gaps);
  Way way[Scratch::size];
  bool done[Scratch::size] = {};
  Tangents then;
  // From 1e-9 of the radius to all of it: four points to a factor of two.
  constexpr int points = 120;
  constexpr double factor = 1.189207115002721;
  double share = 1e-9;
  for (int p = 0; p <= points; ++p, share *= factor) {
    bool all = true;
    for (uint32_t k = 0; k < n; ++k) s.gap[k] = -share * s.r1[k];
    tangents(rule, n, false, s, then);
    for (uint32_t k = 0; k < n; ++k) {
      if (!done[k]) done[k] = advance(way[k], share * s.r1[k], then.normal[k], 0.5 * s.mass[k] * v[k] * v[k]);
      all = all && done[k];
    }
    if (all) break;
  }
  for (uint32_t k = 0; k < n; ++k) peak[k] = std::max(peak[k], way[k].stiffness);
  std::copy_n(gaps, n, s.gap);
}

}  // namespace scree::core
