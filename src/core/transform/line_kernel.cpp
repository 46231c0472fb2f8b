#include "core/transform/line_kernel.h"

#include <algorithm>
#include <cmath>

#include "core/base/simd.h"
#include "core/transform/lookup_table.h"

#if defined(__x86_64__)
#pragma GCC diagnostic push
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuninitialized"  // from GCC 12's own AVX-512 header
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>
#pragma GCC diagnostic pop
#endif

namespace pcl_symmetry {

PCL_SYMMETRY_MULTIVERSION
void setUpLines(const SampleCoordinates& points, const ParallelPlanes& planes, const CubeInTable& cube, Lines& lines) {
  const float nx = planes.normal[0], ny = planes.normal[1], nz = planes.normal[2];
  const float offset = planes.offset, inverse_step = 1.0f / planes.step, last = static_cast<float>(planes.count);
  const float middle = cube.middle, sq_clip = cube.sq_clip, to_table = cube.to_table;
  const float one = static_cast<float>(1 << LookupTable::kFractionBits);
  std::int32_t *const lx = lines.x, *const ly = lines.y, *const lz = lines.z;
  std::int32_t *const k_begin = lines.k_begin, *const k_end = lines.k_end;
  const float *const px = points.x, *const py = points.y, *const pz = points.z;
  const int size = lines.size;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const float x = px[i] - middle, y = py[i] - middle, z = pz[i] - middle;
    const float along = nx * x + ny * y + nz * z;
    const float shift = 2.0f * (offset - along);
    lx[i] = static_cast<std::int32_t>((x + shift * nx + to_table) * one);
    ly[i] = static_cast<std::int32_t>((y + shift * ny + to_table) * one);
    lz[i] = static_cast<std::int32_t>((z + shift * nz + to_table) * one);
    // The reflected point lies at 2 r - along on the line through x: inside the ball while |2 r - along| <= chord.
    const float sq_chord = sq_clip - (x * x + y * y + z * z - along * along);
    const float chord = std::sqrt(std::max(0.0f, sq_chord));
    const float begin = std::ceil((0.5f * (along - chord) - offset) * inverse_step);
    const float end = std::floor((0.5f * (along + chord) - offset) * inverse_step) + 1.0f;
    const auto k = static_cast<std::int32_t>(std::min(std::max(begin, 0.0f), last));
    const auto k_behind = static_cast<std::int32_t>(std::min(std::max(end, 0.0f), last));
    k_begin[i] = k;
    k_end[i] = (sq_chord > 0.0f) & (k_behind > k) ? k_behind : 0;
  }
}

