#include "core/transform/sampled_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/simd.h"
#include "core/geometry/point_samples.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pcl_symmetry {

namespace {

using Cube = LineSums::Cube;
using Lines = LineSums::Lines;

constexpr int kLineLanes = 8;    // 32-bit integers in an AVX2 register; sums are padded by as many
constexpr int kMaxLines = 1024;  // at a time: they stay in the first-level cache, and sums of bytes fit in 32 bits

/// Fills the lines along which the images of points move when the points are reflected in parallel planes.
PCL_SYMMETRY_MULTIVERSION
void setUpReflected(const float* px, const float* py, const float* pz, const ParallelPlanes& planes, const Cube& cube,
                    Lines& lines) {
  const float nx = planes.normal[0], ny = planes.normal[1], nz = planes.normal[2];
  const float offset = planes.offset, inverse_step = 1.0f / planes.step, last = static_cast<float>(planes.count);
  const float middle = cube.middle, sq_clip = cube.sq_clip, to_table = cube.to_table;
  const float one = static_cast<float>(1 << LookupTable::kFractionBits);
  std::int32_t *const lx = lines.x, *const ly = lines.y, *const lz = lines.z;
  std::int32_t *const k_begin = lines.k_begin, *const k_end = lines.k_end;
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

/// Fills lines along start + moved + k * step, within the ball of the cube.
/// \param moved 3 x lines.size.
PCL_SYMMETRY_MULTIVERSION
void setUpMoved(const float* moved, const float* start, const float* step, float begin, float end, const Cube& cube,
                Lines& lines) {
  const float one = static_cast<float>(1 << LookupTable::kFractionBits);
  const float sx = start[0], sy = start[1], sz = start[2], tx = step[0], ty = step[1], tz = step[2];
  const float sq_clip = cube.sq_clip, to_table = cube.to_table;
  const float inverse = 1.0f / (tx * tx + ty * ty + tz * tz);
  std::int32_t *const lx = lines.x, *const ly = lines.y, *const lz = lines.z;
  std::int32_t *const k_begin = lines.k_begin, *const k_end = lines.k_end;
  const int size = lines.size;
  for (int i = 0; i < size; ++i) {
    const float x = moved[3 * i] + sx, y = moved[3 * i + 1] + sy, z = moved[3 * i + 2] + sz;
    lx[i] = static_cast<std::int32_t>((x + to_table) * one);
    ly[i] = static_cast<std::int32_t>((y + to_table) * one);
    lz[i] = static_cast<std::int32_t>((z + to_table) * one);
    // |x + k step|^2 <= sq_clip, a quadratic inequality in k
    const float middle = -(x * tx + y * ty + z * tz) * inverse;
    const float sq_reach = (sq_clip - (x * x + y * y + z * z)) * inverse + middle * middle;
    const float reach = std::sqrt(std::max(0.0f, sq_reach));
    const float first = std::ceil(middle - reach), last = std::floor(middle + reach) + 1.0f;
    k_begin[i] = static_cast<std::int32_t>(std::min(std::max(first, begin), end));
    k_end[i] = sq_reach > 0.0f ? static_cast<std::int32_t>(std::min(std::max(last, begin), end)) : 0;
  }
}

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
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i byte = _mm256_set1_epi32(0xFF);
  const __m256i zero = _mm256_setzero_si256();
  const __m128i fraction = _mm_cvtsi32_si128(LookupTable::kFractionBits);
  const __m128i row = _mm_cvtsi32_si128(bits), slice = _mm_cvtsi32_si128(2 * bits);
  __m256i ramp[3], stride[3];
  for (int axis = 0; axis < 3; ++axis) {
    ramp[axis] = _mm256_mullo_epi32(lane, _mm256_set1_epi32(lines.step[axis]));
    stride[axis] = _mm256_set1_epi32(kLineLanes * lines.step[axis]);
  }
  for (int i = 0; i < lines.size; ++i) {
    const std::int32_t k_end = lines.k_end[i];
    std::int32_t k = lines.k_begin[i];
    __m256i x = _mm256_add_epi32(_mm256_set1_epi32(lines.x[i] + k * lines.step[0]), ramp[0]);
    __m256i y = _mm256_add_epi32(_mm256_set1_epi32(lines.y[i] + k * lines.step[1]), ramp[1]);
    __m256i z = _mm256_add_epi32(_mm256_set1_epi32(lines.z[i] + k * lines.step[2]), ramp[2]);
    for (; k < k_end; k += kLineLanes) {
      const __m256i inside = _mm256_cmpgt_epi32(_mm256_set1_epi32(k_end - k), lane);
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

/// sums[g][k] += sum over lines of function g of the table at point k. The sums are integers, so that both kernels give
/// the same bytes.
template <int kFunctions>
auto* kernelOf(bool scalar) {
#if defined(__x86_64__)
  if (!scalar && __builtin_cpu_supports("avx2")) return accumulateAvx2<kFunctions>;
#endif
  return accumulateScalar<kFunctions>;
}

constexpr std::size_t kSampledPerBlock = 32;  // directions

/// (S / |f|^2) mean g(gamma x_i) at every bin: D for g = f and, with free space, F for g = free space.
std::vector<std::vector<float>> sampleMeans(const GaussianEdt& edt, const PlaneGrid& grid,
                                            const SampledTransformOptions& options,
                                            const std::vector<float>& free_space) {
  options.validate();
  const LookupTable table(edt, free_space, options.num_threads);
  const CoordinateRows points = drawPoints(edt, options.num_samples, options.seed, options.num_threads);
  // Center of the grid, in cells from the middle of the cube of cells.
  const Eigen::Vector3f center = ((grid.center() - edt.origin()) / edt.cellSize()).cast<float>() -
                                 Eigen::Vector3f::Constant(static_cast<float>(middleCell(edt)));
  const auto radius_step = static_cast<float>(grid.radiusStep() / edt.cellSize());
  const auto first_offset = static_cast<float>(grid.offset(0) / edt.cellSize());
  const double scale = edt.sum() / (edt.sqNorm() * options.num_samples * LookupTable::kOne);
  const int num_radius = grid.numRadius();
  std::vector<std::vector<float>> means(table.numFunctions(), std::vector<float>(grid.size()));
  const auto run = [&](std::size_t begin, std::size_t end) {
    LineSums sums(edt, table, num_radius);
    for (std::size_t direction = begin; direction < end; ++direction) {
      const Eigen::Vector3f n = grid.normal(direction).cast<float>();
      const LineSums::Totals& totals =
          sums.ofReflected(points, {{n.x(), n.y(), n.z()}, n.dot(center) + first_offset, radius_step, num_radius});
      for (std::size_t g = 0; g < means.size(); ++g)
        for (int k = 0; k < num_radius; ++k)
          means[g][direction * num_radius + k] = static_cast<float>(scale * totals[g][k]);
    }
  };
  parallelRanges(grid.numDirections(), kSampledPerBlock, options.num_threads, run);
  return means;
}

constexpr int kBlockSide = 8;  // cells

/// The cells of a block along the Morton curve.
std::array<Eigen::Vector3i, kBlockSide * kBlockSide * kBlockSide> cellsOfBlock() {
  std::array<Eigen::Vector3i, kBlockSide * kBlockSide * kBlockSide> cells;
  for (int z = 0; z < kBlockSide; ++z)
    for (int y = 0; y < kBlockSide; ++y)
      for (int x = 0; x < kBlockSide; ++x) cells[mortonCode(x, y, z)] = {x, y, z};
  return cells;
}

/// A cube of cells and its share of the sum of f.
struct Block {
  std::uint32_t code;  ///< position along the Morton curve
  Eigen::Vector3i first_cell;
  double sum;
};

/// All blocks along the Morton curve.
std::vector<Block> blocksOf(const GaussianEdt& edt, int num_threads) {
  const int n = edt.numCells(), side = (n + kBlockSide - 1) / kBlockSide;
  std::vector<Block> blocks(static_cast<std::size_t>(side) * side * side);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        blocks[(static_cast<std::size_t>(z) * side + y) * side + x] = {mortonCode(x, y, z),
                                                                       kBlockSide * Eigen::Vector3i(x, y, z), 0.0};
  parallelBlocks(side, num_threads, [&](std::size_t layer) {
    for (int z = static_cast<int>(layer) * kBlockSide; z < std::min(n, static_cast<int>(layer + 1) * kBlockSide); ++z) {
      for (int y = 0; y < n; ++y) {
        const float* const f = edt.values().data() + (static_cast<std::size_t>(z) * n + y) * n;
        Block* const row = &blocks[(layer * side + y / kBlockSide) * side];
        for (int x = 0; x < n; x += kBlockSide) {
          float sum = 0.0f;
          for (int i = x; i < std::min(n, x + kBlockSide); ++i) sum += f[i];
          row[x / kBlockSide].sum += sum;
        }
      }
    }
  });
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.code < b.code; });
  return blocks;
}

/// The cell of a block at which the sum of f along the curve passes \p target.
/// \param before sum over the blocks before it.
Eigen::Vector3f cellAt(const GaussianEdt& edt, const Block& block, double before, double target) {
  static const auto kCells = cellsOfBlock();
  const int n = edt.numCells();
  double sum = before;
  Eigen::Vector3f chosen = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3i& offset : kCells) {
    const Eigen::Vector3i cell = block.first_cell + offset;
    if ((cell.array() >= n).any()) continue;
    const float f = edt.values()[(static_cast<std::size_t>(cell.z()) * n + cell.y()) * n + cell.x()];
    if (f == 0.0f) continue;
    chosen = cell.cast<float>();
    sum += f;
    if (sum > target) break;
  }
  return chosen;
}

/// \param free_space free space of a scan, which only the sampled transform uses.
SymmetryMap transformed(const GaussianEdt& edt, const PlaneGrid& grid, const PlanarTransformOptions& options,
                        const std::vector<float>& free_space) {
  switch (options.method) {
    case TransformMethod::Convolution:
      return convolutionTransform(edt, grid, options.convolution);
    case TransformMethod::Rotational:
      return rotationalTransform(edt, grid, options.rotational);
    case TransformMethod::Voting:
      return votingTransform(edt, grid, options.voting);
    case TransformMethod::Sampled:
      break;
  }
  return sampledTransform(edt, grid, options.sampled, free_space);
}

}  // namespace

