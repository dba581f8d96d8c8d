#include "core/contact/near_run.hpp"

namespace scree::core {

namespace {

#define SCREE_BODY __attribute__((always_inline))

inline SCREE_BODY uint32_t near_balls(const NearRun& run, uint32_t* hits) {
  const double *x = run.x, *y = run.y, *z = run.z, *radius = run.radius;
  const double px = run.at[0], py = run.at[1], pz = run.at[2], own = run.own, margin = run.margin;
  const double ex = run.edge[0], ey = run.edge[1], ez = run.edge[2];
  const double hx = run.half[0], hy = run.half[1], hz = run.half[2];
  int64_t near[NearRun::most];
  for (uint32_t first = 0; first < run.count; first += 8)
#pragma omp simd
    for (uint32_t k = first; k < first + 8; ++k) {
      double dx = x[k] - px, dy = y[k] - py, dz = z[k] - pz;
      dx -= dx > hx ? ex : dx < -hx ? -ex : 0.0;
      dy -= dy > hy ? ey : dy < -hy ? -ey : 0.0;
      dz -= dz > hz ? ez : dz < -hz ? -ez : 0.0;
      const double limit = own + radius[k] + margin;
      near[k] = dx * dx + dy * dy + dz * dz >= limit * limit ? 0 : 1;
    }
  uint32_t n = 0;
  for (uint32_t k = 0; k < run.count; ++k) {
    hits[n] = k;
    n += static_cast<uint32_t>(near[k]);
  }
  return n;
}

__attribute__((flatten)) uint32_t baseline(const NearRun& run, uint32_t* hits) { return near_balls(run, hits); }
#if defined(__x86_64__)
__attribute__((target("arch=x86-64-v3"), flatten)) uint32_t v3(const NearRun& run, uint32_t* hits) {
  return near_balls(run, hits);
}
__attribute__((target("arch=x86-64-v4"), flatten)) uint32_t v4(const NearRun& run, uint32_t* hits) {
  return near_balls(run, hits);
}
constexpr NearStage stages_of[3] = {baseline, v3, v4};
#else
constexpr NearStage stages_of[3] = {baseline, baseline, baseline};
#endif

}  // namespace

NearStage near_stage(int isa) { return stages_of[isa]; }

}  // namespace scree::core
