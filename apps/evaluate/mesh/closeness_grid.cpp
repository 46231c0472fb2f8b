#include "evaluate/mesh/closeness_grid.h"

#include <cmath>

#include "core/base/parallel.h"

namespace pcl_symmetry::apps {

namespace {

/// Cells along an edge of a block, of which a single distance may tell that all are out of reach. chosen: half asks
/// more blocks, twice more cells.
constexpr int kBlock = 8;
constexpr int kBlocks = ClosenessGrid::kCells / kBlock;  // derived: along an edge of the grid
static_assert(kBlocks * kBlock == ClosenessGrid::kCells);
constexpr double kCell = 2.0 * ClosenessGrid::kHalfEdge / ClosenessGrid::kCells;  // diagonals; derived: edge of a cell

}  // namespace

ClosenessGrid::ClosenessGrid(const TriangleScene& scene, double reach, int num_threads)
    : values_(static_cast<std::size_t>(kCells) * kCells * kCells) {
  const MeshDistance distance(scene);
  parallelBlocks(kBlocks * kBlocks * kBlocks, num_threads, [&](std::size_t i) {
    const int block = static_cast<int>(i);
    fillBlock(distance, reach,
              {kBlock * (block % kBlocks), kBlock * (block / kBlocks % kBlocks), kBlock * (block / kBlocks / kBlocks)});
  });
}

void ClosenessGrid::fillBlock(const MeshDistance& distance, double reach, const std::array<int, 3>& first) {
  const auto middle = [&](double x, double y, double z) -> Eigen::Vector3d {
    return Eigen::Vector3d(x, y, z) * kCell - Eigen::Vector3d::Constant(kHalfEdge);
  };
  const double half_diagonal = 0.5 * std::sqrt(3.0) * kBlock * kCell;
  const double half = 0.5 * kBlock;
  if (!distance.within(middle(first[0] + half, first[1] + half, first[2] + half), reach + half_diagonal)) return;
  for (int z = first[2]; z < first[2] + kBlock; ++z) {
    for (int y = first[1]; y < first[1] + kBlock; ++y) {
      for (int x = first[0]; x < first[0] + kBlock; ++x) {
        const auto closest = distance.closest(middle(x + 0.5, y + 0.5, z + 0.5), reach);
        if (!closest) continue;
        const double rest = 1.0 - std::pow(closest->distance / reach, 2);
        values_[(static_cast<std::size_t>(z) * kCells + y) * kCells + x] =
            static_cast<std::uint8_t>(std::lround(255.0 * rest * rest));
      }
    }
  }
}

}  // namespace pcl_symmetry::apps
