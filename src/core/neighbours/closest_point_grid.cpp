#include "core/neighbours/closest_point_grid.h"

#include <cmath>
#include <limits>

#include "core/base/check.h"

namespace pcl_symmetry {

ClosestPointGrid::ClosestPointGrid(const PointsRef& points, int num_cells) : num_cells_(num_cells) {
  constexpr double kCoveredRadii = 1.25;
  check(points.cols() >= 1, "number of points", points.cols(), ">= 1");
  check(num_cells >= 2, "num_cells", num_cells, ">= 2");
  const BoundingBall ball = boundingBall(points);
  const double half = ball.radius > 0.0 ? kCoveredRadii * ball.radius : 1.0;
  cell_size_ = static_cast<float>(2.0 * half / num_cells);
  last_ = static_cast<float>(num_cells) - 0.5f;
  origin_ = (ball.center.array() - half).matrix().cast<float>();

  const int n = num_cells;
  const auto index = [n](int x, int y, int z) { return (static_cast<std::size_t>(z) * n + y) * n + x; };
  nearest_.assign(static_cast<std::size_t>(n) * n * n, -1);
  std::vector<float> sq_distances(nearest_.size(), std::numeric_limits<float>::infinity());
  const auto offer = [&](std::size_t cell, const Eigen::Vector3f& center, int point) {
    const float sq_distance = (points.col(point) - center).squaredNorm();
    if (!(sq_distance < sq_distances[cell])) return;
    sq_distances[cell] = sq_distance;
    nearest_[cell] = point;
  };
  const auto centerOf = [&](int x, int y, int z) {
    return Eigen::Vector3f(origin_ + cell_size_ * Eigen::Vector3f(static_cast<float>(x) + 0.5f, y + 0.5f, z + 0.5f));
  };
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3i cell = ((points.col(i) - origin_) / cell_size_).array().max(0.0f).min(last_).cast<int>();
    offer(index(cell.x(), cell.y(), cell.z()), centerOf(cell.x(), cell.y(), cell.z()), static_cast<int>(i));
  }

  // Eight sweeps, one towards each corner of the cube, hand the points on from cell to cell.
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1 ? -1 : 1, dy = corner & 2 ? -1 : 1, dz = corner & 4 ? -1 : 1;
    for (int k = 0, z = dz > 0 ? 0 : n - 1; k < n; ++k, z += dz) {
      for (int j = 0, y = dy > 0 ? 0 : n - 1; j < n; ++j, y += dy) {
        for (int i = 0, x = dx > 0 ? 0 : n - 1; i < n; ++i, x += dx) {
          const std::size_t cell = index(x, y, z);
          const Eigen::Vector3f center = centerOf(x, y, z);
          const auto take = [&](bool inside, std::size_t from) {
            if (inside && nearest_[from] >= 0 && nearest_[from] != nearest_[cell]) offer(cell, center, nearest_[from]);
          };
          take(i > 0, cell - dx);
          take(j > 0, cell - static_cast<std::ptrdiff_t>(dy) * n);
          take(k > 0, cell - static_cast<std::ptrdiff_t>(dz) * n * n);
        }
      }
    }
  }
}

}  // namespace pcl_symmetry
