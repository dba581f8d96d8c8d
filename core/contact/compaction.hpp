#pragma once
#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/contact/scratch.hpp"
#include "core/contact/stages.hpp"

namespace scree::core {

/// A measured window on its way into the batch.
struct Measured {
  uint64_t next;    ///< its first slot
  uint32_t m;       ///< its slots, at most Window::size
  uint8_t* active;  ///< of the list's first slot
  uint32_t* drops;  ///< slots whose contact has just ended
};
struct Filled {
  uint32_t n, gone;  ///< contacts in the batch, entries of `drops`
};

/// Moves what touches in a window to the end of the batch. No branch: whether a listed pair touches is as good as
/// random, and a wrong guess costs more than the rest.
struct PortableCompaction {
  static inline __attribute__((always_inline)) Filled move(const FilterInput& in, const Measured& from, Filled to,
                                                           Scratch& s) {
    const Window& w = s.window;
    const auto base = static_cast<uint32_t>(from.next);
    uint8_t* active = from.active + from.next;
    uint32_t n = to.n, gone = to.gone;
    for (uint32_t k = 0; k < from.m; ++k) {
      const auto near = static_cast<uint32_t>(w.near[k]), was = static_cast<uint32_t>(active[k]);
      s.slot[n] = base + k;
      from.drops[gone] = base + k;
      active[k] = static_cast<uint8_t>(was & near);
      gone += was & (near ^ 1u);
      n += near;
    }
    for (uint32_t q = to.n; q < n; ++q) {
      const uint32_t slot = s.slot[q], k = slot - base;
      s.row[q] = w.row[k];
      s.other[q] = in.other[slot];
      s.where[q] = in.where[slot];
      s.nx[q] = w.x[k];
      s.ny[q] = w.y[k];
      s.nz[q] = w.z[k];
      s.square[q] = w.square[k];
      s.gap[q] = w.sum[k];
    }
    return {n, gone};
  }
};

#if defined(__x86_64__)
/// The same with the compress instructions of AVX-512, eight slots at a time. Into registers and then to memory whole:
/// compressing straight to memory is microcode on some processors.
class Avx512Compaction {
#define SCREE_AVX512 __attribute__((target("arch=x86-64-v4")))

 public:
  SCREE_AVX512 static Filled move(const FilterInput& in, const Measured& from, Filled to, Scratch& s) {
    const Window& w = s.window;
    uint32_t n = to.n, gone = to.gone;
    const __m256i eight = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    for (uint32_t k = 0; k < from.m; k += 8) {
      const uint64_t first = from.next + k;
      const auto valid = static_cast<__mmask8>(from.m - k < 8 ? (1u << (from.m - k)) - 1u : 0xffu);
      const auto near =
          static_cast<__mmask8>(valid & _mm512_test_epi64_mask(_mm512_loadu_si512(w.near + k), _mm512_set1_epi64(1)));
      const __m128i was = _mm_maskz_loadu_epi8(valid, from.active + first);
      const auto was_active = static_cast<uint32_t>(_mm_test_epi8_mask(was, was));
      _mm_mask_storeu_epi8(from.active + first, valid,
                           _mm_maskz_set1_epi8(static_cast<__mmask16>(was_active & near), 1));
      for (uint32_t left = was_active & ~uint32_t{near}; left != 0; left &= left - 1)
        from.drops[gone++] = static_cast<uint32_t>(first) + static_cast<uint32_t>(__builtin_ctz(left));
      put(near, w.x + k, s.nx + n);
      put(near, w.y + k, s.ny + n);
      put(near, w.z + k, s.nz + n);
      put(near, w.square + k, s.square + n);
      put(near, w.sum + k, s.gap + n);
      put(near, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(w.row + k)), s.row + n);
      put(near, _mm256_maskz_loadu_epi32(valid, in.other + first), s.other + n);
      put(near, _mm256_maskz_loadu_epi32(valid, in.where + first), s.where + n);
      put(near, _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first)), eight), s.slot + n);
      n += static_cast<uint32_t>(__builtin_popcount(near));
    }
    return {n, gone};
  }

 private:
  SCREE_AVX512 static void put(__mmask8 mask, const double* source, double* target) {
    _mm512_storeu_pd(target, _mm512_maskz_compress_pd(mask, _mm512_loadu_pd(source)));
  }
  SCREE_AVX512 static void put(__mmask8 mask, __m256i value, uint32_t* target) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(target), _mm256_maskz_compress_epi32(mask, value));
  }
#undef SCREE_AVX512
};
#endif

}  // namespace scree::core