namespace {

template <int kFunctions>
void accumulateScalar(const Lines& lines, const std::uint8_t* table, int bits, std::int32_t* const* sums) {
  for (int i = 0; i < lines.size; ++i) {
    for (std::int32_t k = lines.k_begin[i]; k < lines.k_end[i]; ++k) {
      const std::size_t index = LookupTable::index(lines.x[i] + k * lines.step[0], lines.y[i] + k * lines.step[1],
                                                   lines.z[i] + k * lines.step[2], bits);
      for (int g = 0; g < kFunctions; ++g) sums[g][k] += table[kFunctions * index + g];
    }
  }
}

#if defined(__x86_64__)

template <int kFunctions>
__attribute__((target("avx2"))) void accumulateAvx2(const Lines& lines, const std::uint8_t* table, int bits,
                                                    std::int32_t* const* sums) {
  constexpr int num_lanes = 8;
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i byte = _mm256_set1_epi32(0xFF);
  const __m256i zero = _mm256_setzero_si256();
  const __m128i fraction = _mm_cvtsi32_si128(LookupTable::kFractionBits);
  const __m128i row = _mm_cvtsi32_si128(bits), slice = _mm_cvtsi32_si128(2 * bits);
  __m256i ramp[3], stride[3];
  for (int axis = 0; axis < 3; ++axis) {
    ramp[axis] = _mm256_mullo_epi32(lane, _mm256_set1_epi32(lines.step[axis]));
    stride[axis] = _mm256_set1_epi32(num_lanes * lines.step[axis]);
  }
  for (int i = 0; i < lines.size; ++i) {
    const std::int32_t k_begin = lines.k_begin[i], k_end = lines.k_end[i];
    std::int32_t k = k_begin & ~(num_lanes - 1);
    __m256i x = _mm256_add_epi32(_mm256_set1_epi32(lines.x[i] + k * lines.step[0]), ramp[0]);
    __m256i y = _mm256_add_epi32(_mm256_set1_epi32(lines.y[i] + k * lines.step[1]), ramp[1]);
    __m256i z = _mm256_add_epi32(_mm256_set1_epi32(lines.z[i] + k * lines.step[2]), ramp[2]);
    const __m256i before = _mm256_set1_epi32(k_begin - 1), behind = _mm256_set1_epi32(k_end);
    for (; k < k_end; k += num_lanes) {
      const __m256i at = _mm256_add_epi32(_mm256_set1_epi32(k), lane);
      const __m256i inside = _mm256_and_si256(_mm256_cmpgt_epi32(at, before), _mm256_cmpgt_epi32(behind, at));
      const __m256i index = _mm256_add_epi32(_mm256_add_epi32(_mm256_sll_epi32(_mm256_sra_epi32(z, fraction), slice),
                                                              _mm256_sll_epi32(_mm256_sra_epi32(y, fraction), row)),
                                             _mm256_sra_epi32(x, fraction));
      __m256i values =
          _mm256_mask_i32gather_epi32(zero, reinterpret_cast<const int*>(table), index, inside, kFunctions);
      for (int g = 0; g < kFunctions; ++g) {
        auto* sum = reinterpret_cast<__m256i*>(sums[g] + k);
        _mm256_storeu_si256(sum, _mm256_add_epi32(_mm256_loadu_si256(sum), _mm256_and_si256(values, byte)));
        values = _mm256_srli_epi32(values, 8);
      }
      x = _mm256_add_epi32(x, stride[0]);
      y = _mm256_add_epi32(y, stride[1]);
      z = _mm256_add_epi32(z, stride[2]);
    }
  }
}

/// Goes block by block of planes, and through the lines that have some of them inside: the sums stay in registers, and
/// no branch asks how many planes a line has.
template <int kFunctions>
__attribute__((target("avx512f"))) void accumulateAvx512(const Lines& lines, const std::uint8_t* table, int bits,
                                                         std::int32_t* const* sums) {
  constexpr int num_lanes = kLineLanes;
  const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i byte = _mm512_set1_epi32(0xFF);
  const __m512i zero = _mm512_setzero_si512();
  const __m128i fraction = _mm_cvtsi32_si128(LookupTable::kFractionBits);
  // Whole cells along y go to their place in the index by one shift.
  const __m128i to_row = _mm_cvtsi32_si128(LookupTable::kFractionBits - bits), slice = _mm_cvtsi32_si128(2 * bits);
  const __m512i of_row = _mm512_set1_epi32(((1 << bits) - 1) << bits);
  std::int32_t chosen[kMostLines + num_lanes];
  for (std::int32_t first = 0; first < lines.count; first += num_lanes) {
    const __m512i begin = _mm512_set1_epi32(first), end = _mm512_set1_epi32(first + num_lanes);
    int num_chosen = 0;
    for (int i = 0; i < lines.size; i += num_lanes) {
      const auto there = static_cast<__mmask16>((1u << std::min(num_lanes, lines.size - i)) - 1u);
      const __m512i k_begin = _mm512_maskz_loadu_epi32(there, lines.k_begin + i),
                    k_end = _mm512_maskz_loadu_epi32(there, lines.k_end + i);
      const __mmask16 some =
          _mm512_mask_cmpgt_epi32_mask(_mm512_mask_cmplt_epi32_mask(there, k_begin, end), k_end, begin);
      _mm512_storeu_si512(chosen + num_chosen,
                          _mm512_maskz_compress_epi32(some, _mm512_add_epi32(_mm512_set1_epi32(i), lane)));
      num_chosen += __builtin_popcount(some);
    }
    const __m512i at = _mm512_add_epi32(begin, lane);
    __m512i moved[3], total[kFunctions];
    for (int axis = 0; axis < 3; ++axis) moved[axis] = _mm512_mullo_epi32(at, _mm512_set1_epi32(lines.step[axis]));
    for (__m512i& sum : total) sum = zero;
    for (int c = 0; c < num_chosen; ++c) {
      const std::int32_t i = chosen[c];
      const __m512i x = _mm512_add_epi32(_mm512_set1_epi32(lines.x[i]), moved[0]);
      const __m512i y = _mm512_add_epi32(_mm512_set1_epi32(lines.y[i]), moved[1]);
      const __m512i z = _mm512_add_epi32(_mm512_set1_epi32(lines.z[i]), moved[2]);
      const __mmask16 inside = _mm512_mask_cmplt_epi32_mask(
          _mm512_cmpge_epi32_mask(at, _mm512_set1_epi32(lines.k_begin[i])), at, _mm512_set1_epi32(lines.k_end[i]));
      constexpr int and_or = 0xEA;  // the table of (a and b) or c
      const __m512i in_row =
          _mm512_ternarylogic_epi32(_mm512_sra_epi32(y, to_row), of_row, _mm512_sra_epi32(x, fraction), and_or);
      const __m512i index = _mm512_add_epi32(_mm512_sll_epi32(_mm512_sra_epi32(z, fraction), slice), in_row);
      __m512i values = _mm512_mask_i32gather_epi32(zero, inside, index, table, kFunctions);
      for (__m512i& sum : total) {
        sum = _mm512_add_epi32(sum, _mm512_and_si512(values, byte));
        values = _mm512_srli_epi32(values, 8);
      }
    }
    for (int g = 0; g < kFunctions; ++g) {
      std::int32_t* const sum = sums[g] + first;
      _mm512_storeu_si512(sum, _mm512_add_epi32(_mm512_loadu_si512(sum), total[g]));
    }
  }
}

#endif

template <int kFunctions>
LineKernel kernelOf(Simd simd) {
#if defined(__x86_64__)
  if (simd == Simd::Avx512 || (simd == Simd::Auto && simdSupported(Simd::Avx512))) return accumulateAvx512<kFunctions>;
  if (simd == Simd::Avx2 || (simd == Simd::Auto && simdSupported(Simd::Avx2))) return accumulateAvx2<kFunctions>;
#endif
  return accumulateScalar<kFunctions>;
}

}  // namespace

LineKernel lineKernel(Simd simd, int num_functions) {
  return num_functions == 1 ? kernelOf<1>(simd) : kernelOf<LookupTable::kMaxFunctions>(simd);
}

}  // namespace pcl_symmetry
