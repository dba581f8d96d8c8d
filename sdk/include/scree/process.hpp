#pragma once
/// Processes: what acts on balls besides contacts. One plain struct, described by its settings; every function below is
/// optional, at least one is needed.
///
///     void ball(const Mass& mass, Force& force) const;
///         One free ball, once per cycle, after the contact forces are summed and before it moves. The parameters are
///         the columns it needs (columns.hpp). [any thread], so it must not change the struct; it must not throw, which
///         ends the program.
///     void rotation(const Spin& spin, Moment& moment) const;
///         The same, run only in scenes whose balls have a spin; a frictionless scene keeps neither spin nor moment.
///     T at(double time) const;
///         The process as it acts at model time `time` (s): `ball` and `rotation` run on what it returns. For a force
///         with a history, as a pulse. It must depend on time and settings only, and not throw. [any thread]
///     void prepare(const Host& host);
///         Before the first cycle, after each edit of the scene and after a resume: look up walls, give quantities
///         their first value, refuse by throwing. [one thread]
///     void step(Step& step);   or   void step(Step& step, State& state);
///         Between cycles, on complete columns. [one thread] `struct State` holds doubles and Vec3 that a checkpoint
///         saves; everything else must follow from settings.
///     double damping() const;
///         Share of local damping, in [0, 1): the automatic time step is divided by sqrt(1 + damping).
///
/// A process that writes Force or Moment says in which order it acts:
///     static constexpr Effect effect = Effect::adds_force;     // before all that scale
///     static constexpr Effect effect = Effect::scales_force;   // after all that add
/// `static constexpr uint32_t every = 10;` calls `step` every tenth cycle only.
/// `static constexpr bool traces_energy = true;` makes the program keep an energy balance, which scenes and processes
/// read as `energy.body`, `energy.residual` ... (docs/scenes.md); without such a process it costs nothing.
#include <scree/abi.h>
#include <scree/columns.hpp>
#include <scree/host.hpp>
#include <scree/math.hpp>
#include <scree/object.hpp>
#include <scree/plugin.hpp>
#include <scree/row_loop.hpp>

#include <string>
#include <type_traits>
#include <vector>