LookupTable::LookupTable(const GaussianEdt& edt, const std::vector<float>& free_space, int num_threads) {
  std::vector<const float*> functions{edt.interpolation().data()};
  if (!free_space.empty()) {
    check(free_space.size() == edt.values().size(), "free_space size", free_space.size(), "one value per cell");
    functions.push_back(free_space.data());
  }
  num_functions_ = static_cast<int>(functions.size());
  const int n = edt.numCells();
  while ((1 << bits_) < n) ++bits_;
  padding_ = ((1 << bits_) - n) / 2;
  const std::size_t side = std::size_t{1} << bits_;
  table_.assign(num_functions_ * side * side * side + sizeof(std::uint32_t), 0);  // a gather reads four bytes
  parallelBlocks(n - 2, num_threads, [&](std::size_t slice) {
    for (int y = 1; y + 1 < n; ++y) {
      const std::size_t cell = ((slice + 1 + padding_) * side + (y + padding_)) * side + padding_;
      for (std::size_t g = 0; g < functions.size(); ++g) {
        const float* const values = functions[g] + ((slice + 1) * n + y) * n;
        for (int x = 1; x + 1 < n; ++x) {
          const float scaled = values[x] * static_cast<float>(kOne) + 0.5f;
          table_[num_functions_ * (cell + x) + g] = static_cast<std::uint8_t>(std::min(scaled, kMaxValue));
        }
      }
    }
  });
}

