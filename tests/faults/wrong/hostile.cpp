// Plug-ins of every kind that pass the loader and then misbehave in the way that the scene's `deed` asks for.
#include <scree/contact_model.hpp>
#include <scree/generator.hpp>
#include <scree/process.hpp>
#include <scree/wall.hpp>
#include <scree/writer.hpp>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace {
using namespace scree;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

volatile int zero = 0;
volatile int counted = 0;
int* volatile nowhere = nullptr;

[[gnu::noinline]] void never_return() {
  for (;;) counted = counted ^ 1;
}
[[gnu::noinline]] int fill_stack(int depth) {
  volatile char frame[4096];
  frame[depth % 4096] = static_cast<char>(depth);
  const int deeper = depth < 0 ? 0 : fill_stack(depth + 1);
  return deeper + frame[depth % 4096];
}
// The real crash, not the word of a sanitizer about it.
__attribute__((noinline, no_sanitize("undefined"))) void crash(int deed) {
  if (deed == 20) never_return();
  if (deed == 21) *nowhere = 1;
  if (deed == 22) counted = fill_stack(0);
  if (deed == 23) std::abort();
  if (deed == 24) counted = counted / zero;
}

/// Linear springs, until an overlap is larger than `from`.
struct Law {
  double kn, from, deed;

  static void describe(Properties<Law>& p) {
    p.number("kn", &Law::kn, "N/m", "normal stiffness").at_least(0);
    p.number("from", &Law::from, "m", "overlap beyond which it misbehaves").fallback(0);
    p.number("deed", &Law::deed, "1", "what it does then").fallback(0);
  }
  void prepare() {
    if (deed == 1) throw std::runtime_error("this law likes no kn");
  }
  void derive(const Pair& pair) {
    if (deed == 2 && pair.r1 > 0) throw std::runtime_error("this law likes no radius");
  }
  void law(const Contact& c, MomentResponse& r) const {
    r.force = -kn * c.gap * c.normal;
    if (!(-c.gap > from)) return;
    if (deed == 10) throw std::runtime_error("this law likes no contact");
    if (deed == 11) throw 7;
    if (deed == 12) r.force = not_a_number * c.normal;
    if (deed == 13) r.force = 1e308 * c.normal;
    if (deed == 14) r.moment = infinite * c.normal;
    if (deed >= 20) crash(static_cast<int>(deed));
  }
  Stiffness stiffness(const Contact&) const { return {.normal = kn}; }
};

/// The plane z = 0, balls above it.
struct Floor {
  double deed = 0;

  static void describe(Settings<Floor>& s) { s.number("deed", &Floor::deed, "1", "what it does wrong"); }
  void touch(const Vec3& centre, double reach, Touches& out) const {
    if (centre.z >= reach) return;
    if (deed == 1) throw std::runtime_error("this wall likes no ball");
    if (deed == 2) {
      static std::atomic<uint32_t> asked{0};
      const uint32_t more = asked += 1000;
      for (uint32_t patch = 0; patch < more; ++patch) out.add({0, 0, -1}, centre.z, patch);
    }
    if (deed == 3) out.next_ball(4000000);
    if (deed == 6)
      for (uint32_t patch = 0; patch < 3000000; ++patch) out.add({0, 0, -1}, centre.z, patch);
    if (deed == 20) never_return();
    out.add({0, 0, deed == 5 ? -1.5 : deed == 7 ? not_a_number : -1}, deed == 4 ? not_a_number : centre.z, 0);
  }
};

/// Two balls, of which the second is wrong.
struct Pour {
  double deed = 0;

  static void describe(Settings<Pour>& s) { s.number("deed", &Pour::deed, "1", "what it does wrong"); }
  void generate(Sink& sink) const {
    sink.ball({.position = {0, 0, 1}, .radius = 0.01});
    if (deed == 3) throw 7;
    if (deed == 4) crash(21);
    sink.ball({.position = {deed == 1 ? not_a_number : 0, 0, 2}, .radius = deed == 2 ? -0.01 : 0.01});
  }
};

/// Acts at every cycle, or as the deed says.
struct Wind {
  static constexpr Effect effect = Effect::adds_force;
  double deed = 0;

  static void describe(Settings<Wind>& s) { s.number("deed", &Wind::deed, "1", "what it does wrong"); }
  void ball(Velocity& velocity, Force& force) const {
    if (deed == 1) force.x = not_a_number;
    if (deed == 2) velocity.x = not_a_number;
    if (deed == 6) throw std::runtime_error("this wind likes no ball");
    if (deed == 20) never_return();
  }
  void prepare(const Host& host) {
    if (deed == 5) throw std::runtime_error("this wind likes no scene");
    if (deed == 4) floor_ = host.wall("floor");
  }
  void step(Step& step) {
    if (deed == 3) throw std::runtime_error("this wind likes no cycle");
    if (deed == 4) step.host.view(floor_).velocity[2] = not_a_number;
  }

 private:
  scree::Wall floor_{};
};

struct Scribe {
  static constexpr uint32_t wants = SCREE_WANTS_BALLS;
  double deed = 0;

  static void describe(Settings<Scribe>& s) { s.number("deed", &Scribe::deed, "1", "what it does wrong"); }
  void open(const std::string&, const Files&) {
    if (deed == 1) throw std::runtime_error("this scribe likes no file");
  }
  void frame(const scree_frame&, const Files&) {
    if (deed == 2) throw std::runtime_error("this scribe likes no frame");
    if (deed == 4) crash(21);
  }
  void close(const Files&) {
    if (deed == 3) throw std::runtime_error("this scribe likes no end");
  }
};

}  // namespace

SCREE_PLUGIN(contact_model<Law>("hostile", "1.0.0", "a law that misbehaves"),
             wall<Floor>("hostile", "1.0.0", "a wall that misbehaves"),
             generator<Pour>("hostile", "1.0.0", "a generator that misbehaves"),
             process<Wind>("hostile", "1.0.0", "a process that misbehaves"),
             writer<Scribe>("hostile", "1.0.0", "a writer that misbehaves"))