namespace scree {

/// What a process does to forces; decides its place among the processes of a cycle.
enum class Effect : uint32_t { none = 0, adds_force = SCREE_ADDS_FORCE, scales_force = SCREE_SCALES_FORCE };

namespace process_adapter {

template <class T>
concept HasBall = requires {
  &T::ball;
};
template <class T>
concept HasRotation = requires {
  &T::rotation;
};
template <class T>
concept HasState = requires {
  typename T::State;
};
template <class T>
concept HasStep = requires {
  &T::step;
};

template <class T>
struct NoRows {
  static constexpr uint32_t words = 0;
  static constexpr bool writes(uint32_t) { return false; }
};
template <class T>
constexpr auto ball_function() {
  if constexpr (HasBall<T>) {
    return RowFunction<decltype(&T::ball)>();
  } else {
    return NoRows<T>();
  }
}
template <class T>
constexpr auto rotation_function() {
  if constexpr (HasRotation<T>) {
    return RowFunction<decltype(&T::rotation)>();
  } else {
    return NoRows<T>();
  }
}

template <class T>
SCREE_INLINE void rows_of(const T& process, const scree_rows* rows) {
  const std::size_t n = rows->n;
  double* const* word = rows->word;
  if constexpr (HasBall<T>) {
    ball_function<T>().loop(
        process, word, n, [](const T& t, auto&&... cell) __attribute__((always_inline)) { t.ball(cell...); });
    word += decltype(ball_function<T>())::words;
  }
  if constexpr (HasRotation<T>) {
    for (uint32_t k = 0; k < decltype(rotation_function<T>())::words; ++k)
      if (word[k] == nullptr) return;
    rotation_function<T>().loop(
        process, word, n, [](const T& t, auto&&... cell) __attribute__((always_inline)) { t.rotation(cell...); });
  }
}
template <class T>
SCREE_INLINE void rows(const void* self, const scree_rows* block) {
  const T& given = *static_cast<const T*>(self);
  if constexpr (requires { given.at(block->time); })
    rows_of<T>(given.at(block->time), block);
  else
    rows_of<T>(given, block);
}
template <class T>
__attribute__((flatten)) void rows_baseline(const void* self, const scree_rows* block) noexcept {
  rows<T>(self, block);
}
#if defined(__x86_64__)
template <class T>
__attribute__((target("arch=x86-64-v3"), flatten)) void rows_v3(const void* self, const scree_rows* block) noexcept {
  rows<T>(self, block);
}
template <class T>
__attribute__((target("arch=x86-64-v4"), flatten)) void rows_v4(const void* self, const scree_rows* block) noexcept {
  rows<T>(self, block);
}
#endif

template <class T>
const std::vector<scree_need>& needs() {
  static const std::vector<scree_need> list = [] {
    std::vector<scree_need> all;
    if constexpr (HasBall<T>)
      for (const scree_need& need : ball_function<T>().list(0)) all.push_back(need);
    if constexpr (HasRotation<T>)
      for (const scree_need& need : rotation_function<T>().list(SCREE_OPTIONAL)) all.push_back(need);
    return all;
  }();
  return list;
}

template <class T>
int call_step(void* self, const scree_step* table, const scree_refusal* refusal) {
  return guarded(refusal, [&] {
    Step step(*table);
    if constexpr (HasState<T>) {
      typename T::State state;
      std::memcpy(static_cast<void*>(&state), table->state, sizeof state);
      static_cast<T*>(self)->step(step, state);
      std::memcpy(table->state, &state, sizeof state);
    } else {
      static_cast<T*>(self)->step(step);
    }
  });
}

template <class T>
constexpr uint32_t flags() {
  uint32_t flags = 0;
  if constexpr (requires { T::effect; }) flags |= static_cast<uint32_t>(T::effect);
  if constexpr (requires(const T& t) { t.damping(); }) flags |= SCREE_LOCAL_DAMPING;
  if constexpr (requires { T::traces_energy; })
    if (T::traces_energy) flags |= SCREE_TRACES_ENERGY;
  return flags;
}

template <class T>
constexpr bool writes_force() {
  return ball_function<T>().writes(SCREE_FORCE) || ball_function<T>().writes(SCREE_MOMENT) ||
         rotation_function<T>().writes(SCREE_FORCE) || rotation_function<T>().writes(SCREE_MOMENT);
}

template <class T>
scree_process make_table() {
  static_assert(HasBall<T> || HasRotation<T> || HasStep<T> || (flags<T>() & SCREE_TRACES_ENERGY) != 0,
                "scree: a process needs 'void ball(...) const', 'void rotation(...) const' or 'void step(Step&)'");
  static_assert(!writes_force<T>() || (flags<T>() & (SCREE_ADDS_FORCE | SCREE_SCALES_FORCE)) != 0,
                "scree: a process that writes Force or Moment says 'static constexpr Effect effect = "
                "Effect::adds_force;' or scales_force");
  scree_process table{};
  table.struct_size = sizeof table;
  table.flags = flags<T>();
  table.object = object_table<T>();
  table.every = 1;
  if constexpr (requires { T::every; }) table.every = T::every;
  if constexpr (HasState<T>) {
    static_assert(std::is_trivially_copyable_v<typename T::State> && sizeof(typename T::State) % sizeof(double) == 0,
                  "scree: State is a plain struct of double and Vec3, because it is saved in checkpoints");
    table.state_words = sizeof(typename T::State) / sizeof(double);
  }
  table.need_count = static_cast<uint32_t>(needs<T>().size());
  table.needs = needs<T>().data();
  if constexpr (requires(T & t, const Host& host) { t.prepare(host); })
    table.prepare = [](void* self, const scree_host* host, const scree_refusal* refusal) {
      return guarded(refusal, [&] { static_cast<T*>(self)->prepare(Host(*host)); });
    };
  if constexpr (HasBall<T> || HasRotation<T>) {
    table.rows[0] = &rows_baseline<T>;
#if defined(__x86_64__)
    table.rows[1] = &rows_v3<T>;
    table.rows[2] = &rows_v4<T>;
#endif
  }
  if constexpr (HasStep<T>) table.step = &call_step<T>;
  if constexpr (requires(const T& t) { t.damping(); })
    table.damping = [](const void* self) -> double { return static_cast<const T*>(self)->damping(); };
  return table;
}

}  // namespace process_adapter

/// One process for SCREE_PLUGIN. `name` is what a scene writes after `process:`.
template <class T>
constexpr scree_component process(const char* name, const char* version, const char* doc = "") {
  return {SCREE_PROCESS, 0, name, version, doc, []() -> const void* {
            static const scree_process table = process_adapter::make_table<T>();
            return &table;
          }};
}

}  // namespace scree
