#include "core/transform/bundle_kernels.h"

#include <algorithm>
#include <cstring>

#include "core/base/x86_intrinsics.h"
#include "core/transform/lookup_table.h"

namespace pcl_symmetry {

namespace {

constexpr int second_of_pair = static_cast<int>(0xFFFF0000);  // the upper half of 32 bits

/// Where the bytes of each point lie in the rows of cells, worked out side by side where instructions allow it.
[[gnu::always_inline]] inline void offsetsInRows(const Bundle& bundle, const RowTable::Rows& rows,
                                                 std::int32_t* __restrict offsets) {
  const auto [starts, step, first, last] = bundle;
  const std::int32_t* __restrict const of_x = rows.of_x;
  const int of_y = rows.of_y, of_z = rows.of_z, least_x = rows.least_x, last_cell = rows.last;
  for (int r = 0; r < kBundleRows; ++r) {
    for (int l = first; l < last; ++l) {
      const auto cell = [&](int axis, int least) {
        const int at = (starts[r][axis] + l * step[axis]) >> LookupTable::kFractionBits;
        return at < least ? least : at > last_cell ? last_cell : at;
      };
      offsets[r * (last - first) + l - first] = cell(2, 0) * of_z + cell(1, 0) * of_y + of_x[cell(0, least_x)];
    }
  }
}

void lookUpScalar(const Bundle& bundle, const RowTable::Rows& rows, BundleValues& values) {
  offsetsInRows(bundle, rows, values.offsets.data());
  const auto store = [&](int l, int j, std::int16_t value) {
    values.aheadAt(l)[2 * j] = values.aheadAt(l - 1)[2 * j + 1] = static_cast<std::int16_t>(2 * value);
    values.backAt(l)[2 * j] = values.backAt(l + 1)[2 * j + 1] = value;
  };
  for (int l = bundle.first - BundleValues::kMargin + 1; l < bundle.last + BundleValues::kMargin - 1; ++l) {
    std::uint8_t lanes[kBundleLanes] = {};
    for (int r = 0; l >= bundle.first && l < bundle.last && r < kBundleRows; ++r)
      std::memcpy(lanes + r * kRowLanes,
                  rows.bytes + values.offsets[r * (bundle.last - bundle.first) + l - bundle.first], kRowLanes);
    for (int j = 0; j < kBundleLanes; ++j) store(l, j, lanes[j]);
  }
  values.first = bundle.first;
  values.last = bundle.last;
}

void correlateScalar(const BundleValues& values, std::int32_t* sums) {
  for (int a = values.first; a < values.last; ++a) {
    for (int b = values.first; b < values.last; ++b) {
      for (int j = 0; j < kBundleLanes; ++j)
        sums[(a + b) * kBundleLanes + j] += values.backAt(a)[2 * j] * values.backAt(b)[2 * j];
    }
  }
}

/// Steps of two points that the sums of points c to c + 3 take from the middle to the nearer end.
inline int numSteps(const BundleValues& values, int c) {
  int most = 0;
  for (int i = c; i < c + 4; ++i) most = std::max(most, std::min(i - values.first, values.last - 1 - i));
  return most / 2 + 1;
}

#if defined(__x86_64__)

/// \return the bytes of a point in the lanes of all rows.
__attribute__((target("avx2"))) inline __m128i lanesAt(const std::uint8_t* bytes, const std::int32_t* offsets,
                                                       int num_points) {
  static_assert(kRowLanes == 8 && kBundleRows == 2, "lanes of a row are loaded as one half");
  const auto of_row = [&](int r) __attribute__((target("avx2"), always_inline)) {
    return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes + offsets[r * num_points]));
  };
  return _mm_unpacklo_epi64(of_row(0), of_row(1));
}

__attribute__((target("avx2"))) inline __m256i pairsOf(const std::int16_t* pairs) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(pairs));
}

__attribute__((target("avx2"))) inline void storePairs(std::int16_t* to, __m256i low, __m256i high) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), low);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to) + 1, high);
}

__attribute__((target("avx2"))) inline bool areZero(const std::int16_t* pairs) {
  const __m256i any = _mm256_or_si256(pairsOf(pairs), pairsOf(pairs + BundleValues::kPairs / 2));
  return _mm256_testz_si256(any, any) != 0;
}

