#include "pcl_symmetry/core/sampled_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "check.h"
#include "line_kernel.h"
#include "lookup_table.h"
#include "pcl_symmetry/core/parallel.h"
#include "pcl_symmetry/core/random.h"
#include "pcl_symmetry/core/visibility.h"
#include "simd.h"

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

/// Points of the EDT in cells from its first cell center: a cell drawn by f, then a uniform place in it. One point
/// falls in each of num_samples equal shares of sum f along a space-filling curve, so that the points are spread
/// evenly.
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

/// (S / |f|^2) mean g(gamma x_i) at every bin for each function g.
/// \param tables the functions, values of all cells made into tables of one size.
std::vector<std::vector<float>> sampleMeans(const GaussianEdt& edt, const PlaneGrid& grid,
                                            const SampledTransformOptions& options,
                                            const std::vector<LookupTable>& tables) {
  options.validate();
  const Eigen::Matrix3Xf points = drawPoints(edt, options.num_samples, options.seed, options.num_threads);
  const LineKernel accumulate = lineKernel(options.simd);

  // Everything below is in cells, relative to the middle of the EDT's cube.
  const double middle = 0.5 * (edt.numCells() - 1);
  const Eigen::Vector3f center =
      ((grid.center() - edt.origin()) / edt.cellSize()).cast<float>() - Eigen::Vector3f::Constant(middle);
  const float radius_step = static_cast<float>(grid.radiusStep() / edt.cellSize());
  const float first_offset = static_cast<float>(grid.offset(0) / edt.cellSize());
  const float sq_clip = static_cast<float>(std::pow(middle - 0.5, 2));
  const Eigen::Vector3f to_table = tables[0].toTable(Eigen::Vector3d::Constant(middle)).cast<float>();
  const float one = static_cast<float>(1 << LookupTable::kFractionBits);

  std::vector<std::vector<float>> means(tables.size(), std::vector<float>(grid.size()));
  const double scale = edt.sum() / (edt.sqNorm() * options.num_samples * LookupTable::kOne);
  const int num_radius = grid.numRadius();
  constexpr std::size_t kDirectionsPerBlock = 32;
  constexpr int kChunk = 1024;  // samples that are set up at a time
  parallelRanges(
      grid.numDirections(), kDirectionsPerBlock, options.num_threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::int32_t> sums(num_radius + 2 * kLineLanes);
        std::vector<std::int32_t> lines(5 * kChunk);
        Lines batch{lines.data(),
                    lines.data() + kChunk,
                    lines.data() + 2 * kChunk,
                    lines.data() + 3 * kChunk,
                    lines.data() + 4 * kChunk,
                    0,
                    {}};
        std::vector<std::vector<double>> totals(tables.size(), std::vector<double>(num_radius));
        for (std::size_t direction = begin; direction < end; ++direction) {
          const Eigen::Vector3f n =
              grid.normal(static_cast<int>(direction / grid.numPhi()), static_cast<int>(direction % grid.numPhi()))
                  .cast<float>();
          const float offset = n.dot(center) + first_offset;  // of the first plane from the middle of the cube
          for (int axis = 0; axis < 3; ++axis)
            batch.step[axis] = static_cast<std::int32_t>(std::lround(2.0f * radius_step * n[axis] * one));
          for (auto& total : totals) std::fill(total.begin(), total.end(), 0.0);
          for (int first = 0; first < options.num_samples; first += kChunk) {
            batch.size = std::min(kChunk, options.num_samples - first);
            setUpLines(points.data() + 3 * first, static_cast<float>(middle), n.data(), offset, radius_step, num_radius,
                       sq_clip, to_table[0], one, batch);
            for (std::size_t g = 0; g < tables.size(); ++g) {
              std::fill(sums.begin(), sums.end(), 0);
              accumulate(batch, tables[g].data(), tables[g].bits(), sums.data());
              for (int k = 0; k < num_radius; ++k) totals[g][k] += sums[k];
            }
          }
          for (std::size_t g = 0; g < tables.size(); ++g)
            for (int k = 0; k < num_radius; ++k)
              means[g][direction * num_radius + k] = static_cast<float>(scale * totals[g][k]);
        }
      });
  return means;
}

LookupTable tableOf(const GaussianEdt& edt, int num_threads) {
  // Jitter within the cell and look-up of the nearest cell: two boxes.
  return LookupTable(edt.sharpened(1.0 / 12.0, num_threads), edt.numCells(), num_threads);
}

LookupTable tableOf(const GaussianEdt& edt, const std::vector<float>& free_space, int num_threads) {
  check(free_space.size() == edt.values().size(), "free_space size", free_space.size(), "one value per cell");
  return LookupTable(free_space, edt.numCells(), num_threads);
}

}  // namespace

void SampledTransformOptions::validate() const {
  check(num_samples >= 1 && num_samples <= 10'000'000, "num_samples", num_samples, "in [1, 10000000]");
  checkNumThreads(num_threads);
  check(simdSupported(simd), "simd", static_cast<int>(simd), "one that this processor supports");
}

SymmetryMap sampledTransform(const GaussianEdt& edt, const PlaneGrid& grid, const SampledTransformOptions& options,
                             const std::vector<float>& free_space) {
  std::vector<LookupTable> tables{tableOf(edt, options.num_threads)};
  if (!free_space.empty()) tables.push_back(tableOf(edt, free_space, options.num_threads));
  std::vector<std::vector<float>> means = sampleMeans(edt, grid, options, tables);
  SymmetryMap map;
  map.grid = grid;
  map.values = std::move(means[0]);
  map.method = TransformMethod::Sampled;
  map.sigma = edt.sigma();
  map.center_of_mass = grid.center();
  if (!free_space.empty()) weighSeen(map, means[1]);
  return map;
}

std::vector<float> freeOverlap(const GaussianEdt& edt, const PlaneGrid& grid, const std::vector<float>& free_space,
                               const SampledTransformOptions& options) {
  return std::move(sampleMeans(edt, grid, options, {tableOf(edt, free_space, options.num_threads)})[0]);
}

void weighSeen(SymmetryMap& map, const std::vector<float>& free_overlap) {
  for (std::size_t i = 0; i < map.values.size(); ++i)
    map.values[i] = static_cast<float>(seenSymmetry(map.values[i], free_overlap[i]));
}

}  // namespace pcl_symmetry
