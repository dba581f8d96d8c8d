// Walls, processes, generators and writers: a sound one of each and others that are wrong in one way.
#include <scree/generator.hpp>
#include <scree/process.hpp>
#include <scree/wall.hpp>
#include <scree/writer.hpp>

#include <cstdlib>
#include <vector>

namespace {
using namespace scree;

enum Defect {
  none,
  long_normal,
  wrong_distance,
  near_sighted,
  allocates,
  zero_over_zero,
  leaks,
  counts,
  goes_on,
  deaf,
  repeats
};

template <Defect wrong>
struct Globe {
  Vec3 centre{0, 0, 0};
  double radius = 0.05;

  static void describe(Settings<Globe>& s) {
    s.vector("centre", &Globe::centre, "m", "of the sphere");
    s.number("radius", &Globe::radius, "m", "of the sphere").above(0);
  }
  void touch(const Vec3& x, double reach, Touches& out) const {
    const Vec3 way = centre - x;
    double distance = way.norm() - radius;
    if (!(distance < (wrong == near_sighted ? 0.9 : 1.0) * reach)) return;
    if (wrong == wrong_distance) distance *= 1.01;
    out.add((wrong == long_normal ? 1.001 : 1.0) * way.normalized(), distance, 0);
  }
};

template <Defect wrong>
struct Drag {
  static constexpr Effect effect = Effect::adds_force;
  double rate = 1;

  static void describe(Settings<Drag>& s) { s.number("rate", &Drag::rate, "1/s", "deceleration").at_least(0); }
  Drag() {
    if constexpr (wrong == leaks) {
      void* volatile lost = std::malloc(100);
      static_cast<void>(lost);
    }
  }
  void ball(const Mass& mass, const Velocity& velocity, Force& force) const {
    if constexpr (wrong == allocates) {
      void* volatile block = std::malloc(64);
      std::free(block);
    }
    const double speed = velocity.norm();
    if constexpr (wrong == zero_over_zero)
      force -= (rate * mass) * (velocity / speed);
    else
      force -= (rate * mass * speed) * velocity;
  }
};

template <Defect wrong>
struct Row {
  double radius = 0.01;

  static void describe(Settings<Row>& s) { s.number("radius", &Row::radius, "m", "of every ball").above(0); }
  void generate(Sink& sink) const {
    static int calls = 0;
    ++calls;
    const double shift = wrong == counts ? 1e-3 * calls : 0;
    for (int k = 0; k < 5; ++k) {
      const Vec3 place{0.03 * k + shift, 0.01 * sink.uniform(static_cast<uint64_t>(k), 0), 0};
      try {
        sink.ball({.position = place, .radius = radius});
      } catch (const Stopped&) {
        if (wrong != goes_on) throw;
      }
    }
  }
};

template <Defect wrong>
struct Lines {
  static constexpr uint32_t wants = SCREE_WANTS_BALLS;
  std::string file;
  bool headed = false;

  static void describe(Settings<Lines>&) {}
  void open(const std::string& name, const Files&) { file = name + ".txt"; }
  void frame(const scree_frame& frame, const Files& files) {
    const bool first = wrong == repeats ? !headed : frame.index == 0;
    headed = true;
    const std::string text = (first ? "balls\n" : "") + std::to_string(frame.ball_count) + "\n";
    try {
      files.append(file, text);
    } catch (const std::exception&) {
      if (wrong != deaf) throw;
    }
  }
};

}  // namespace

SCREE_PLUGIN(scree::wall<Globe<none>>("sound_wall", "1.0.0"), scree::wall<Globe<long_normal>>("long_normal", "1.0.0"),
             scree::wall<Globe<wrong_distance>>("wrong_distance", "1.0.0"),
             scree::wall<Globe<near_sighted>>("near_sighted", "1.0.0"),
             scree::process<Drag<none>>("sound_process", "1.0.0"),
             scree::process<Drag<allocates>>("allocating_process", "1.0.0"),
             scree::process<Drag<zero_over_zero>>("zero_over_zero", "1.0.0"),
             scree::process<Drag<leaks>>("leaking_process", "1.0.0"),
             scree::generator<Row<none>>("sound_generator", "1.0.0"),
             scree::generator<Row<counts>>("counting_generator", "1.0.0"),
             scree::generator<Row<goes_on>>("goes_on", "1.0.0"), scree::writer<Lines<none>>("sound_writer", "1.0.0"),
             scree::writer<Lines<deaf>>("deaf_writer", "1.0.0"),
             scree::writer<Lines<repeats>>("repeating_writer", "1.0.0"))
