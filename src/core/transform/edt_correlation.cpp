#include "core/transform/edt_correlation.h"

#include <algorithm>

#if defined(__x86_64__)
#pragma GCC diagnostic push
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // from GCC 12's own AVX-512 header
#endif
#include <immintrin.h>
#endif

namespace pcl_symmetry {

namespace {

void productsScalar(const GaussianEdt& edt, const float* f, const ImageOfRow& image, GaussianEdt::Range cells,
                    double* sums) {
  for (int x = cells.begin; x < cells.end; ++x)
    if (f[x] > 0.0f) sums[(x - cells.begin) % num_product_sums] += f[x] * edt.atCell(image.first + x * image.step);
}

#if defined(__x86_64__)

/// The same by eight cells at a time: the steps of GaussianEdt::atCell().
__attribute__((target("avx512f"))) void productsAvx512(const GaussianEdt& edt, const float* f, const ImageOfRow& image,
                                                       GaussianEdt::Range cells, double* sums) {
  const int n = edt.numCells();
  const float* const table = edt.interpolation().data();
  const __m512d zero = _mm512_setzero_pd(), last = _mm512_set1_pd(n - 1.0), one_more = _mm512_set1_pd(num_product_sums);
  const __m256i side = _mm256_set1_epi32(n);
  __m512d sum = _mm512_loadu_pd(sums);
  __m512d place = _mm512_add_pd(_mm512_set1_pd(cells.begin), _mm512_setr_pd(0, 1, 2, 3, 4, 5, 6, 7));
  for (int x = cells.begin; x < cells.end; x += num_product_sums, place = _mm512_add_pd(place, one_more)) {
    const auto there = static_cast<__mmask8>((1u << std::min(num_product_sums, cells.end - x)) - 1u);
    const __m512d own = _mm512_cvtps_pd(_mm512_castps512_ps256(_mm512_maskz_loadu_ps(there, f + x)));
    __m512d at[3];
    for (int axis = 0; axis < 3; ++axis)
      at[axis] =
          _mm512_add_pd(_mm512_set1_pd(image.first[axis]), _mm512_mul_pd(place, _mm512_set1_pd(image.step[axis])));
    __mmask8 inside = _mm512_cmp_pd_mask(own, zero, _CMP_GT_OQ);
    inside = _mm512_mask_cmp_pd_mask(inside, _mm512_min_pd(_mm512_min_pd(at[0], at[1]), at[2]), zero, _CMP_GE_OQ);
    inside = _mm512_mask_cmp_pd_mask(inside, _mm512_max_pd(_mm512_max_pd(at[0], at[1]), at[2]), last, _CMP_LT_OQ);
    if (inside == 0) continue;
    __m256i cell[3];
    __m512d beyond[3];  // the cell's center
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = _mm512_cvttpd_epi32(at[axis]);
      beyond[axis] = _mm512_sub_pd(at[axis], _mm512_cvtepi32_pd(cell[axis]));
    }
    const __m256i index = _mm256_add_epi32(
        _mm256_mullo_epi32(_mm256_add_epi32(_mm256_mullo_epi32(cell[2], side), cell[1]), side), cell[0]);
    const auto row = [&](int offset) __attribute__((target("avx512f"), always_inline)) {
      // Two neighbors along x by one load.
      const __m512i pair = _mm512_mask_i32gather_epi64(_mm512_setzero_si512(), inside, index, table + offset, 4);
      const __m256 here = _mm256_castsi256_ps(_mm512_cvtepi64_epi32(pair));
      const __m256 next = _mm256_castsi256_ps(_mm512_cvtepi64_epi32(_mm512_srli_epi64(pair, 32)));
      return _mm512_add_pd(_mm512_cvtps_pd(here), _mm512_mul_pd(beyond[0], _mm512_cvtps_pd(_mm256_sub_ps(next, here))));
    };
    const auto between = [&](__m512d a, __m512d b, __m512d t) __attribute__((target("avx512f"), always_inline)) {
      return _mm512_add_pd(a, _mm512_mul_pd(t, _mm512_sub_pd(b, a)));
    };
    const __m512d near = between(row(0), row(n), beyond[1]), far = between(row(n * n), row(n * n + n), beyond[1]);
    sum = _mm512_add_pd(sum, _mm512_maskz_mul_pd(inside, own, between(near, far, beyond[2])));
  }
  _mm512_storeu_pd(sums, sum);
}

#pragma GCC diagnostic pop
#endif

}  // namespace

RowProducts rowProducts() {
#if defined(__x86_64__)
  static const bool has_avx512 = __builtin_cpu_supports("avx512f");
  if (has_avx512) return productsAvx512;
#endif
  return productsScalar;
}

}  // namespace pcl_symmetry
