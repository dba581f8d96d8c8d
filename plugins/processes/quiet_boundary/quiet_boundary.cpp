#include <scree/process.hpp>

#include <cmath>
#include <stdexcept>

namespace {

using namespace scree;

/// A viscous boundary that takes in plane waves (Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95, 1969) and may send
/// one in: force Z (2 u(t) - v) on the balls of a box.
struct QuietBoundary {
  static constexpr Effect effect = Effect::adds_force;
  std::array<Vec3, 2> box{};
  Vec3 impedance{0, 0, 0};
  double wave_speed = 0;
  Vec3 pulse{0, 0, 0};
  std::string shape = "raised_cosine";
  double period = 0, start = 0;
  Vec3 incoming{0, 0, 0};  ///< velocity of the wave sent in, now
  double checked = 0;      ///< step that was found short enough, s

  static void describe(Settings<QuietBoundary>& settings) {
    settings.box("box", &QuietBoundary::box, "m", "acts on the balls whose centre lies in it").required();
    settings.vector("impedance", &QuietBoundary::impedance, "N s/m", "force over velocity of one ball, per axis")
        .at_least(0);
    settings
        .number("wave_speed", &QuietBoundary::wave_speed, "m/s",
                "C, instead of impedance: each ball has m C / (2 R) along every axis")
        .at_least(0);
    settings.vector("pulse", &QuietBoundary::pulse, "m/s", "largest velocity of a wave that is sent in");
    settings.text("shape", &QuietBoundary::shape, "of the pulse, one period").choices("raised_cosine sine");
    settings.number("period", &QuietBoundary::period, "s", "length of the pulse").at_least(0);
    settings.number("start", &QuietBoundary::start, "s", "model time at which the pulse begins").at_least(0);
  }

  void check() const {
    const bool given = impedance.x > 0 || impedance.y > 0 || impedance.z > 0;
    if (given && wave_speed > 0) throw std::runtime_error("it has both 'impedance' and 'wave_speed': give one of them");
    const bool sends = pulse.x != 0 || pulse.y != 0 || pulse.z != 0;
    if (sends && !(period > 0)) throw std::runtime_error("a 'pulse' wants its 'period', above 0 s");
  }

  QuietBoundary at(double time) const {
    QuietBoundary now = *this;
    const double turn = period > 0 ? (time - start) / period : -1;
    if (turn <= 0 || turn >= 1) return now;
    const double angle = 2 * 3.14159265358979323846 * turn;
    now.incoming = (shape == "sine" ? std::sin(angle) : 0.5 * (1 - std::cos(angle))) * pulse;
    return now;
  }

  Vec3 per_ball(double mass, double radius) const {
    const double own = mass * wave_speed / (2 * radius);
    return {impedance.x + own, impedance.y + own, impedance.z + own};
  }
  bool inside(const Vec3& p) const {
    return (p.x >= box[0].x) & (p.x <= box[1].x) & (p.y >= box[0].y) & (p.y <= box[1].y) & (p.z >= box[0].z) &
           (p.z <= box[1].z);
  }

  void ball(const Position& position, const Velocity& velocity, const Radius& radius, const Mass& mass,
            Force& force) const {
    const Vec3 z = per_ball(mass, radius);
    const bool acts = inside(position);
    force.x += acts ? z.x * (2 * incoming.x - velocity.x) : 0.0;
    force.y += acts ? z.y * (2 * incoming.y - velocity.y) : 0.0;
    force.z += acts ? z.z * (2 * incoming.z - velocity.z) : 0.0;
  }

  void prepare(const Host&) { checked = 0; }

  // The force uses the velocity of half a step before, so that a dashpot to the ground wants dt Z/m < 2 to be stable,
  // and below 1 to brake without turning the ball round.
  void step(Step& step) {
    if (step.dt <= checked) return;
    const auto mass = step.host.column(SCREE_MASS, 0), radius = step.host.column(SCREE_RADIUS, 0);
    const auto x = step.host.column(SCREE_POSITION, 0), y = step.host.column(SCREE_POSITION, 1),
               z = step.host.column(SCREE_POSITION, 2);
    for (std::size_t row = 0; row < mass.size(); ++row) {
      if (!inside({x[row], y[row], z[row]}) || !(mass[row] > 0)) continue;
      const Vec3 own = per_ball(mass[row], radius[row]);
      const double share = step.dt * std::max(own.x, std::max(own.y, own.z)) / mass[row];
      if (share >= 1)
        throw std::runtime_error("the step of " + std::to_string(step.dt) + " s times impedance over mass is " +
                                 std::to_string(share) + " for ball " + std::to_string(step.host.ids()[row]) +
                                 ", and must be below 1: give a shorter 'timestep', or a smaller impedance");
    }
    checked = step.dt;
  }
};

}  // namespace

SCREE_PLUGIN(scree::process<QuietBoundary>("quiet_boundary", "1.0.0", "viscous boundary that takes in waves"))
