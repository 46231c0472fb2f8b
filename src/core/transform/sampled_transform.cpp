#include "core/transform/sampled_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/transform/free_space.h"
#include "core/transform/line_sums.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t sampled_per_block = 32;  // directions

/// D(gamma) = (S / |f|^2) mean g(gamma x_i) at every bin, for each function g of the table.
std::vector<std::vector<float>> sampleMeans(const GaussianEdt& edt, const PlaneGrid& grid,
                                            const SampledTransformOptions& options, const LookupTable& table) {
  options.validate();
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
    LineSums::Totals totals(table.numFunctions(), std::vector<double>(num_radius));
    for (std::size_t direction = begin; direction < end; ++direction) {
      for (auto& total : totals) std::fill(total.begin(), total.end(), 0.0);
      const Eigen::Vector3f n = grid.normal(direction).cast<float>();
      sums.addReflected(points, {{n.x(), n.y(), n.z()}, n.dot(center) + first_offset, radius_step, num_radius}, totals);
      for (std::size_t g = 0; g < means.size(); ++g)
        for (int k = 0; k < num_radius; ++k)
          means[g][direction * num_radius + k] = static_cast<float>(scale * totals[g][k]);
    }
  };
  parallelRanges(grid.numDirections(), sampled_per_block, options.num_threads, run);
  return means;
}

const float* checkedFreeSpace(const GaussianEdt& edt, const std::vector<float>& free_space) {
  check(free_space.size() == edt.values().size(), "free_space size", free_space.size(), "one value per cell");
  return free_space.data();
}

}  // namespace

void SampledTransformOptions::validate() const {
  check(num_samples >= 1 && num_samples <= 10'000'000, "num_samples", num_samples, "in [1, 10000000]");
  checkNumThreads(num_threads);
}

SymmetryMap sampledTransform(const GaussianEdt& edt, const PlaneGrid& grid, const SampledTransformOptions& options,
                             const std::vector<float>& free_space) {
  // Sharpened by 1/12: a sample's uniform position in its cell and the look-up of the nearest cell are two boxes.
  std::vector<const float*> functions{edt.interpolation().data()};
  if (!free_space.empty()) functions.push_back(checkedFreeSpace(edt, free_space));
  const LookupTable table(functions, edt.numCells(), options.num_threads);
  std::vector<std::vector<float>> means = sampleMeans(edt, grid, options, table);
  SymmetryMap map{grid, std::move(means[0]), TransformMethod::Sampled, edt.sigma(), grid.center()};
  if (!free_space.empty()) weighSeen(map, means[1]);
  return map;
}

std::vector<float> freeOverlap(const GaussianEdt& edt, const PlaneGrid& grid, const std::vector<float>& free_space,
                               const SampledTransformOptions& options) {
  const LookupTable table({checkedFreeSpace(edt, free_space)}, edt.numCells(), options.num_threads);
  return std::move(sampleMeans(edt, grid, options, table)[0]);
}

void weighSeen(SymmetryMap& map, const std::vector<float>& free_overlap) {
  for (std::size_t i = 0; i < map.values.size(); ++i)
    map.values[i] = static_cast<float>(seenSymmetry(map.values[i], free_overlap[i]));
}

namespace {

constexpr int block_bits = 3;
constexpr int block_side = 1 << block_bits;  // cells

/// Positions of a cube of 2^kBits cells along the Morton curve: the bits of three coordinates, interleaved.
template <int kBits>
std::array<std::array<std::uint8_t, 3>, (1 << 3 * kBits)> mortonCurve() {
  std::array<std::array<std::uint8_t, 3>, (1 << 3 * kBits)> curve{};
  for (std::size_t code = 0; code < curve.size(); ++code)
    for (int bit = 0; bit < 3 * kBits; ++bit)
      curve[code][bit % 3] |= static_cast<std::uint8_t>((code >> bit & 1) << (bit / 3));
  return curve;
}

/// One coordinate's share of a Morton code: its bits, three places apart.
std::uint32_t mortonPart(std::uint32_t v) {
  std::uint32_t spread = 0;
  for (int bit = 0; bit < 10; ++bit) spread |= (v >> bit & 1u) << (3 * bit);
  return spread;
}

/// A cube of cells and its share of the sum of f.
struct Block {
  std::uint32_t code;  ///< along the Morton curve
  int x, y, z;         ///< first cell
  double sum;
};

/// All blocks along the Morton curve.
std::vector<Block> blocksOf(const GaussianEdt& edt, int num_threads) {
  const int n = edt.numCells(), side = (n + block_side - 1) / block_side;
  std::vector<Block> blocks(static_cast<std::size_t>(side) * side * side);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        blocks[(static_cast<std::size_t>(z) * side + y) * side + x] = {
            mortonPart(x) | mortonPart(y) << 1 | mortonPart(z) << 2, x * block_side, y * block_side, z * block_side,
            0.0};
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
  static const auto kCurve = mortonCurve<block_bits>();
  const int n = edt.numCells();
  double sum = before;
  Eigen::Vector3f chosen = Eigen::Vector3f::Zero();
  for (const auto& place : kCurve) {
    const int x = block.x + place[0], y = block.y + place[1], z = block.z + place[2];
    if (x >= n || y >= n || z >= n) continue;
    const float f = edt.values()[(static_cast<std::size_t>(z) * n + y) * n + x];
    if (f == 0.0f) continue;
    chosen = Eigen::Vector3f(x, y, z);
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

}  // namespace pcl_symmetry
