#include "pcl_symmetry/core/transform/planar_transform.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/distance_transform/lookup_table.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pcl_symmetry {

namespace {

constexpr int kLanes = 16;  // parallel lines that are resampled and correlated together

/// Sixteen parallel lines of equally spaced points: point l of lane j is start[axis][j] + l * step[axis], in
/// fixed-point table coordinates, inside the table for l in [begin[j], end[j]).
struct LineBundle {
  alignas(64) std::int32_t start[3][kLanes];
  alignas(64) std::int32_t begin[kLanes];
  alignas(64) std::int32_t end[kLanes];
  std::int32_t step[3];
  int first;  ///< least begin
  int last;   ///< greatest end
};

/// values[l][j] for l in [first, last): f of the table, 0 outside.
using Resample = void (*)(const LineBundle& lines, const std::uint8_t* table, int bits, std::int16_t* values);
/// sums[s] += sum over j and a + b = s of values[a][j] * values[b][j].
using Correlate = void (*)(const std::int16_t* values, int first, int last, std::int64_t* sums);

void resampleScalar(const LineBundle& lines, const std::uint8_t* table, int bits, std::int16_t* values) {
  for (int l = lines.first; l < lines.last; ++l) {
    for (int j = 0; j < kLanes; ++j) {
      const bool inside = l >= lines.begin[j] && l < lines.end[j];
      const auto at = [&](int axis) { return lines.start[axis][j] + l * lines.step[axis]; };
      values[l * kLanes + j] = inside ? table[LookupTable::index(at(0), at(1), at(2), bits)] : 0;
    }
  }
}

void correlateScalar(const std::int16_t* values, int first, int last, std::int64_t* sums) {
  for (int s = 2 * first; s <= 2 * (last - 1); ++s) {
    std::int32_t pairs = 0, self = 0;
    for (int a = std::max(first, s - last + 1); 2 * a < s; ++a)
      for (int j = 0; j < kLanes; ++j) pairs += values[a * kLanes + j] * values[(s - a) * kLanes + j];
    if (s % 2 == 0)
      for (int j = 0; j < kLanes; ++j) self += values[s / 2 * kLanes + j] * values[s / 2 * kLanes + j];
    sums[s] += 2 * pairs + self;
  }
}

#if defined(__x86_64__)

__attribute__((target("avx2"))) inline __m256i loadLanes(const void* lanes) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(lanes));
}

__attribute__((target("avx2"))) void resampleAvx2(const LineBundle& lines, const std::uint8_t* table, int bits,
                                                  std::int16_t* values) {
  const __m256i byte = _mm256_set1_epi32(0xFF), zero = _mm256_setzero_si256();
  const __m128i fraction = _mm_cvtsi32_si128(LookupTable::kFractionBits);
  const __m128i row = _mm_cvtsi32_si128(bits), slice = _mm_cvtsi32_si128(2 * bits);
  for (int l = lines.first; l < lines.last; ++l) {
    __m256i halves[2];
    const __m256i at = _mm256_set1_epi32(l);
    for (int half = 0; half < 2; ++half) {
      __m256i cell[3];
      for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = _mm256_sra_epi32(
            _mm256_add_epi32(loadLanes(lines.start[axis] + 8 * half), _mm256_set1_epi32(l * lines.step[axis])),
            fraction);
      }
      const __m256i inside = _mm256_andnot_si256(_mm256_cmpgt_epi32(loadLanes(lines.begin + 8 * half), at),
                                                 _mm256_cmpgt_epi32(loadLanes(lines.end + 8 * half), at));
      const __m256i index =
          _mm256_add_epi32(_mm256_add_epi32(_mm256_sll_epi32(cell[2], slice), _mm256_sll_epi32(cell[1], row)), cell[0]);
      halves[half] = _mm256_and_si256(
          _mm256_mask_i32gather_epi32(zero, reinterpret_cast<const int*>(table), index, inside, 1), byte);
    }
    const __m256i packed = _mm256_permute4x64_epi64(_mm256_packs_epi32(halves[0], halves[1]), 0xD8);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(values + l * kLanes), packed);
  }
}

__attribute__((target("avx2"))) void correlateAvx2(const std::int16_t* values, int first, int last,
                                                   std::int64_t* sums) {
  for (int s = 2 * first; s <= 2 * (last - 1); ++s) {
    __m256i pairs = _mm256_setzero_si256();
    for (int a = std::max(first, s - last + 1); 2 * a < s; ++a)
      pairs = _mm256_add_epi32(pairs,
                               _mm256_madd_epi16(loadLanes(values + a * kLanes), loadLanes(values + (s - a) * kLanes)));
    pairs = _mm256_add_epi32(pairs, pairs);
    if (s % 2 == 0) {
      const __m256i self = loadLanes(values + s / 2 * kLanes);
      pairs = _mm256_add_epi32(pairs, _mm256_madd_epi16(self, self));
    }
    const __m128i four = _mm_add_epi32(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
    const __m128i two = _mm_add_epi32(four, _mm_shuffle_epi32(four, 0x4E));
    sums[s] += _mm_cvtsi128_si32(_mm_add_epi32(two, _mm_shuffle_epi32(two, 0xB1)));
  }
}

#endif

bool wideKernels(Simd simd) {
  return simd != Simd::Scalar && simdSupported(Simd::Avx2);
}

}  // namespace

