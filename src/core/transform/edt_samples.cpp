#include "core/transform/edt_samples.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace pcl_symmetry {

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
