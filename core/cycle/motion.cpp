#include "core/cycle/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/crash_note.hpp"
#include "core/plugin/table_check.hpp"

namespace scree::core {

namespace {

#define SCREE_STAGE inline __attribute__((always_inline))
#define SCREE_BODY __attribute__((always_inline))

/// The columns of one chunk of rows.
struct Chunk {
  double *x[3], *v[3], *w[3];  // w is null without spin
  const double *inverse_mass, *radius;
  const uint8_t* fixed;  // null while no ball is fixed
  std::size_t n;
};

struct Verdict {
  double fastest_square;
  bool finite;
};

template <bool Spin, bool SomeFixed>
SCREE_STAGE Verdict kick_and_drift(const Chunk& c, const RowForces& f, double half, double dt) {
  double *x = c.x[0], *y = c.x[1], *z = c.x[2], *vx = c.v[0], *vy = c.v[1], *vz = c.v[2];
  double *wx = c.w[0], *wy = c.w[1], *wz = c.w[2];
  const double *inverse = c.inverse_mass, *radius = c.radius;
  const double *fx = f.force[0], *fy = f.force[1], *fz = f.force[2];
  const double *mx = f.moment[0], *my = f.moment[1], *mz = f.moment[2];
  double square[SCREE_ROWS], check[SCREE_ROWS];
  const uint8_t* fixed = c.fixed;
  const auto one = [&](std::size_t k) SCREE_BODY {
    const double kick = inverse[k] * half;
    double ux = vx[k] + fx[k] * kick, uy = vy[k] + fy[k] * kick, uz = vz[k] + fz[k] * kick;
    double sum = fx[k] + fy[k] + fz[k];
    if constexpr (SomeFixed) {
      const uint8_t bits = fixed[k];
      ux = bits & fix_x ? vx[k] : ux;
      uy = bits & fix_y ? vy[k] : uy;
      uz = bits & fix_z ? vz[k] : uz;
    }
    vx[k] = ux;
    vy[k] = uy;
    vz[k] = uz;
    x[k] += ux * dt;
    y[k] += uy * dt;
    z[k] += uz * dt;
    square[k] = ux * ux + uy * uy + uz * uz;
    sum += (x[k] + y[k] + z[k]) + (ux + uy + uz);
    if constexpr (Spin) {
      const double turn = kick * 2.5 / (radius[k] * radius[k]);
      double sx = wx[k] + mx[k] * turn, sy = wy[k] + my[k] * turn, sz = wz[k] + mz[k] * turn;
      if constexpr (SomeFixed) {
        const uint8_t bits = fixed[k];
        sx = bits & fix_wx ? wx[k] : sx;
        sy = bits & fix_wy ? wy[k] : sy;
        sz = bits & fix_wz ? wz[k] : sz;
      }
      wx[k] = sx;
      wy[k] = sy;
      wz[k] = sz;
      sum += sx + sy + sz;
    }
    check[k] = sum;
  };
#pragma omp simd
  for (std::size_t k = 0; k < c.n; ++k) one(k);
  int bad = 0;
#pragma omp simd reduction(| : bad)
  for (std::size_t k = 0; k < c.n; ++k) bad |= !(std::fabs(check[k]) <= std::numeric_limits<double>::max());
  // Eight running maxima: a single one would be a chain that the compiler may not reorder.
  double lane[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  std::size_t k = 0;
  for (; k + 8 <= c.n; k += 8)
    for (std::size_t l = 0; l < 8; ++l) lane[l] = square[k + l] > lane[l] ? square[k + l] : lane[l];
  for (; k < c.n; ++k) lane[0] = square[k] > lane[0] ? square[k] : lane[0];
  return {*std::max_element(lane, lane + 8), bad == 0};
}

using Kick = Verdict (*)(const Chunk&, const RowForces&, double, double);
#define SCREE_KICKS(NAME, TARGET)                                                            \
  struct NAME {                                                                              \
    template <bool S, bool F>                                                                \
    TARGET static Verdict kick(const Chunk& c, const RowForces& f, double half, double dt) { \
      return kick_and_drift<S, F>(c, f, half, dt);                                           \
    }                                                                                        \
  };
SCREE_KICKS(Baseline, __attribute__((flatten)))
#if defined(__x86_64__)
SCREE_KICKS(V3, __attribute__((target("arch=x86-64-v3"), flatten)))
SCREE_KICKS(V4, __attribute__((target("arch=x86-64-v4"), flatten)))
#else
using V3 = Baseline;
using V4 = Baseline;
#endif
constexpr Kick kicks[3][2][2] = {
    {{Baseline::kick<false, false>, Baseline::kick<false, true>},
     {Baseline::kick<true, false>, Baseline::kick<true, true>}},
    {{V3::kick<false, false>, V3::kick<false, true>}, {V3::kick<true, false>, V3::kick<true, true>}},
    {{V4::kick<false, false>, V4::kick<false, true>}, {V4::kick<true, false>, V4::kick<true, true>}}};

double* shifted(double* column, std::size_t first) { return column == nullptr ? nullptr : column + first; }

// Hands the chunk to one process: its declared words, in its order.
void run_rows(const MotionInput& input, const Process& process, std::size_t first, std::size_t n, RowForces& forces,
              double* sum) {
  Balls& balls = *input.balls;
  double inertia[SCREE_ROWS], fixed[SCREE_ROWS];
  double* words[3 * most_needs];
  std::size_t count = 0;
  const auto give = [&](double* word) { words[count++] = word; };
  crash_note = {process.plugin.c_str(), process.name.c_str(), input.cycle, first / block_rows};
  for (uint32_t k = 0; k < process.table->need_count; ++k) {
    const uint32_t column = process.table->needs[k].column;
    const auto three = [&](Column from) {
      for (int c = 0; c < 3; ++c) give(shifted(balls[static_cast<Column>(static_cast<int>(from) + c)], first));
    };
    const bool spin = balls.has(Column::wx);
    switch (column) {
      case SCREE_POSITION:
        three(Column::x);
        break;
      case SCREE_VELOCITY:
        three(Column::vx);
        break;
      case SCREE_SPIN:
        three(Column::wx);
        break;
      case SCREE_FORCE:
        for (auto& component : forces.force) give(component);
        break;
      case SCREE_MOMENT:
        for (auto& component : forces.moment) give(spin ? component : nullptr);
        break;
      case SCREE_RADIUS:
        give(balls[Column::radius] + first);
        break;
      case SCREE_MASS:
        give(balls[Column::mass] + first);
        break;
      case SCREE_INERTIA: {
        const double *m = balls[Column::mass] + first, *r = balls[Column::radius] + first;
        for (std::size_t row = 0; row < n; ++row) inertia[row] = 0.4 * m[row] * r[row] * r[row];
        give(inertia);
        break;
      }
      default:
        for (std::size_t row = 0; row < n; ++row)
          fixed[row] = balls.fixed() != nullptr ? balls.fixed()[first + row] : 0;
        give(fixed);
    }
  }
  const scree_rows rows{
      sizeof(scree_rows), static_cast<uint32_t>(n), first, input.cycle, input.time, input.dt, words, sum};
  int isa = input.isa;
  while (isa > 0 && process.table->rows[isa] == nullptr) --isa;
  process.table->rows[isa](process.object.get(), &rows);
  crash_note = CrashNote{};
}

}  // namespace

std::size_t sum_words(const std::vector<const Process*>& processes) {
  std::size_t words = 0;
  for (const Process* process : processes) words += process->table->sums;
  return words;
}

void gather_forces(const MotionInput& input, std::size_t first, std::size_t n, RowForces& f, bool scale, double* sums) {
  Balls& balls = *input.balls;
  const std::size_t stride = input.slices->stride();
  const bool spin = balls.has(Column::wx);
  const double* record = input.slices->record(first);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t c = 0; c < 3; ++c) f.force[c][k] = record[k * stride + c];
  if (spin)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        f.moment[c][k] = stride == Slices::with_spin ? record[k * stride + 3 + c] : 0.0;
  for (int c = 0; c < 3; ++c) {
    const double* force = balls[static_cast<Column>(static_cast<int>(Column::force_x) + c)];
    const double* moment = balls[static_cast<Column>(static_cast<int>(Column::moment_x) + c)];
    for (std::size_t k = 0; force != nullptr && k < n; ++k) f.force[c][k] += force[first + k];
    for (std::size_t k = 0; spin && moment != nullptr && k < n; ++k) f.moment[c][k] += moment[first + k];
  }
  for (const Process* process : *input.adders) {
    run_rows(input, *process, first, n, f, sums);
    if (sums != nullptr) sums += process->table->sums;
  }
  if (scale) apply_scalers(input, first, n, f, sums);
}

void apply_scalers(const MotionInput& input, std::size_t first, std::size_t n, RowForces& f, double* sums) {
  for (const Process* process : *input.scalers) {
    run_rows(input, *process, first, n, f, sums);
    if (sums != nullptr) sums += process->table->sums;
  }
}

void add_work(const MotionInput& input, std::size_t first, std::size_t n, const RowForces& net, const RowForces& full,
              double span, RowWork& work) {
  const Balls& balls = *input.balls;
  const std::size_t stride = input.slices->stride();
  const double* record = input.slices->record(first);
  const uint8_t* fixed = balls.fixed();
  const auto side = [&](Column column, const double* all, const double* before, std::size_t word, unsigned bit) {
    const double* v = balls[column] + first;
    const bool in_record = word < 3 || stride == Slices::with_spin;
    for (std::size_t k = 0; k < n; ++k) {
      const double path = v[k] * span;
      work.body += (before[k] - (in_record ? record[k * stride + word] : 0.0)) * path;
      work.damping += (all[k] - before[k]) * path;
      if (fixed != nullptr && (fixed[first + k] >> bit & 1u) != 0) work.boundary -= all[k] * path;
    }
  };
  for (unsigned c = 0; c < 3; ++c)
    side(static_cast<Column>(static_cast<unsigned>(Column::vx) + c), full.force[c], net.force[c], c, c);
  for (unsigned c = 0; c < 3 && balls.has(Column::wx); ++c)
    side(static_cast<Column>(static_cast<unsigned>(Column::wx) + c), full.moment[c], net.moment[c], 3 + c, 3 + c);
}

namespace {

double kinetic(const Balls& balls, std::size_t first, std::size_t n) {
  double sum = 0;
  for (std::size_t row = first; row < first + n; ++row) {
    const double mass = balls[Column::mass][row], radius = balls[Column::radius][row];
    for (int c = 0; c < 3; ++c) {
      const double v = balls[static_cast<Column>(static_cast<int>(Column::vx) + c)][row];
      sum += 0.5 * mass * v * v;
      if (!balls.has(Column::wx)) continue;
      const double w = balls[static_cast<Column>(static_cast<int>(Column::wx) + c)][row];
      sum += 0.2 * mass * radius * radius * w * w;
    }
  }
  return sum;
}

}  // namespace

MotionResult move_block(const MotionInput& input, std::size_t block, double* sums) {
  Balls& balls = *input.balls;
  input.slices->fold(block);
  MotionResult result;
  const bool spin = balls.has(Column::wx);
  const Kick kick = kicks[input.isa][spin][balls.fixed() != nullptr];
  const double half = 0.5 * (input.dt_back + input.dt);
  RowForces forces, net;
  double fastest = 0;
  const std::size_t begin = block * block_rows, end = begin + input.slices->block_size(block);
  for (std::size_t first = begin; first < end; first += SCREE_ROWS) {
    const std::size_t n = std::min<std::size_t>(SCREE_ROWS, end - first);
    if (input.energy) {
      gather_forces(input, first, n, net, false, sums);
      forces = net;
      apply_scalers(input, first, n, forces, sums == nullptr ? nullptr : sums + sum_words(*input.adders));
      add_work(input, first, n, net, forces, 0.5 * input.dt_back, result.work);
    } else {
      gather_forces(input, first, n, forces, true, sums);
    }
    Chunk chunk{};
    for (int c = 0; c < 3; ++c) {
      chunk.x[c] = balls[static_cast<Column>(static_cast<int>(Column::x) + c)] + first;
      chunk.v[c] = balls[static_cast<Column>(static_cast<int>(Column::vx) + c)] + first;
      chunk.w[c] = shifted(balls[static_cast<Column>(static_cast<int>(Column::wx) + c)], first);
    }
    chunk.inverse_mass = balls[Column::inverse_mass] + first;
    chunk.radius = balls[Column::radius] + first;
    chunk.fixed = balls.fixed() != nullptr ? balls.fixed() + first : nullptr;
    chunk.n = n;
    const Verdict verdict = kick(chunk, forces, half, input.dt);
    if (input.energy) {
      add_work(input, first, n, net, forces, 0.5 * input.dt, result.work);
      result.work.kinetic += kinetic(balls, first, n);
    }
    fastest = std::max(fastest, verdict.fastest_square);
    result.finite = result.finite && verdict.finite;
  }
  result.fastest = std::sqrt(fastest);
  return result;
}

}  // namespace scree::core
