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

constexpr int kBatch = 16;  // lines resampled and correlated together; derived: 16-bit integers in an AVX2 register
// directions; chosen: half sets up arrays more often, twice leaves threads idle at the end
constexpr std::size_t kConvolvedPerBlock = 16;
// Steps of the R2 sequence, which fills the unit square evenly. derived: 1 / g and 1 / g^2 with the plastic number
// g = 1.3247..., the root of g^3 = g + 1.
constexpr double kPhaseSteps[2] = {0.7548776662466927, 0.5698402909980532};

/// Sixteen parallel lines of equally spaced points: point l of lane j is start[axis][j] + l * step[axis], in
/// fixed-point table coordinates, inside the table for l in [begin[j], end[j]).
struct LineBundle {
  alignas(64) std::int32_t start[3][kBatch];
  alignas(64) std::int32_t begin[kBatch];
  alignas(64) std::int32_t end[kBatch];
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
    for (int j = 0; j < kBatch; ++j) {
      const bool inside = l >= lines.begin[j] && l < lines.end[j];
      const auto at = [&](int axis) { return lines.start[axis][j] + l * lines.step[axis]; };
      values[l * kBatch + j] = inside ? table[LookupTable::index(at(0), at(1), at(2), bits)] : 0;
    }
  }
}

void correlateScalar(const std::int16_t* values, int first, int last, std::int64_t* sums) {
  for (int s = 2 * first; s <= 2 * (last - 1); ++s) {
    std::int32_t pairs = 0, self = 0;
    for (int a = std::max(first, s - last + 1); 2 * a < s; ++a)
      for (int j = 0; j < kBatch; ++j) pairs += values[a * kBatch + j] * values[(s - a) * kBatch + j];
    if (s % 2 == 0)
      for (int j = 0; j < kBatch; ++j) self += values[s / 2 * kBatch + j] * values[s / 2 * kBatch + j];
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
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(values + l * kBatch), packed);
  }
}

