#pragma once
/// Generators: where balls come from. One plain struct, described by its settings, with
///
///     void generate(Sink& sink) const;     [one thread]
///
/// that hands balls to the sink and throws to refuse; the text should say how far it came and what to change. All
/// randomness comes from the sink, so that a scene gives the same balls on any machine and any number of threads.
#include <scree/abi.h>
#include <scree/math.hpp>
#include <scree/object.hpp>
#include <scree/plugin.hpp>

#include <array>
#include <optional>
#include <string>

namespace scree {

/// One ball on its way into the scene. What stays empty comes from the ball set in the scene.
struct Ball {
  Vec3 position;                    ///< m
  double radius = 0;                ///< m, above 0
  std::optional<double> density{};  ///< kg/m3
  std::optional<Vec3> velocity{};   ///< m/s
  std::optional<Vec3> spin{};       ///< rad/s
  std::optional<uint64_t> id{};     ///< at least 1 and unique in the scene; numbered on when empty
  std::string group{};              ///< sub-group of the set, as in `sand.fine`; empty: none
};

/// The orthogonal cell of a scene.
struct CellView {
  Vec3 low, high;                ///< m
  std::array<bool, 3> periodic;  ///< x, y, z
};

/// Thrown by the sink when the program itself refuses a ball (it knows why); let it pass.
struct Stopped {};

/// Where a generator puts its balls, and where its random numbers come from.
class Sink {
 public:
  explicit Sink(const scree_sink& table) : table_(&table) {}

  /// Places a ball; overlaps are allowed.
  void ball(const Ball& ball) const {
    const scree_ball plain = flat(ball);
    if (table_->ball(table_->self, &plain) == 0) throw Stopped{};
  }
  /// Places a ball unless it overlaps an earlier ball or a wall, or leaves the cell. True when it was placed.
  bool try_ball(const Ball& ball) const {
    const scree_ball plain = flat(ball);
    return table_->try_ball(table_->self, &plain) == 1;
  }
  /// In [0, 1). The same `index` and `draw` always give the same number; use the index for the ball and count the draws
  /// of one ball.
  double uniform(uint64_t index, uint64_t draw) const {
    return table_->random->uniform(table_->random->self, index, draw);
  }
  /// Mean 0, deviation 1. Do not use one pair of `index` and `draw` for both kinds.
  double normal(uint64_t index, uint64_t draw) const {
    return table_->random->normal(table_->random->self, index, draw);
  }
  /// The scene's cell; empty without one.
  std::optional<CellView> cell() const {
    if (table_->cell_low == nullptr) return std::nullopt;
    const uint8_t* p = table_->periodic;
    return CellView{vec3(table_->cell_low), vec3(table_->cell_high), {p[0] != 0, p[1] != 0, p[2] != 0}};
  }
  /// A line for the log and the summary.
  void warn(const std::string& message) const { table_->warn(table_->self, message.c_str()); }

 private:
  static scree_ball flat(const Ball& ball) {
    scree_ball plain{};
    plain.struct_size = sizeof plain;
    const auto copy = [](double* to, const Vec3& from) { to[0] = from.x, to[1] = from.y, to[2] = from.z; };
    copy(plain.position, ball.position);
    plain.radius = ball.radius;
    if (ball.density) plain.given |= SCREE_BALL_DENSITY, plain.density = *ball.density;
    if (ball.velocity) plain.given |= SCREE_BALL_VELOCITY, copy(plain.velocity, *ball.velocity);
    if (ball.spin) plain.given |= SCREE_BALL_SPIN, copy(plain.spin, *ball.spin);
    if (ball.id) plain.given |= SCREE_BALL_ID, plain.id = *ball.id;
    if (!ball.group.empty()) plain.given |= SCREE_BALL_GROUP, plain.group = ball.group.c_str();
    return plain;
  }

  const scree_sink* table_;
};

namespace generator_adapter {

template <class T>
int generate(const void* self, const scree_sink* table, const scree_refusal* refusal) {
  int stopped = 0;
  const int threw = guarded(refusal, [&] {
    Sink sink(*table);
    try {
      static_cast<const T*>(self)->generate(sink);
    } catch (const Stopped&) {
      stopped = 1;
    }
  });
  return threw != 0 ? threw : stopped;
}

template <class T>
scree_generator make_table() {
  static_assert(
      requires(const T& t, Sink& sink) { t.generate(sink); },
      "scree: a generator needs 'void generate(Sink& sink) const'");
  scree_generator table{};
  table.struct_size = sizeof table;
  table.object = object_table<T>();
  table.generate = &generate<T>;
  return table;
}

}  // namespace generator_adapter

/// One generator for SCREE_PLUGIN. `name` is what a scene writes after `generator:`.
template <class T>
constexpr scree_component generator(const char* name, const char* version, const char* doc = "") {
  return {SCREE_GENERATOR, 0, name, version, doc, []() -> const void* {
            static const scree_generator table = generator_adapter::make_table<T>();
            return &table;
          }};
}

}  // namespace scree
