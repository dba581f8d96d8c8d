#include <scree/contact_model.hpp>

namespace {

using namespace scree;

/// A contact law: springs, a dashpot and Coulomb friction.
///
/// scree calls `law` for each contact in each cycle. Forces are those on piece 2; the normal points from piece 1 to
/// piece 2; the gap is negative while the pieces overlap. All values are SI.
struct PluginName {
  // What a scene gives for a rule that says `model: plugin_name`. The members are double or Vec3, nothing else.
  double kn, ks, fric, dp_nratio;

  // Name, member, unit, meaning; then range, default, and how the values of two pieces combine.
  static void describe(Properties<PluginName>& p) {
    p.number("kn", &PluginName::kn, "N/m", "normal stiffness").at_least(0).mix(series);
    p.number("ks", &PluginName::ks, "N/m", "shear stiffness").at_least(0).mix(series);
    p.number("fric", &PluginName::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
    p.number("dp_nratio", &PluginName::dp_nratio, "1", "normal dashpot, share of critical damping")
        .at_least(0)
        .fallback(0)
        .mix(mean);
    p.remembers("shear", &State::shear, "N");
  }

  /// What a contact remembers from cycle to cycle; zero when it begins, saved in checkpoints.
  struct State {
    Vec3 shear;  ///< force of the shear spring, N
  };

  // Runs on any thread, so it may depend on nothing but its arguments.
  void law(const Contact& c, State& s, Response& r) const {
    // The spring pushes in proportion to the overlap; with the dashpot the force still never pulls.
    const double normal = max(0.0, -kn * c.gap - c.dashpot(dp_nratio, kn) * c.opening());
    // The shear force follows the turning contact and grows with the slip, up to the friction limit.
    const Vec3 trial = c.turned(s.shear) - ks * c.slip();
    const double size = trial.norm(), limit = fric * normal;
    const bool sliding = size > limit;
    s.shear = (sliding ? limit / size : 1.0) * trial;
    r.force = normal * c.normal + s.shear;
    r.sliding = sliding;
  }

  // The stable time step follows from this: it must not be smaller than what `law` does.
  Stiffness stiffness(const Contact&) const { return {.normal = kn, .shear = ks, .dashpot = dp_nratio}; }
};

}  // namespace

SCREE_CONTACT_MODEL(PluginName, "plugin_name", "0.1.0", "linear springs, a dashpot and friction")