__attribute__((target("avx2"))) void correlateAvx2(const std::int16_t* values, int first, int last,
                                                   std::int64_t* sums) {
  for (int s = 2 * first; s <= 2 * (last - 1); ++s) {
    __m256i pairs = _mm256_setzero_si256();
    for (int a = std::max(first, s - last + 1); 2 * a < s; ++a)
      pairs = _mm256_add_epi32(pairs,
                               _mm256_madd_epi16(loadLanes(values + a * kBatch), loadLanes(values + (s - a) * kBatch)));
    pairs = _mm256_add_epi32(pairs, pairs);
    if (s % 2 == 0) {
      const __m256i self = loadLanes(values + s / 2 * kBatch);
      pairs = _mm256_add_epi32(pairs, _mm256_madd_epi16(self, self));
    }
    const __m128i four = _mm_add_epi32(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
    const __m128i two = _mm_add_epi32(four, _mm_shuffle_epi32(four, 0x4E));
    sums[s] += _mm_cvtsi128_si32(_mm_add_epi32(two, _mm_shuffle_epi32(two, 0xB1)));
  }
}

#endif

/// The inner loops for one instruction set. All give the same bytes.
struct Kernels {
  Resample resample;
  Correlate correlate;
};

Kernels kernelsFor(Simd simd) {
#if defined(__x86_64__)
  if (simd != Simd::Scalar && simdSupported(Simd::Avx2)) return {resampleAvx2, correlateAvx2};
#endif
  return {resampleScalar, correlateScalar};
}

/// The lattice that the EDT is resampled on, and the bins of r, common to all directions. Lengths are in cells;
/// positions are relative to the middle of the EDT's cube, beyond whose inscribed ball f is taken as 0.
struct Lattice {
  Lattice(const GaussianEdt& edt, const PlaneGrid& grid, const LookupTable& table, double spacing_in_sigmas) {
    const double middle = 0.5 * (edt.numCells() - 1);
    clip = middle - 0.5;
    center = ((grid.center() - edt.origin()) / edt.cellSize()).array() - middle;
    table_middle = table.toTable(Eigen::Vector3d::Constant(middle));
    grid_offset = grid.offset(0) / edt.cellSize();
    radius_step = grid.radiusStep() / edt.cellSize();
    spacing = spacing_in_sigmas * edt.sigma() / edt.cellSize();
    refine = static_cast<int>(std::ceil(2.0 * radius_step / spacing));
    along = 2.0 * radius_step / refine;
    num_across = 2 * static_cast<int>(std::ceil(clip / spacing)) + 1;
    num_along = static_cast<int>(std::ceil((2.0 * clip + radius_step) / along)) + 2;
    num_radius = grid.numRadius();
    scale = along * spacing * spacing / (edt.sqNorm() * LookupTable::kOne * LookupTable::kOne);
  }

  double clip;                   ///< radius of the ball beyond which f is taken as 0
  Eigen::Vector3d center;        ///< of the grid of planes
  Eigen::Vector3d table_middle;  ///< table coordinates of the middle
  double grid_offset;            ///< of the first bin from the center of the grid
  double radius_step;
  double spacing;  ///< between parallel lines
  /// Points at t0 + l * along have the planes between them at t0 + (a + b) * along / 2: every refine-th one is a bin.
  int refine;
  double along;    ///< between the points of a line
  int num_across;  ///< lines along each side of the lattice
  int num_along;   ///< points of a line
  int num_radius;
  double scale;  ///< from sums of products of bytes to D
};

/// D for all planes of one direction: the volume is resampled along the normal, and each line is correlated with its
/// reversal (Section 4.2).
class DirectionConvolution {
public:
  DirectionConvolution(const Lattice& lattice, const LookupTable& table, const Kernels& kernels)
      : lattice_(lattice),
        table_(table),
        kernels_(kernels),
        values_(static_cast<std::size_t>(lattice.num_along) * kBatch),
        sums_(2 * lattice.num_along) {}

  /// \param index of the direction in the grid.
  /// \param[out] d num_radius values of D.
  void run(const Eigen::Vector3d& normal, std::size_t index, float* d) {
    n_ = normal;
    u_ = n_.unitOrthogonal();
    v_ = n_.cross(u_);
    const double first_offset = n_.dot(lattice_.center) + lattice_.grid_offset;
    const double num_skipped = std::floor((-lattice_.clip - first_offset) / lattice_.radius_step);
    t0_ = first_offset + num_skipped * lattice_.radius_step;
    for (int axis = 0; axis < 3; ++axis) lines_.step[axis] = LookupTable::toFixed(lattice_.along * n_[axis]);
    std::fill(sums_.begin(), sums_.end(), 0);
    // Each direction has its own phase of the lattice, so that what aliasing is left does not add up over directions.
    const double phase_u = std::fmod(kPhaseSteps[0] * static_cast<double>(index), 1.0) - 0.5;
    const double phase_v = std::fmod(kPhaseSteps[1] * static_cast<double>(index), 1.0) - 0.5;
    for (int i = 0; i < lattice_.num_across; ++i)
      for (int j = 0; j < lattice_.num_across; j += kBatch)
        addBundle((i - lattice_.num_across / 2 + phase_u) * lattice_.spacing, j, phase_v);
    for (int k = 0; k < lattice_.num_radius; ++k) {
      const double s = (k - num_skipped) * lattice_.refine;
      d[k] = s >= 0.0 && s < static_cast<double>(sums_.size())
                 ? static_cast<float>(lattice_.scale * static_cast<double>(sums_[static_cast<std::size_t>(s)]))
                 : 0.0f;
    }
  }

private:
  /// Adds the lines at \p a along u and \p first, first + 1, ... steps along v.
  void addBundle(double a, int first, double phase_v) {
    lines_.first = lattice_.num_along;
    lines_.last = 0;
    for (int lane = 0; lane < kBatch; ++lane) {
      placeLine(lane, a, (first + lane - lattice_.num_across / 2 + phase_v) * lattice_.spacing,
                first + lane < lattice_.num_across);
      if (lines_.begin[lane] >= lines_.end[lane]) continue;
      lines_.first = std::min(lines_.first, lines_.begin[lane]);
      lines_.last = std::max(lines_.last, lines_.end[lane]);
    }
    if (lines_.first >= lines_.last) return;
    kernels_.resample(lines_, table_.data(), table_.bits(), values_.data());
    kernels_.correlate(values_.data(), lines_.first, lines_.last, sums_.data());
  }

  /// Places a line at (a, b) in the plane across the normal, and cuts it to the ball.
  /// \param used false: an empty line.
  void placeLine(int lane, double a, double b, bool used) {
    const Eigen::Vector3d start = lattice_.table_middle + a * u_ + b * v_ + t0_ * n_;
    for (int axis = 0; axis < 3; ++axis) lines_.start[axis][lane] = LookupTable::toFixed(start[axis]);
    const double sq_chord = lattice_.clip * lattice_.clip - a * a - b * b;
    const double chord = std::sqrt(std::max(0.0, sq_chord));
    const bool hit = sq_chord > 0.0 && used;
    const double begin = std::ceil((-chord - t0_) / lattice_.along), end = std::floor((chord - t0_) / lattice_.along);
    lines_.begin[lane] = hit ? std::max(0, static_cast<int>(begin)) : 0;
    lines_.end[lane] = hit ? std::min(lattice_.num_along, static_cast<int>(end) + 1) : 0;
  }

  const Lattice& lattice_;
  const LookupTable& table_;
  Kernels kernels_;
  std::vector<std::int16_t> values_;
  std::vector<std::int64_t> sums_;
  LineBundle lines_;
  Eigen::Vector3d n_, u_, v_;
  double t0_ = 0.0;  ///< offset of the first points of all lines
};

}  // namespace

void ConvolutionTransformOptions::validate() const {
  check(spacing > 0.0 && spacing <= 1.0, "spacing", spacing, "in (0, 1]");
  checkNumThreads(num_threads);
  check(simdSupported(simd), "simd", static_cast<int>(simd), "one that this processor supports");
}

SymmetryMap convolutionTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                 const ConvolutionTransformOptions& options) {
  options.validate();
  // 1/24: the look-up of the nearest cell is one box.
  const std::vector<float> f = edt.sharpened(1.0 / 24.0, options.num_threads);
  const LookupTable table({f.data()}, edt.numCells(), options.num_threads);
  const Lattice lattice(edt, grid, table, options.spacing);
  SymmetryMap map;
  map.grid = grid;
  map.method = TransformMethod::Convolution;
  map.sigma = edt.sigma();
  map.center_of_mass = grid.center();
  map.values.resize(grid.size());
  const auto run = [&](std::size_t begin, std::size_t end) {
    DirectionConvolution convolution(lattice, table, kernelsFor(options.simd));
    for (std::size_t direction = begin; direction < end; ++direction)
      convolution.run(grid.normal(direction), direction, map.values.data() + direction * grid.numRadius());
  };
  parallelRanges(grid.numDirections(), kConvolvedPerBlock, options.num_threads, run);
  return map;
}

}  // namespace pcl_symmetry