__attribute__((target("avx2"))) void lookUpAvx2(const Bundle& bundle, const RowTable::Rows& rows,
                                                BundleValues& values) {
  offsetsInRows(bundle, rows, values.offsets.data());
  const std::int32_t* const offsets = values.offsets.data();
  int first = bundle.first, last = bundle.last;
  const __m256i zero = _mm256_setzero_si256();
  __m256i low_before = zero, high_before = zero;
  std::int16_t *ahead = values.aheadAt(first - 1), *back = values.backAt(first);
  const auto store = [&](__m256i low, __m256i high) __attribute__((target("avx2"), always_inline)) {
    const __m256i low_pairs = _mm256_or_si256(low_before, _mm256_slli_epi32(low, 16));
    const __m256i high_pairs = _mm256_or_si256(high_before, _mm256_slli_epi32(high, 16));
    storePairs(ahead, _mm256_add_epi32(low_pairs, low_pairs), _mm256_add_epi32(high_pairs, high_pairs));
    storePairs(back, _mm256_or_si256(low, _mm256_slli_epi32(low_before, 16)),
               _mm256_or_si256(high, _mm256_slli_epi32(high_before, 16)));
    low_before = low;
    high_before = high;
    ahead += BundleValues::kPairs;
    back += BundleValues::kPairs;
  };
  for (int l = first; l < last; ++l) {
    const __m128i bytes = lanesAt(rows.bytes, offsets + l - bundle.first, bundle.last - bundle.first);
    store(_mm256_cvtepu8_epi32(bytes), _mm256_cvtepu8_epi32(_mm_srli_si128(bytes, 8)));
  }
  store(zero, zero);
  for (int i = 0; i < BundleValues::kMargin - 1; ++i) {
    storePairs(values.aheadAt(first - 2 - i), zero, zero);
    storePairs(values.aheadAt(last + i), zero, zero);
    storePairs(values.backAt(last + 1 + i), zero, zero);
  }
  while (first < last && areZero(values.aheadAt(first))) ++first;
  while (first < last && areZero(values.backAt(last - 1))) --last;
  values.first = first;
  values.last = last;
}

__attribute__((target("avx2"))) void correlateAvx2(const BundleValues& values, std::int32_t* sums) {
  for (int c = values.first; c < values.last; c += 4) {
    const int num_steps = numSteps(values, c);
    for (int half = 0; half < BundleValues::kPairs; half += BundleValues::kPairs / 2) {
      __m256i even[4], odd[4];
      const std::int16_t *a = values.aheadAt(c - 1) + half, *b = values.backAt(c + 1) + half;
      for (int i = 0; i < 4; ++i) {
        const __m256i ahead = pairsOf(a + i * BundleValues::kPairs);
        const __m256i self = _mm256_srli_epi32(_mm256_and_si256(ahead, _mm256_set1_epi32(second_of_pair)), 1);
        even[i] = _mm256_madd_epi16(_mm256_sub_epi32(ahead, self), pairsOf(b + i * BundleValues::kPairs));
        odd[i] = _mm256_madd_epi16(ahead, pairsOf(b + (i + 1) * BundleValues::kPairs));
      }
      for (int k = 1; k < num_steps; ++k) {
        a -= 2 * BundleValues::kPairs;
        b += 2 * BundleValues::kPairs;
        for (int i = 0; i < 4; ++i) {
          const __m256i ahead = pairsOf(a + i * BundleValues::kPairs);
          even[i] = _mm256_add_epi32(even[i], _mm256_madd_epi16(ahead, pairsOf(b + i * BundleValues::kPairs)));
          odd[i] = _mm256_add_epi32(odd[i], _mm256_madd_epi16(ahead, pairsOf(b + (i + 1) * BundleValues::kPairs)));
        }
      }
      for (int i = 0; i < 4; ++i) {
        __m256i* const sum = reinterpret_cast<__m256i*>(sums + 2 * (c + i) * kBundleLanes + half / 2);
        _mm256_storeu_si256(sum, _mm256_add_epi32(_mm256_loadu_si256(sum), even[i]));
        _mm256_storeu_si256(sum + 2, _mm256_add_epi32(_mm256_loadu_si256(sum + 2), odd[i]));
      }
    }
  }
}

