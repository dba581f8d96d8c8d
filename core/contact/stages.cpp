#include "core/contact/stages.hpp"

#include <cmath>

#include "core/contact/compaction.hpp"
#include "core/contact/touch_list.hpp"

// The stages. Each body is compiled for three instruction sets, as the laws are, and gives the same bits on all:
// elementwise arithmetic only, no contraction, no reassociated sums.

namespace scree::core {

namespace {

#define SCREE_STAGE inline __attribute__((always_inline))
#define SCREE_BODY __attribute__((always_inline))

// Below this squared distance the separation has lost its direction to underflow.
constexpr double vanishing = 1e-200;

// Coincident centres get a direction that follows from the rows' ids alone, and a distance that is zero for any scene.
void part_coincident(uint32_t n, Scratch& s) {
  for (uint32_t k = 0; k < n; ++k) {
    if (!(s.square[k] < vanishing)) continue;
    double x = s.nx[k], y = s.ny[k], z = s.nz[k];
    const double most = std::fmax(std::fabs(x), std::fmax(std::fabs(y), std::fabs(z)));
    if (most > 0) {
      x /= most;
      y /= most;
      z /= most;
    } else {
      x = s.sign[k];
      y = z = 0;
    }
    const double scale = 1e-90 / std::sqrt(x * x + y * y + z * z);
    s.nx[k] = x * scale;
    s.ny[k] = y * scale;
    s.nz[k] = z * scale;
    s.square[k] = s.nx[k] * s.nx[k] + s.ny[k] * s.ny[k] + s.nz[k] * s.nz[k];
  }
}

// The rows of the slots from `next` on, one for each. A row is written eight times at once and the next one overwrites
// what is too much: how many slots a row has cannot be guessed, and a loop over them would guess wrong once a row.
SCREE_STAGE std::size_t expand_rows(const uint64_t* begin, std::size_t row, uint64_t next, uint32_t m, uint32_t* rows) {
  for (uint32_t k = 0; k < m;) {
    const uint64_t left = begin[row + 1] - (next + k);
    const uint32_t count = left < m - k ? static_cast<uint32_t>(left) : m - k;
    for (uint32_t first = k; first < k + count; first += 8)
      for (uint32_t q = 0; q < 8; ++q) rows[first + q] = static_cast<uint32_t>(row);
    k += count;
    row += count == left ? 1 : 0;
  }
  return row;
}

template <bool Periodic>
SCREE_STAGE void measure(const BallView& b, const FilterInput& in, uint64_t next, uint32_t m, Window& w) {
  const double *x = b.x, *y = b.y, *z = b.z, *radius = b.radius;
  const uint32_t *other = in.other + next, *where = in.where + next, *row = w.row;
  double *wx = w.x, *wy = w.y, *wz = w.z, *squares = w.square, *sums = w.sum;
  int64_t* touches = w.near;
  const double margin = in.reach;
  double edge[3] = {0, 0, 0};
  if constexpr (Periodic)
    for (int axis = 0; axis < 3; ++axis) edge[axis] = in.shift[1 << (2 * axis)][axis];
  const auto one = [&](uint32_t k) SCREE_BODY {
    const auto i = static_cast<int32_t>(row[k]), j = static_cast<int32_t>(other[k]);  // gathers want signed
    double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
    if constexpr (Periodic) {
      // Two bits an axis: 1 is an edge further, 2 an edge back.
      const auto image = static_cast<int32_t>(target::image(where[k]));
      dx += edge[0] * ((image & 1) - (image >> 1 & 1));
      dy += edge[1] * ((image >> 2 & 1) - (image >> 3 & 1));
      dz += edge[2] * ((image >> 4 & 1) - (image >> 5 & 1));
    }
    const double square = dx * dx + dy * dy + dz * dz, sum = radius[i] + radius[j], reach = sum + margin;
    wx[k] = dx;
    wy[k] = dy;
    wz[k] = dz;
    squares[k] = square;
    sums[k] = sum;
    // Written so that a NaN counts as touching and reaches the guards.
    touches[k] = square >= reach * reach ? 0 : 1;
  };
#pragma omp simd
  for (uint32_t k = 0; k < m; ++k) one(k);
}

template <bool Periodic, class Compaction>
SCREE_STAGE uint32_t filter(const BallView& b, const FilterInput& in, Cursor& at, uint8_t* active, Scratch& s,
                            uint32_t* drops, uint32_t& dropped) {
  const uint64_t end = in.begin[at.last_row];
  uint64_t next = at.slot;
  Filled filled{0, 0};
  while (next < end && Scratch::size - (filled.n > filled.gone ? filled.n : filled.gone) >= Window::size) {
    const uint32_t m = end - next < Window::size ? static_cast<uint32_t>(end - next) : Window::size;
    at.row = expand_rows(in.begin, at.row, next, m, s.window.row);
    measure<Periodic>(b, in, next, m, s.window);
    filled = Compaction::move(in, {next, m, active, drops}, filled, s);
    next += m;
  }
  at.slot = next;
  if (next == end) at.row = at.last_row;
  dropped = filled.gone;
  return filled.n;
}

template <bool Spin, bool Turn>
SCREE_STAGE bool geometry(const BallView& b, uint32_t n, double dt, double overlap_limit, Scratch& s) {
  int coincident = 0;
#pragma omp simd reduction(| : coincident)
  for (uint32_t k = 0; k < n; ++k) coincident |= s.square[k] < vanishing;
  for (uint32_t k = 0; k < n; ++k) s.sign[k] = s.where[k] & target::flip ? -1.0 : 1.0;
  if (coincident) part_coincident(n, s);
  const double *vx = b.vx, *vy = b.vy, *vz = b.vz, *wx = b.wx, *wy = b.wy, *wz = b.wz;
  const double *radius = b.radius, *inverse = b.inverse_mass;
  const uint32_t *row = s.row, *other = s.other;
  double *nx = s.nx, *ny = s.ny, *nz = s.nz, *gap = s.gap, *square = s.square;
  const auto one = [&](uint32_t k) SCREE_BODY {
    const auto i = static_cast<int32_t>(row[k]), j = static_cast<int32_t>(other[k]);  // gathers want signed
    const double sign = s.sign[k], ri = radius[i], rj = radius[j];
    const double distance = std::sqrt(square[k]), per = sign / distance;
    const double px = nx[k], py = ny[k], pz = nz[k];
    const double x = px * per, y = py * per, z = pz * per;
    const double opening = distance - gap[k];
    double ux = vx[j] - vx[i], uy = vy[j] - vy[i], uz = vz[j] - vz[i];
    const double cx = ux, cy = uy, cz = uz;
    const double arm_i = ri + 0.5 * opening, arm_j = rj + 0.5 * opening;
    if constexpr (Spin) {
      const double wix = wx[i], wiy = wy[i], wiz = wz[i], wjx = wx[j], wjy = wy[j], wjz = wz[j];
      // Surface velocity of both pieces at the contact point; the unsigned normal is sign times (x, y, z).
      const double sx = wix * arm_i + wjx * arm_j, sy = wiy * arm_i + wjy * arm_j, sz = wiz * arm_i + wjz * arm_j;
      double ax = sign * x, ay = sign * y, az = sign * z;
      if constexpr (Turn) {
        // Velocities are those of half a step back, and so must be the arms: with those of now a bonded body that
        // turns about an axis oblique to a bond creeps by (n.w) w dt/2.
        const double hx = px - 0.5 * dt * cx, hy = py - 0.5 * dt * cy, hz = pz - 0.5 * dt * cz;
        const double half = hx * hx + hy * hy + hz * hz, back = half > 0 ? 1 / std::sqrt(half) : 0.0;
        ax = hx * back;
        ay = hy * back;
        az = hz * back;
      }
      ux -= sy * az - sz * ay;
      uy -= sz * ax - sx * az;
      uz -= sx * ay - sy * ax;
      s.wx[k] = sign * (wjx - wix);
      s.wy[k] = sign * (wjy - wiy);
      s.wz[k] = sign * (wjz - wiz);
      if constexpr (Turn) {
        // Tilt of the normal: the turn from the old separation p - c dt to p; then the mean spin about the normal.
        const double ox = px - cx * dt, oy = py - cy * dt, oz = pz - cz * dt;
        const double length = std::sqrt(ox * ox + oy * oy + oz * oz);
        const double both = length * distance + (ox * px + oy * py + oz * pz);
        const double tilt = both > 0 ? 2 * dt / both : 0.0;
        const double about = 0.5 * dt * ((wix + wjx) * x + (wiy + wjy) * y + (wiz + wjz) * z);
        s.tx[k] = tilt * (py * cz - pz * cy) + about * x;
        s.ty[k] = tilt * (pz * cx - px * cz) + about * y;
        s.tz[k] = tilt * (px * cy - py * cx) + about * z;
      }
      s.arm_i[k] = arm_i;
      s.arm_j[k] = arm_j;
    }
    nx[k] = x;
    ny[k] = y;
    nz[k] = z;
    gap[k] = opening;
    s.vx[k] = sign * ux;
    s.vy[k] = sign * uy;
    s.vz[k] = sign * uz;
    s.r1[k] = sign > 0 ? ri : rj;
    s.r2[k] = sign > 0 ? rj : ri;
    const double total = inverse[i] + inverse[j];
    s.mass[k] = total > 0 ? 1.0 / total : 0.0;
    square[k] = -opening - overlap_limit * (ri < rj ? ri : rj);
  };
#pragma omp simd
  for (uint32_t k = 0; k < n; ++k) one(k);
  int beyond = 0;
#pragma omp simd reduction(| : beyond)
  for (uint32_t k = 0; k < n; ++k) beyond |= square[k] > 0;
  return beyond != 0;
}

// Record words: lean fx fy fz sum; with spin fx fy fz mx my mz sum (unused).
template <bool Lean, bool Spin, bool Moment, bool Sum>
SCREE_STAGE bool scatter(uint32_t n, std::size_t first_row, double* slice, Scratch& s) {
  constexpr std::size_t stride = Lean ? 4 : 8;
  double *fx = s.fx, *fy = s.fy, *fz = s.fz, *mx = s.mx, *my = s.my, *mz = s.mz, *size = s.square;
  double squares[Scratch::size];
  const auto one = [&](uint32_t k) SCREE_BODY {
    const double sign = s.sign[k], x = fx[k], y = fy[k], z = fz[k];
    double square = x * x + y * y + z * z;
    if constexpr (Sum) size[k] = std::sqrt(square);
    if constexpr (Spin) {
      // Torque of the force about each centre, per unit of arm; the same for both pieces.
      s.tx[k] = s.ny[k] * z - s.nz[k] * y;
      s.ty[k] = s.nz[k] * x - s.nx[k] * z;
      s.tz[k] = s.nx[k] * y - s.ny[k] * x;
      if constexpr (Moment) {
        square += mx[k] * mx[k] + my[k] * my[k] + mz[k] * mz[k];
        mx[k] *= sign;
        my[k] *= sign;
        mz[k] *= sign;
      }
    }
    fx[k] = sign * x;
    fy[k] = sign * y;
    fz[k] = sign * z;
    squares[k] = square;
  };
#pragma omp simd
  for (uint32_t k = 0; k < n; ++k) one(k);
  int useless = 0;
#pragma omp simd reduction(| : useless)
  for (uint32_t k = 0; k < n; ++k) useless |= !(squares[k] <= largest_square);
  for (uint32_t k = 0; k < n; ++k) {
    double* a = slice + (s.row[k] - first_row) * stride;
    double* b = slice + (s.where[k] & target::record_mask) * stride;
    const double x = fx[k], y = fy[k], z = fz[k];
    a[0] -= x;
    a[1] -= y;
    a[2] -= z;
    b[0] += x;
    b[1] += y;
    b[2] += z;
    if constexpr (Sum) {
      constexpr std::size_t word = Lean ? 3 : 6;
      a[word] += size[k];
      b[word] += size[k];
    }
    if constexpr (Spin) {
      const double arm_i = s.arm_i[k], arm_j = s.arm_j[k], tx = s.tx[k], ty = s.ty[k], tz = s.tz[k];
      if constexpr (Moment) {
        a[3] -= mx[k];
        a[4] -= my[k];
        a[5] -= mz[k];
        b[3] += mx[k];
        b[4] += my[k];
        b[5] += mz[k];
      }
      a[3] -= arm_i * tx;
      a[4] -= arm_i * ty;
      a[5] -= arm_i * tz;
      b[3] -= arm_j * tx;
      b[4] -= arm_j * ty;
      b[5] -= arm_j * tz;
    }
  }
  return useless != 0;
}

// One struct of static functions per instruction set; the macro is the only way to put the attribute on each.
#define SCREE_STAGES(NAME, TARGET, COMPACTION)                                                                 \
  struct NAME {                                                                                                \
    template <bool P>                                                                                          \
    TARGET static uint32_t filter_stage(const BallView& b, const FilterInput& in, Cursor& at, uint8_t* active, \
                                        Scratch& s, uint32_t* drops, uint32_t& dropped) {                      \
      return filter<P, COMPACTION>(b, in, at, active, s, drops, dropped);                                      \
    }                                                                                                          \
    template <bool S, bool T>                                                                                  \
    TARGET static bool geometry_stage(const BallView& b, uint32_t n, double dt, double limit, Scratch& s) {    \
      return geometry<S, T>(b, n, dt, limit, s);                                                               \
    }                                                                                                          \
    template <bool L, bool S, bool M, bool F>                                                                  \
    TARGET static bool scatter_stage(uint32_t n, std::size_t first, double* slice, Scratch& s) {               \
      return scatter<L, S, M, F>(n, first, slice, s);                                                          \
    }                                                                                                          \
    static constexpr StageTable table() {                                                                      \
      return {{filter_stage<false>, filter_stage<true>},                                                       \
              {{geometry_stage<false, false>, geometry_stage<false, false>},                                   \
               {geometry_stage<true, false>, geometry_stage<true, true>}},                                     \
              {{{scatter_stage<true, false, false, false>, scatter_stage<true, false, false, true>},           \
                {scatter_stage<true, false, false, false>, scatter_stage<true, false, false, true>}},          \
               {{scatter_stage<false, false, false, false>, scatter_stage<false, false, false, true>},         \
                {scatter_stage<false, false, false, false>, scatter_stage<false, false, false, true>}},        \
               {{scatter_stage<false, true, false, false>, scatter_stage<false, true, false, true>},           \
                {scatter_stage<false, true, true, false>, scatter_stage<false, true, true, true>}}}};          \
    }                                                                                                          \
  };

SCREE_STAGES(Baseline, __attribute__((flatten)), PortableCompaction)
#if defined(__x86_64__)
SCREE_STAGES(V3, __attribute__((target("arch=x86-64-v3"), flatten)), PortableCompaction)
SCREE_STAGES(V4, __attribute__((target("arch=x86-64-v4"), flatten)), Avx512Compaction)
#else
using V3 = Baseline;
using V4 = Baseline;
#endif

constexpr StageTable tables[3] = {Baseline::table(), V3::table(), V4::table()};

}  // namespace

BallView::BallView(const Balls& balls)
    : x(balls[Column::x]),
      y(balls[Column::y]),
      z(balls[Column::z]),
      vx(balls[Column::vx]),
      vy(balls[Column::vy]),
      vz(balls[Column::vz]),
      wx(balls[Column::wx]),
      wy(balls[Column::wy]),
      wz(balls[Column::wz]),
      radius(balls[Column::radius]),
      inverse_mass(balls[Column::inverse_mass]) {}

const StageTable& stages(int isa) { return tables[isa]; }

}  // namespace scree::core
