#include "core/transform/line_kernel.h"

#include <algorithm>
#include <cmath>

#include "core/base/simd.h"
#include "core/transform/lookup_table.h"

#if defined(__x86_64__)
#include <immintrin.h>
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
  constexpr int num_lanes = kLineLanes;
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

#endif

template <int kFunctions>
LineKernel kernelOf(Simd simd) {
#if defined(__x86_64__)
  if (simd == Simd::Avx2 || (simd == Simd::Auto && simdSupported(Simd::Avx2))) return accumulateAvx2<kFunctions>;
#endif
  return accumulateScalar<kFunctions>;
}

}  // namespace

LineKernel lineKernel(Simd simd, int num_functions) {
  return num_functions == 1 ? kernelOf<1>(simd) : kernelOf<LookupTable::kMaxFunctions>(simd);
}

}  // namespace pcl_symmetry
