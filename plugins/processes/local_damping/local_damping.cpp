#include <scree/process.hpp>

namespace {

using namespace scree;

/// |f| with the sign of v; the sign of zero is zero.
SCREE_INLINE double against(double f, double v) { return v == 0 ? 0.0 : std::copysign(f, v); }
SCREE_INLINE Vec3 against(const Vec3& f, const Vec3& v) {
  return {against(f.x, v.x), against(f.y, v.y), against(f.z, v.z)};
}

/// Cundall's local damping: each component of the net force and moment loses a share of its size that opposes the
/// motion (Cundall, in Explicit finite difference methods in geomechanics, 1987).
struct LocalDamping {
  static constexpr Effect effect = Effect::scales_force;
  double factor = 0.7;

  static void describe(Settings<LocalDamping>& settings) {
    settings.number("factor", &LocalDamping::factor, "1", "share of the net force that opposes the motion")
        .at_least(0)
        .below(1);
  }
  void ball(const Velocity& velocity, Force& force) const { force -= factor * against(force, velocity); }
  void rotation(const Spin& spin, Moment& moment) const { moment -= factor * against(moment, spin); }
  double damping() const { return factor; }
};

}  // namespace

SCREE_PLUGIN(scree::process<LocalDamping>("local_damping", "1.0.0", "damping proportional to the net force"))
