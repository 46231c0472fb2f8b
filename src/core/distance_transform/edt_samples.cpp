#include "core/distance_transform/edt_samples.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace pcl_symmetry {

namespace {

/// Positions of a 2^b cube along the Morton curve: three interleaved coordinates.
template <int kBits>
std::array<std::array<std::uint8_t, 3>, (1 << 3 * kBits)> mortonCurve() {
  std::array<std::array<std::uint8_t, 3>, (1 << 3 * kBits)> curve{};
  for (std::size_t code = 0; code < curve.size(); ++code)
    for (int bit = 0; bit < 3 * kBits; ++bit)
      curve[code][bit % 3] |= static_cast<std::uint8_t>((code >> bit & 1) << (bit / 3));
  return curve;
}

std::uint32_t mortonPart(std::uint32_t v) {
  std::uint32_t spread = 0;
  for (int bit = 0; bit < 10; ++bit) spread |= (v >> bit & 1u) << (3 * bit);
  return spread;
}

}  // namespace

Eigen::Matrix3Xf drawPoints(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads) {
  constexpr int kBlockBits = 3, kBlock = 1 << kBlockBits;
  static const auto kCurve = mortonCurve<kBlockBits>();
  const int n = edt.numCells();
  const int side = (n + kBlock - 1) / kBlock;
  const auto& f = edt.values();
  const auto cell = [&](int x, int y, int z) { return (static_cast<std::size_t>(z) * n + y) * n + x; };

  struct Block {
    std::uint32_t code;
    int x, y, z;
    double sum;
  };
  std::vector<Block> blocks(static_cast<std::size_t>(side) * side * side);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        blocks[(static_cast<std::size_t>(z) * side + y) * side + x] = {
            mortonPart(x) | mortonPart(y) << 1 | mortonPart(z) << 2, x * kBlock, y * kBlock, z * kBlock, 0.0};
  parallelBlocks(side, num_threads, [&](std::size_t layer) {
    for (int z = static_cast<int>(layer) * kBlock; z < std::min(n, static_cast<int>(layer + 1) * kBlock); ++z) {
      for (int y = 0; y < n; ++y) {
        Block* row = &blocks[(layer * side + y / kBlock) * side];
        for (int x = 0; x < n; x += kBlock) {
          float sum = 0.0f;
          for (int i = x; i < std::min(n, x + kBlock); ++i) sum += f[cell(i, y, z)];
          row[x / kBlock].sum += sum;
        }
      }
    }
  });
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.code < b.code; });
  double total = 0.0;
  for (const Block& block : blocks) total += block.sum;

  Eigen::Matrix3Xf points(3, num_samples);
  RandomStream random(seed);
  std::size_t b = 0;
  double before = 0.0;  // sum over the blocks before b
  for (int i = 0; i < num_samples; ++i) {
    const double target = (i + random.uniform()) * total / num_samples;
    while (b + 1 < blocks.size() && before + blocks[b].sum <= target) before += blocks[b++].sum;
    double sum = before;
    Eigen::Vector3f chosen = Eigen::Vector3f::Zero();
    for (const auto& place : kCurve) {
      const int x = blocks[b].x + place[0], y = blocks[b].y + place[1], z = blocks[b].z + place[2];
      if (x >= n || y >= n || z >= n || f[cell(x, y, z)] == 0.0f) continue;
      chosen = Eigen::Vector3f(x, y, z);
      sum += f[cell(x, y, z)];
      if (sum > target) break;
    }
    for (int axis = 0; axis < 3; ++axis) points(axis, i) = chosen[axis] + static_cast<float>(random.uniform() - 0.5);
  }
  return points;
}

}  // namespace pcl_symmetry