__attribute__((target("avx512f,avx512bw"))) void lookUpAvx512(const Bundle& bundle, const RowTable::Rows& rows,
                                                              BundleValues& values) {
  offsetsInRows(bundle, rows, values.offsets.data());
  const std::int32_t* const offsets = values.offsets.data();
  int first = bundle.first, last = bundle.last;
  const __m512i zero = _mm512_setzero_si512();
  __m512i before = zero;
  std::int16_t *ahead = values.aheadAt(first - 1), *back = values.backAt(first);
  const auto store = [&](__m512i here) __attribute__((target("avx512f,avx512bw"), always_inline)) {
    const __m512i pairs = _mm512_or_si512(before, _mm512_slli_epi32(here, 16));
    _mm512_storeu_si512(ahead, _mm512_add_epi32(pairs, pairs));
    _mm512_storeu_si512(back, _mm512_rol_epi32(pairs, 16));
    before = here;
    ahead += BundleValues::kPairs;
    back += BundleValues::kPairs;
  };
  for (int l = first; l < last; ++l)
    store(_mm512_cvtepu8_epi32(lanesAt(rows.bytes, offsets + l - bundle.first, bundle.last - bundle.first)));
  store(zero);
  for (int i = 0; i < BundleValues::kMargin - 1; ++i) {
    _mm512_storeu_si512(values.aheadAt(first - 2 - i), zero);
    _mm512_storeu_si512(values.aheadAt(last + i), zero);
    _mm512_storeu_si512(values.backAt(last + 1 + i), zero);
  }
  const auto areZero = [](const std::int16_t* pairs) __attribute__((target("avx512f,avx512bw"), always_inline)) {
    const __m512i all = _mm512_loadu_si512(pairs);
    return _mm512_test_epi32_mask(all, all) == 0;
  };
  while (first < last && areZero(values.aheadAt(first))) ++first;
  while (first < last && areZero(values.backAt(last - 1))) --last;
  values.first = first;
  values.last = last;
}

__attribute__((target("avx512f,avx512bw"))) void correlateAvx512(const BundleValues& values, std::int32_t* sums) {
  for (int c = values.first; c < values.last; c += 4) {
    __m512i even[4], odd[4];
    const int num_steps = numSteps(values, c);
    const std::int16_t *a = values.aheadAt(c - 1), *b = values.backAt(c + 1);
    for (int i = 0; i < 4; ++i) {
      const __m512i ahead = _mm512_loadu_si512(a + i * BundleValues::kPairs);
      const __m512i self = _mm512_srli_epi32(_mm512_and_si512(ahead, _mm512_set1_epi32(second_of_pair)), 1);
      even[i] = _mm512_madd_epi16(_mm512_sub_epi32(ahead, self), _mm512_loadu_si512(b + i * BundleValues::kPairs));
      odd[i] = _mm512_madd_epi16(ahead, _mm512_loadu_si512(b + (i + 1) * BundleValues::kPairs));
    }
    for (int k = 1; k < num_steps; ++k) {
      a -= 2 * BundleValues::kPairs;
      b += 2 * BundleValues::kPairs;
      for (int i = 0; i < 4; ++i) {
        const __m512i ahead = _mm512_loadu_si512(a + i * BundleValues::kPairs);
        even[i] = _mm512_add_epi32(even[i], _mm512_madd_epi16(ahead, _mm512_loadu_si512(b + i * BundleValues::kPairs)));
        odd[i] =
            _mm512_add_epi32(odd[i], _mm512_madd_epi16(ahead, _mm512_loadu_si512(b + (i + 1) * BundleValues::kPairs)));
      }
    }
    for (int i = 0; i < 4; ++i) {
      std::int32_t* const sum = sums + 2 * (c + i) * kBundleLanes;
      _mm512_storeu_si512(sum, _mm512_add_epi32(_mm512_loadu_si512(sum), even[i]));
      _mm512_storeu_si512(sum + kBundleLanes, _mm512_add_epi32(_mm512_loadu_si512(sum + kBundleLanes), odd[i]));
    }
  }
}

#endif

}  // namespace

BundleKernels bundleKernels(Simd simd) {
#if defined(__x86_64__)
  const bool has_words = __builtin_cpu_supports("avx512bw");
  if (simd == Simd::Avx512 && has_words) return {lookUpAvx512, correlateAvx512};
  if (simd == Simd::Auto && simdSupported(Simd::Avx512) && has_words) return {lookUpAvx512, correlateAvx512};
  if (simd != Simd::Scalar && simdSupported(Simd::Avx2)) return {lookUpAvx2, correlateAvx2};
#endif
  return {lookUpScalar, correlateScalar};
}

}  // namespace pcl_symmetry
