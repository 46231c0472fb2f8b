#include "core/transform/cell_distances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

/// Points on a bent sheet that reaches beyond the cube, and copies of some.
Points sheet(int num_cells, int size) {
  RandomStream random(7);
  Points points(3, size);
  const auto n = static_cast<float>(num_cells);
  for (int i = 0; i < size; ++i) {
    const auto u = static_cast<float>(1.4 * random.uniform() - 0.2),
               v = static_cast<float>(1.4 * random.uniform() - 0.2);
    points.col(i) = n * Eigen::Vector3f(u, v, 0.4f + 0.5f * u * v);
  }
  for (int i = 0; i < size / 10; ++i) points.col(i) = points.col(size - 1 - i);
  return points;
}

/// The same by comparing each cell with each point.
std::vector<float> byDefinition(const Points& points, int num_cells, float reach) {
  std::vector<float> sq_distances;
  for (int z = 0; z < num_cells; ++z)
    for (int y = 0; y < num_cells; ++y)
      for (int x = 0; x < num_cells; ++x) {
        float least = reach * reach;
        for (Eigen::Index i = 0; i < points.cols(); ++i) {
          const float dx = static_cast<float>(x) - points(0, i), dy = static_cast<float>(y) - points(1, i),
                      dz = static_cast<float>(z) - points(2, i);
          least = std::min(least, dx * dx + (dz * dz + dy * dy));
        }
        sq_distances.push_back(least);
      }
  return sq_distances;
}

TEST(CellDistances, AreThoseOfTheNearestPoints) {
  for (const int num_cells : {8, 18, 24}) {
    for (const int size : {1, 30, 2000}) {
      for (const float reach : {1.0f, 5.2f, 20.0f}) {
        const Points points = sheet(num_cells, size);
        const CellDistances distances(points, num_cells, reach);
        std::vector<float> found(static_cast<std::size_t>(num_cells) * num_cells * num_cells, -1.0f);
        for (int row = 0; row < distances.numRows(); ++row) distances.fill(row, found.data());
        const std::vector<float> expected = byDefinition(points, num_cells, reach);
        for (std::size_t i = 0; i < found.size(); ++i)
          ASSERT_FLOAT_EQ(found[i], expected[i]) << num_cells << " " << size << " " << reach << " cell " << i;
      }
    }
  }
}

}  // namespace
}  // namespace pcl_symmetry
