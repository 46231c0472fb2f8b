#include "core/transform/sampled_transform.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/point_samples.h"
#include "core/transform/line_sums.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t sampled_per_block = 32;  // directions

/// (S / |f|^2) mean g(gamma x_i) at every bin: D for g = f and, with free space, F for that.
std::vector<std::vector<float>> sampleMeans(const GaussianEdt& edt, const PlaneGrid& grid,
                                            const SampledTransformOptions& options,
                                            const std::vector<float>& free_space) {
  options.validate();
  const LookupTable table(edt, free_space, options.num_threads);
  const CoordinateRows points = drawPoints(edt, options.num_samples, options.seed, options.num_threads);
  // Of the grid, in cells from the middle of the cube of cells.
  const Eigen::Vector3f center = ((grid.center() - edt.origin()) / edt.cellSize()).cast<float>() -
                                 Eigen::Vector3f::Constant(0.5f * static_cast<float>(edt.numCells() - 1));
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
  parallelRanges(grid.numDirections(), sampled_per_block, options.num_threads, run);
  return means;
}

}  // namespace

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

namespace {

constexpr int block_side = 8;  // cells

/// The cells of a block along the Morton curve.
std::array<Eigen::Vector3i, block_side * block_side * block_side> cellsOfBlock() {
  std::array<Eigen::Vector3i, block_side * block_side * block_side> cells;
  for (int z = 0; z < block_side; ++z)
    for (int y = 0; y < block_side; ++y)
      for (int x = 0; x < block_side; ++x) cells[mortonCode(x, y, z)] = {x, y, z};
  return cells;
}

/// A cube of cells and its share of the sum of f.
struct Block {
  std::uint32_t code;  ///< along the Morton curve
  Eigen::Vector3i first_cell;
  double sum;
};

/// All blocks along the Morton curve.
std::vector<Block> blocksOf(const GaussianEdt& edt, int num_threads) {
  const int n = edt.numCells(), side = (n + block_side - 1) / block_side;
  std::vector<Block> blocks(static_cast<std::size_t>(side) * side * side);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        blocks[(static_cast<std::size_t>(z) * side + y) * side + x] = {mortonCode(x, y, z),
                                                                       block_side * Eigen::Vector3i(x, y, z), 0.0};
  parallelBlocks(side, num_threads, [&](std::size_t layer) {
    for (int z = static_cast<int>(layer) * block_side; z < std::min(n, static_cast<int>(layer + 1) * block_side); ++z) {
      for (int y = 0; y < n; ++y) {
        const float* const f = edt.values().data() + (static_cast<std::size_t>(z) * n + y) * n;
        Block* const row = &blocks[(layer * side + y / block_side) * side];
        for (int x = 0; x < n; x += block_side) {
          float sum = 0.0f;
          for (int i = x; i < std::min(n, x + block_side); ++i) sum += f[i];
          row[x / block_side].sum += sum;
        }
      }
    }
  });
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.code < b.code; });
  return blocks;
}

/// The cell of a block at which the sum of f along the curve passes \p target.
/// \param before sum before the block.
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

}  // namespace

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
    Eigen::Matrix3Xd centers(3, static_cast<Eigen::Index>(n));
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
  constexpr std::size_t layers = 8;    // of cells along z, a slab
  constexpr std::size_t num_sums = 8;  // of a slab, over cells in turn: rounding errors grow less than in one
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

}  // namespace pcl_symmetry
