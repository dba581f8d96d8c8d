// One sound law and many that are wrong in one way each, all in one library. What is wrong is the template argument.
#include <scree/contact_model.hpp>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace {
using namespace scree;

enum Defect {
  none,
  asymmetric,
  lab_axis,
  not_turned,
  understated,
  overstated,
  soft_unloading,
  jump,
  counts,
  allocates,
  zero_over_zero,
  neighbour,
  wrong_energy,
  gives_friction,
  throws,
  crashes,
  endless,
  denormals_off,
  swallows_nan,
  short_reach,
  hidden_dashpot,
  other_normal,
  derives_again,
};

// The real crash, not the word of a sanitizer about it.
__attribute__((noinline, no_sanitize("undefined"))) void crash(double value) {
  volatile double* volatile nowhere = nullptr;
  *nowhere = value;
}

/// Springs, a dashpot and Coulomb slip.
template <Defect wrong>
struct Springs {
  double kn, ks, fric, dp_nratio;

  static void describe(Properties<Springs>& p) {
    p.number("kn", &Springs::kn, "N/m", "normal stiffness").above(0).mix(series);
    p.number("ks", &Springs::ks, "N/m", "shear stiffness").at_least(0).mix(series);
    p.number("fric", &Springs::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
    p.number("dp_nratio", &Springs::dp_nratio, "1", "share of critical damping").at_least(0).fallback(0);
  }
  struct State {
    Vec3 shear;
  };
  static inline double memory = 0;

  void side_effects(const Contact& c) const {
    if constexpr (wrong == counts) memory += 1;
    if constexpr (wrong == allocates) {
      void* volatile block = std::malloc(64);
      std::free(block);
    }
    if constexpr (wrong == throws)
      if (c.gap < -0.5 * c.r1) throw std::runtime_error("too deep");
    if constexpr (wrong == crashes)
      if (c.gap < -0.5 * c.r1) crash(c.gap);
    if constexpr (wrong == endless) {
      volatile double gap = c.gap;
      while (gap < -0.5 * c.r1) gap = gap * 1.0;
    }
#if defined(__SSE__)
    if constexpr (wrong == denormals_off) _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
  }

  double spring(const NormalContact& c) const {
    if constexpr (wrong == swallows_nan)
      return std::max(0.0, -kn * c.gap);
    else if constexpr (wrong == jump)
      return c.gap < 0 ? kn * (1e-6 - c.gap) : 0.0;
    else if constexpr (wrong == short_reach)
      return kn * (1e-6 - c.gap);
    else
      return max(0.0, -kn * c.gap);
  }

  void law(const Contact& c, State& s, Response& r) const {
    side_effects(c);
    const double elastic = spring(c);
    double fn = max(0.0, elastic - c.dashpot(dp_nratio, kn) * c.opening());
    if constexpr (wrong == asymmetric) fn *= 1 + 0.01 * (c.r1 - c.r2) / (c.r1 + c.r2);
    if constexpr (wrong == lab_axis) fn *= 1 + 0.01 * c.normal.z * c.normal.z;
    if constexpr (wrong == neighbour) {
      const double other = memory;
      memory = fn;
      fn += 1e-9 * other;
    }
    const Vec3 before = wrong == not_turned ? s.shear : c.turned(s.shear), slip = c.slip();
    const bool unloading = wrong == soft_unloading && before.dot(slip) > 0;
    const Vec3 trial = before - (unloading ? 0.5 * ks : ks) * slip;
    const double size = trial.norm(), limit = fric * elastic;
    if constexpr (wrong == zero_over_zero)
      s.shear = (std::min(size, limit) / size) * trial;
    else
      s.shear = (size > limit ? limit / size : 1.0) * trial;
    r.force = fn * c.normal + s.shear;
    r.sliding = size > limit;
  }

  void energy(const Contact& c, const State& old, const State& s, const Response& r, Energies& e) const {
    const double elastic = spring(c);
    const Vec3 before = c.turned(old.shear);
    e.strain = 0.5 * elastic * elastic / kn + (ks > 0 ? 0.5 * s.shear.squaredNorm() / ks : 0.0);
    const Vec3 stretched = ks > 0 ? (before - s.shear) / ks : Vec3{};
    e.friction = -0.5 * (before + s.shear).dot(c.slip() - stretched);
    e.dashpot = (elastic - r.force.dot(c.normal)) * c.opening() * c.dt;
    if constexpr (wrong == wrong_energy) e.strain *= 0.5;
    if constexpr (wrong == gives_friction) e.friction = -e.friction;
  }

  bool normal_only() const { return fric == 0; }
  void law_normal(const NormalContact& c, NormalResponse& r) const {
    const double pull = wrong == other_normal ? 0.0 : c.dashpot(dp_nratio, kn) * c.opening();
    r.force = max(0.0, spring(c) - pull);
  }

  void derive(const Pair&) {
    if constexpr (wrong == derives_again) ks *= 0.9;
  }
  double reach(const Pair&) const { return wrong == short_reach ? 0.5e-6 : 0.0; }

  Stiffness stiffness(const Contact&) const {
    const double share = wrong == understated ? 0.1 : wrong == overstated ? 10.0 : 1.0;
    return {.normal = share * kn, .shear = fric > 0 ? ks : 0.0, .dashpot = wrong == hidden_dashpot ? 0.0 : dp_nratio};
  }
};

template <Defect wrong>
constexpr scree_component named(const char* name) {
  return scree::contact_model<Springs<wrong>>(name, "1.0.0", "springs");
}

}  // namespace

SCREE_PLUGIN(named<none>("sound"), named<asymmetric>("asymmetric"), named<lab_axis>("lab_axis"),
             named<not_turned>("not_turned"), named<understated>("understated"), named<overstated>("overstated"),
             named<soft_unloading>("soft_unloading"), named<jump>("jump"), named<counts>("counts"),
             named<allocates>("allocates"), named<zero_over_zero>("zero_over_zero"), named<neighbour>("neighbour"),
             named<wrong_energy>("wrong_energy"), named<gives_friction>("gives_friction"), named<throws>("throws"),
             named<crashes>("crashes"), named<endless>("endless"), named<denormals_off>("denormals_off"),
             named<swallows_nan>("swallows_nan"), named<short_reach>("short_reach"),
             named<hidden_dashpot>("hidden_dashpot"), named<other_normal>("other_normal"),
             named<derives_again>("derives_again"))