LineSums::LineSums(const GaussianEdt& edt, const LookupTable& table, int num_steps, bool scalar)
    : table_(table),
      accumulate_(table.numFunctions() == 1 ? kernelOf<1>(scalar) : kernelOf<2>(scalar)),
      totals_(table.numFunctions(), std::vector<double>(num_steps)),
      sums_(table.numFunctions(), std::vector<std::int32_t>(num_steps + kLineLanes)),
      storage_(5 * kMaxLines) {
  const double middle = middleCell(edt);
  cube_.middle = static_cast<float>(middle);
  cube_.sq_clip = static_cast<float>(std::pow(middle - 0.5, 2));
  cube_.to_table = static_cast<float>(middle + table.padding() + 0.5);
  for (auto& sums : sums_) sums_of_.push_back(sums.data());
}

/// \param set_up fills lines that begin at a sample; size and step are set.
template <typename SetUp>
const LineSums::Totals& LineSums::add(int num_samples, const Eigen::Vector3f& step, int begin, int end,
                                      const SetUp& set_up) {
  for (auto& total : totals_) std::fill(total.begin(), total.end(), 0.0);
  std::int32_t* const data = storage_.data();
  Lines lines{data, data + kMaxLines, data + 2 * kMaxLines, data + 3 * kMaxLines, data + 4 * kMaxLines, 0, {}};
  for (int axis = 0; axis < 3; ++axis)
    lines.step[axis] = static_cast<std::int32_t>(std::lround(step[axis] * (1 << LookupTable::kFractionBits)));
  for (int first = 0; first < num_samples; first += kMaxLines) {
    lines.size = std::min(kMaxLines, num_samples - first);
    set_up(first, lines);
    for (auto& sums : sums_) std::fill(sums.begin(), sums.end(), 0);
    accumulate_(lines, table_.data(), table_.bits(), sums_of_.data());
    for (std::size_t g = 0; g < totals_.size(); ++g)
      for (int k = begin; k < end; ++k) totals_[g][k] += sums_[g][k];
  }
  return totals_;
}