void ConvolutionTransformOptions::validate() const {
  check(spacing > 0.0 && spacing <= 1.0, "spacing", spacing, "in (0, 1]");
  checkNumThreads(num_threads);
  check(simdSupported(simd), "simd", static_cast<int>(simd), "one that this processor supports");
}

SymmetryMap convolutionTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                 const ConvolutionTransformOptions& options) {
  options.validate();
  const LookupTable table({edt.sharpened(1.0 / 24.0, options.num_threads)}, edt.numCells(), options.num_threads);
  Resample resample = resampleScalar;
  Correlate correlate = correlateScalar;
#if defined(__x86_64__)
  if (wideKernels(options.simd)) {
    resample = resampleAvx2;
    correlate = correlateAvx2;
  }
#endif

  // In cells, relative to the middle of the EDT's cube, beyond whose inscribed ball f is taken as 0.
  const double middle = 0.5 * (edt.numCells() - 1);
  const double clip = middle - 0.5;
  const Eigen::Vector3d center = ((grid.center() - edt.origin()) / edt.cellSize()).array() - middle;
  const Eigen::Vector3d table_middle = table.toTable(Eigen::Vector3d::Constant(middle));
  const double radius_step = grid.radiusStep() / edt.cellSize();
  const double spacing = options.spacing * edt.sigma() / edt.cellSize();
  // Points at t0 + l * along have the planes between them at t0 + (a + b) * along / 2: every `refine`-th is a bin.
  const int refine = static_cast<int>(std::ceil(2.0 * radius_step / spacing));
  const double along = 2.0 * radius_step / refine;
  const int num_across = 2 * static_cast<int>(std::ceil(clip / spacing)) + 1;
  const int num_along = static_cast<int>(std::ceil((2.0 * clip + radius_step) / along)) + 2;
  const double scale = along * spacing * spacing / (edt.sqNorm() * LookupTable::kOne * LookupTable::kOne);

  SymmetryMap map;
  map.grid = grid;
  map.method = TransformMethod::Convolution;
  map.sigma = edt.sigma();
  map.center_of_mass = grid.center();
  map.values.resize(grid.size());
  constexpr std::size_t kDirectionsPerBlock = 16;
  parallelRanges(
      grid.numDirections(), kDirectionsPerBlock, options.num_threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::int16_t> values(static_cast<std::size_t>(num_along) * kLanes);
        std::vector<std::int64_t> sums(2 * num_along);
        LineBundle lines;
        for (std::size_t direction = begin; direction < end; ++direction) {
          const Eigen::Vector3d n =
              grid.normal(static_cast<int>(direction / grid.numPhi()), static_cast<int>(direction % grid.numPhi()));
          const Eigen::Vector3d u = n.unitOrthogonal(), v = n.cross(u);
          // Each direction has its own phase of the lattice: what aliasing is left does not add up over directions.
          const double phase_u = std::fmod(0.7548776662466927 * static_cast<double>(direction), 1.0) - 0.5;
          const double phase_v = std::fmod(0.5698402909980532 * static_cast<double>(direction), 1.0) - 0.5;
          const double first_offset = n.dot(center) + grid.offset(0) / edt.cellSize();
          const double num_skipped = std::floor((-clip - first_offset) / radius_step);
          const double t0 = first_offset + num_skipped * radius_step;
          for (int axis = 0; axis < 3; ++axis) lines.step[axis] = LookupTable::toFixed(along * n[axis]);
          std::fill(sums.begin(), sums.end(), 0);
          for (int i = 0; i < num_across; ++i) {
            const double a = (i - num_across / 2 + phase_u) * spacing;
            for (int j = 0; j < num_across; j += kLanes) {
              lines.first = num_along;
              lines.last = 0;
              for (int lane = 0; lane < kLanes; ++lane) {
                const double b = (j + lane - num_across / 2 + phase_v) * spacing;
                const Eigen::Vector3d start = table_middle + a * u + b * v + t0 * n;
                for (int axis = 0; axis < 3; ++axis) lines.start[axis][lane] = LookupTable::toFixed(start[axis]);
                const double sq_chord = clip * clip - a * a - b * b;
                const double chord = std::sqrt(std::max(0.0, sq_chord));
                const bool hit = sq_chord > 0.0 && j + lane < num_across;
                lines.begin[lane] = hit ? std::max(0, static_cast<int>(std::ceil((-chord - t0) / along))) : 0;
                lines.end[lane] = hit ? std::min(num_along, static_cast<int>(std::floor((chord - t0) / along)) + 1) : 0;
                if (lines.begin[lane] >= lines.end[lane]) continue;
                lines.first = std::min(lines.first, lines.begin[lane]);
                lines.last = std::max(lines.last, lines.end[lane]);
              }
              if (lines.first >= lines.last) continue;
              resample(lines, table.data(), table.bits(), values.data());
              correlate(values.data(), lines.first, lines.last, sums.data());
            }
          }
          float* const out = map.values.data() + direction * grid.numRadius();
          for (int k = 0; k < grid.numRadius(); ++k) {
            const double s = (k - num_skipped) * refine;
            out[k] = s >= 0.0 && s < static_cast<double>(sums.size())
                         ? static_cast<float>(scale * static_cast<double>(sums[static_cast<std::size_t>(s)]))
                         : 0.0f;
          }
        }
      });
  return map;
}

}  // namespace pcl_symmetry
