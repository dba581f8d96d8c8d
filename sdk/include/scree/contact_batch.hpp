#pragma once
/// From a law for one contact to functions for a batch, in three instruction sets. An author need not read this.
///
/// The shape of these loops is what makes them vectorise in g++ and clang, and small changes cost a factor of two to
/// four without a warning: the body is an always-inlined lambda (g++ turns a struct declared in an `omp simd` loop into
/// an array), every pointer sits in a local (read through the batch it is not hoisted), breaks are written per contact
/// and summed afterwards (a reduction through a lambda is not vectorised), `try` is inside the body (an exception may
/// not leave the loop), and words become a struct one by one (a copy of 16 or 64 bytes is an integer or a vector to
/// g++).
#include <scree/contact_check.hpp>

#include <cstring>

namespace scree::batch {

template <class T>
using Indices = std::make_index_sequence<shape::words<T>()>;

// A struct of a law is so many doubles, see contact_check.hpp.
template <class T, std::size_t... K>
SCREE_INLINE T gather(const double* const* column, std::size_t i, std::size_t first, std::index_sequence<K...>) {
  T out{};
  auto* word = reinterpret_cast<double*>(&out);
  ((word[K] = column[first + K][i]), ...);
  return out;
}
/// The same from words that stand one after the other.
template <class T, std::size_t... K>
SCREE_INLINE T read(const void* words, std::index_sequence<K...>) {
  T out{};
  auto* word = reinterpret_cast<double*>(&out);
  ((word[K] = static_cast<const double*>(words)[K]), ...);
  return out;
}
template <class T, std::size_t... K>
SCREE_INLINE void scatter(double* const* column, std::size_t i, std::size_t first, const T& value,
                          std::index_sequence<K...>) {
  const auto* word = reinterpret_cast<const double*>(&value);
  ((column[first + K][i] = word[K]), ...);
}

/// Calls the law in the form its author chose.
template <class L, class S, class B, class R, bool Bonded>
SCREE_INLINE void call_law(const L& law, const SpinContact& c, S& s, B& b, R& r) {
  if constexpr (Bonded)
    law.law(c, s, b, r);
  else if constexpr (shape::HasState<L>)
    law.law(c, s, r);
  else
    law.law(c, r);
}
template <class L, class S, class B, class R, bool Bonded>
SCREE_INLINE void call_energy(const L& law, const SpinContact& c, const S& s0, const S& s, const B& b0, const B& b,
                              const R& r, Energies& e) {
  if constexpr (Bonded && shape::HasBondEnergy<L>)
    law.energy(c, s0, s, b0, b, r, e);
  else if constexpr (shape::HasEnergy<L>)
    law.energy(c, s0, s, r, e);
}

template <class L, bool Varying, bool Energy, bool Bonded>
SCREE_INLINE uint32_t loop(const void* uniform, const scree_batch& b) {
  using State = shape::State<L>;
  using Bond = shape::Bond<L>;
  using Answer = std::conditional_t<shape::GivesMoment<L>, MomentResponse, Response>;
  constexpr std::size_t rule_words = shape::words<L>(), state_words = shape::words<State>(),
                        memory_words = state_words + (Bonded ? shape::words<Bond>() : 0);
  constexpr bool spins = shape::ReadsSpin<L>, turning = shape::turns<L>(), moments = shape::GivesMoment<L>,
                 breaks = Bonded && shape::Breaks<L>;

  const double *nx = b.nx, *ny = b.ny, *nz = b.nz, *gap = b.gap, *vx = b.vx, *vy = b.vy, *vz = b.vz;
  const double *wx = b.wx, *wy = b.wy, *wz = b.wz, *tx = b.tx, *ty = b.ty, *tz = b.tz;
  const double *r1 = b.r1, *r2 = b.r2, *mass = b.mass;
  double *fx = b.fx, *fy = b.fy, *fz = b.fz, *mx = b.mx, *my = b.my, *mz = b.mz;
  // Where nobody asked, the column goes to the stack: a test in the loop would cost more than the store.
  double unread_event[breaks ? SCREE_BATCH : 1], unread_sliding[SCREE_BATCH];
  double* event = b.event != nullptr ? b.event : unread_event;
  double* sliding = b.sliding != nullptr ? b.sliding : unread_sliding;
  double* memory[memory_words + 1];
  for (std::size_t k = 0; k < memory_words; ++k) memory[k] = b.state[k];
  const double* property[rule_words + 1];
  double* energy[4];
  if constexpr (Varying)
    for (std::size_t k = 0; k < rule_words; ++k) property[k] = b.property[k];
  if constexpr (Energy)
    for (std::size_t k = 0; k < 4; ++k) energy[k] = b.energy[k];
  L rule{};
  if constexpr (!Varying) rule = read<L>(uniform, Indices<L>{});
  const double dt = b.dt;
  const uint32_t n = b.n;
  bool threw = false;

  const auto one = [&](std::size_t i) __attribute__((always_inline)) {
    SpinContact c;
    c.normal = {nx[i], ny[i], nz[i]};
    c.gap = gap[i];
    c.dt = dt;
    c.mass = mass[i];
    c.r1 = r1[i];
    c.r2 = r2[i];
    c.set_velocity({vx[i], vy[i], vz[i]});
    if constexpr (spins) c.spin = {wx[i], wy[i], wz[i]};
    if constexpr (turning) c.set_turn({tx[i], ty[i], tz[i]});
    State state = gather<State>(memory, i, 0, Indices<State>{});
    Bond bond{};
    if constexpr (Bonded) bond = gather<Bond>(memory, i, state_words, Indices<Bond>{});
    const State state_before = state;
    const Bond bond_before = bond;
    Answer r{};
    Energies e;
    const auto go = [&](const L& law) __attribute__((always_inline)) {
      call_law<L, State, Bond, Answer, Bonded>(law, c, state, bond, r);
      if constexpr (breaks) event[i] = law.broken(bond_before) == 0.0 ? law.broken(bond) : 0.0;
      if constexpr (Energy)
        call_energy<L, State, Bond, Answer, Bonded>(law, c, state_before, state, bond_before, bond, r, e);
    };
    try {
      if constexpr (Varying)
        go(gather<L>(property, i, 0, Indices<L>{}));
      else
        go(rule);
    } catch (...) {
      threw = true;
    }
    scatter(memory, i, 0, state, Indices<State>{});
    if constexpr (Bonded) scatter(memory, i, state_words, bond, Indices<Bond>{});
    fx[i] = r.force.x;
    fy[i] = r.force.y;
    fz[i] = r.force.z;
    if constexpr (moments) {
      mx[i] = r.moment.x;
      my[i] = r.moment.y;
      mz[i] = r.moment.z;
    }
    sliding[i] = r.sliding ? 1.0 : 0.0;
    if constexpr (Energy) {
      energy[0][i] = e.strain;
      energy[1][i] = e.friction;
      energy[2][i] = e.dashpot;
      energy[3][i] = e.broken;
    }
  };
#pragma omp simd
  for (uint32_t i = 0; i < n; ++i) one(i);

  uint32_t broke = 0;
  if constexpr (breaks)
    for (uint32_t i = 0; i < n; ++i) broke += event[i] != 0.0 ? 1u : 0u;
  return threw ? UINT32_MAX : broke;
}

template <class L, bool Varying, bool Energy>
SCREE_INLINE uint32_t normal_loop(const void* uniform, const scree_batch& b) {
  constexpr std::size_t rule_words = shape::words<L>();
  const double *nx = b.nx, *ny = b.ny, *nz = b.nz, *gap = b.gap, *vx = b.vx, *vy = b.vy, *vz = b.vz, *mass = b.mass;
  double *fx = b.fx, *fy = b.fy, *fz = b.fz;
  const double* property[rule_words + 1];
  double* energy[4];
  if constexpr (Varying)
    for (std::size_t k = 0; k < rule_words; ++k) property[k] = b.property[k];
  if constexpr (Energy)
    for (std::size_t k = 0; k < 4; ++k) energy[k] = b.energy[k];
  L rule{};
  if constexpr (!Varying) rule = read<L>(uniform, Indices<L>{});
  const double dt = b.dt;
  const uint32_t n = b.n;
  bool threw = false;

  const auto one = [&](std::size_t i) __attribute__((always_inline)) {
    NormalContact c;
    c.normal = {nx[i], ny[i], nz[i]};
    c.gap = gap[i];
    c.dt = dt;
    c.mass = mass[i];
    c.set_velocity({vx[i], vy[i], vz[i]});
    NormalResponse r;
    Energies e;
    const auto go = [&](const L& law) __attribute__((always_inline)) {
      law.law_normal(c, r);
      if constexpr (Energy) law.energy_normal(c, r, e);
    };
    try {
      if constexpr (Varying)
        go(gather<L>(property, i, 0, Indices<L>{}));
      else
        go(rule);
    } catch (...) {
      threw = true;
    }
    fx[i] = r.force * c.normal.x;
    fy[i] = r.force * c.normal.y;
    fz[i] = r.force * c.normal.z;
    if constexpr (Energy) {
      energy[0][i] = e.strain;
      energy[1][i] = e.friction;
      energy[2][i] = e.dashpot;
      energy[3][i] = e.broken;
    }
  };
#pragma omp simd
  for (uint32_t i = 0; i < n; ++i) one(i);

  if (b.sliding != nullptr) std::memset(b.sliding, 0, n * sizeof(double));
  return threw ? UINT32_MAX : 0;
}

// Three functions by attribute instead of target_clones, which clang refuses together with flatten; so a test can run
// all three in one process.
#if defined(__x86_64__)
#define SCREE_TARGETS(DO)            \
  DO(base, __attribute__((flatten))) \
  DO(v3, __attribute__((target("arch=x86-64-v3"), flatten))) DO(v4, __attribute__((target("arch=x86-64-v4"), flatten)))
#else
#define SCREE_TARGETS(DO) DO(base, __attribute__((flatten)))
#endif

#define SCREE_FUNCTIONS(isa, attributes)                                                                              \
  template <class L, bool Varying, bool Energy>                                                                       \
  attributes uint32_t touch_##isa(const void* rule, const scree_batch* b) {                                           \
    return loop<L, Varying, Energy, false>(rule, *b);                                                                 \
  }                                                                                                                   \
  template <class L, bool Varying>                                                                                    \
  attributes uint32_t bonded_##isa(const void* rule, const scree_batch* b) {                                          \
    if constexpr (shape::HasEnergy<L> || shape::HasBondEnergy<L>)                                                     \
      if (b->energy != nullptr) return loop<L, Varying, true, true>(rule, *b);                                        \
    return loop<L, Varying, false, true>(rule, *b);                                                                   \
  }                                                                                                                   \
  template <class L>                                                                                                  \
  attributes uint32_t normal_##isa(const void* rule, const scree_batch* b) {                                          \
    if constexpr (shape::HasNormalEnergy<L>)                                                                          \
      if (b->energy != nullptr)                                                                                       \
        return b->property != nullptr ? normal_loop<L, true, true>(rule, *b) : normal_loop<L, false, true>(rule, *b); \
    return b->property != nullptr ? normal_loop<L, true, false>(rule, *b) : normal_loop<L, false, false>(rule, *b);   \
  }
SCREE_TARGETS(SCREE_FUNCTIONS)
#undef SCREE_FUNCTIONS

}  // namespace scree::batch