const LineSums::Totals& LineSums::ofReflected(const CoordinateRows& points, const ParallelPlanes& planes) {
  // The image of a point moves by twice the step between planes.
  const Eigen::Vector3f step = 2.0f * planes.step * Eigen::Map<const Eigen::Vector3f>(planes.normal);
  return add(static_cast<int>(points.cols()), step, 0, planes.count, [&](int first, Lines& lines) {
    setUpReflected(&points(0, first), &points(1, first), &points(2, first), planes, cube_, lines);
  });
}

const LineSums::Totals& LineSums::ofMoved(const Eigen::Matrix3Xf& moved, const Eigen::Vector3f& start,
                                          const Eigen::Vector3f& step, int begin, int end) {
  return add(static_cast<int>(moved.cols()), step, begin, end, [&](int first, Lines& lines) {
    float rounded[3];
    for (int axis = 0; axis < 3; ++axis)
      rounded[axis] = static_cast<float>(lines.step[axis]) / (1 << LookupTable::kFractionBits);
    setUpMoved(moved.data() + 3 * first, start.data(), rounded, static_cast<float>(begin), static_cast<float>(end),
               cube_, lines);
  });
}

Eigen::Matrix3Xf centeredSamples(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads) {
  Eigen::Matrix3Xf samples = drawPoints(edt, num_samples, seed, num_threads);
  samples.array() -= static_cast<float>(middleCell(edt));
  return samples;
}

Eigen::Vector3d toCells(const GaussianEdt& edt, const Eigen::Vector3d& x) {
  return ((x - edt.origin()) / edt.cellSize()).array() - middleCell(edt);
}

void SampledTransformOptions::validate() const {
  check(num_samples >= 1 && num_samples <= 10'000'000, "num_samples", num_samples, "in [1, 10000000]");
  checkNumThreads(num_threads);
}

SymmetryMap sampledTransform(const GaussianEdt& edt, const PlaneGrid& grid, const SampledTransformOptions& options,
                             const std::vector<float>& free_space) {
  std::vector<std::vector<float>> means = sampleMeans(edt, grid, options, free_space);
  SymmetryMap map{grid, std::move(means[0]), TransformMethod::Sampled, edt.sigma(), grid.center()};
  if (!free_space.empty()) weighSeen(map, means[1]);
  return map;
}

std::vector<float> freeOverlap(const GaussianEdt& edt, const PlaneGrid& grid, const std::vector<float>& free_space,
                               const SampledTransformOptions& options) {
  return std::move(sampleMeans(edt, grid, options, free_space).at(1));
}

void weighSeen(SymmetryMap& map, const std::vector<float>& free_overlap) {
  for (std::size_t i = 0; i < map.values.size(); ++i)
    map.values[i] = static_cast<float>(seenSymmetry(map.values[i], free_overlap[i]));
}

Eigen::Matrix3Xf drawPoints(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads) {
  const std::vector<Block> blocks = blocksOf(edt, num_threads);
  double total = 0.0;
  for (const Block& block : blocks) total += block.sum;
  Eigen::Matrix3Xf points(3, num_samples);
  RandomStream random(seed);
  std::size_t b = 0;
  double before = 0.0;  // sum over the blocks before b
  for (int i = 0; i < num_samples; ++i) {
    const double target = (i + random.uniform()) * total / num_samples;
    while (b + 1 < blocks.size() && before + blocks[b].sum <= target) before += blocks[b++].sum;
    const Eigen::Vector3f cell = cellAt(edt, blocks[b], before, target);
    for (int axis = 0; axis < 3; ++axis) points(axis, i) = cell[axis] + static_cast<float>(random.uniform() - 0.5);
  }
  return points;
}

std::vector<float> freeSpace(const GaussianEdt& edt, const Visibility* visibility, int num_threads) {
  if (!visibility) return {};
  const std::size_t n = edt.numCells();
  const std::vector<float>& f = edt.values();
  std::vector<float> free(f.size(), 0.0f);
  parallelBlocks(n, num_threads, [&](std::size_t slice) {
    Eigen::Matrix3Xd centers(3, n);
    for (std::size_t first = slice * n * n; first < (slice + 1) * n * n; first += n) {
      centers.colwise() = edt.cellCenter(first);
      for (std::size_t x = 1; x < n; ++x) centers(0, x) = edt.origin().x() + edt.cellSize() * static_cast<double>(x);
      const std::vector<char> is_free = visibility->areFree(centers);
      for (std::size_t x = 0; x < n; ++x)
        if (is_free[x] != 0) free[first + x] = 1.0f - f[first + x];
    }
  });
  return free;
}

double correlation(const GaussianEdt& edt, const ReflectionPlane& plane, int num_threads) {
  constexpr std::size_t layers = 8;  // layers of cells along z in a slab
  // Sums of a slab, over cells in turn: rounding errors grow less than in a single sum.
  constexpr std::size_t num_sums = 8;
  const ReflectionPlane cells(plane.normal(), plane.signedDistance(edt.origin()) / -edt.cellSize());
  const Eigen::Vector3d step = Eigen::Vector3d::UnitX() - 2.0 * plane.normal().x() * plane.normal();
  const auto n = static_cast<std::size_t>(edt.numCells());
  std::vector<double> slabs((n + layers - 1) / layers);
  parallelBlocks(slabs.size(), num_threads, [&](std::size_t slab) {
    double sums[num_sums] = {};
    for (std::size_t row = slab * layers * n; row < std::min(n, (slab + 1) * layers) * n; ++row) {
      const GaussianEdt::Range filled = edt.filledRanges()[row];
      if (filled.begin == filled.end) continue;
      const float* const f = edt.values().data() + row * n;
      const Eigen::Vector3d first =
          cells.reflect(Eigen::Vector3d(0.0, static_cast<double>(row % n), static_cast<double>(row / n)));
      for (int x = filled.begin; x < filled.end; ++x)
        if (f[x] > 0.0f) sums[(x - filled.begin) % num_sums] += f[x] * edt.atCell(first + x * step);
    }
    slabs[slab] = std::accumulate(sums, sums + num_sums, 0.0);
  });
  return std::clamp(std::accumulate(slabs.begin(), slabs.end(), 0.0) / edt.sqNorm(), 0.0, 1.0);
}

void PlanarTransformOptions::validate() const {
  sampled.validate();
  convolution.validate();
  rotational.validate();
  voting.validate();
}

SymmetryMap planarTransform(const GaussianEdt& edt, const PlaneGrid& grid, const Eigen::Vector3d& center_of_mass,
                            const PlanarTransformOptions& options, const Visibility* visibility) {
  const std::vector<float> free_space = freeSpace(edt, visibility, options.sampled.num_threads);
  SymmetryMap map = transformed(edt, grid, options, free_space);
  if (visibility && options.method != TransformMethod::Sampled)
    weighSeen(map, freeOverlap(edt, grid, free_space, options.sampled));
  map.center_of_mass = center_of_mass;
  return map;
}

}  // namespace pcl_symmetry
