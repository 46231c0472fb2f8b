#include "core/geometry/closest_point_grid.h"

#include <limits>

#include "core/base/check.h"

namespace pcl_symmetry {

/// A distance transform with the index of the closest point: eight sweeps hand points on from cell to cell.
ClosestPointGrid::ClosestPointGrid(const PointsRef& points, int num_cells) : n_(num_cells) {
  check(points.cols() >= 1, "number of points", points.cols(), ">= 1");
  check(n_ >= 2, "num_cells", n_, ">= 2");
  const BoundingBall ball = boundingBall(points);
  const double half = ball.radius > 0.0 ? 1.25 * ball.radius : 1.0;
  cell_size_ = static_cast<float>(2.0 * half / n_);
  last_ = static_cast<float>(n_) - 0.5f;
  origin_ = (ball.center.array() - half).matrix().cast<float>();
  nearest_.assign(static_cast<std::size_t>(n_) * n_ * n_, -1);
  std::vector<float> sq_distances(nearest_.size(), std::numeric_limits<float>::infinity());

  // The cell keeps the point if it is closer to its center than the one that it has.
  const auto offer = [&](int point, int x, int y, int z) {
    int& nearest = nearest_[indexOf(x, y, z)];
    if (point < 0 || point == nearest) return;
    const Eigen::Vector3f center = origin_ + cell_size_ * Eigen::Vector3f(x + 0.5f, y + 0.5f, z + 0.5f);
    const float sq_distance = (points.col(point) - center).squaredNorm();
    float& least = sq_distances[indexOf(x, y, z)];
    if (!(sq_distance < least)) return;
    least = sq_distance;
    nearest = point;
  };
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3i cell = cellOf(points.col(i));
    offer(static_cast<int>(i), cell.x(), cell.y(), cell.z());
  }
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1 ? -1 : 1, dy = corner & 2 ? -1 : 1, dz = corner & 4 ? -1 : 1;
    for (int k = 0, z = dz > 0 ? 0 : n_ - 1; k < n_; ++k, z += dz)
      for (int j = 0, y = dy > 0 ? 0 : n_ - 1; j < n_; ++j, y += dy)
        for (int i = 0, x = dx > 0 ? 0 : n_ - 1; i < n_; ++i, x += dx) {
          if (i > 0) offer(nearest_[indexOf(x - dx, y, z)], x, y, z);
          if (j > 0) offer(nearest_[indexOf(x, y - dy, z)], x, y, z);
          if (k > 0) offer(nearest_[indexOf(x, y, z - dz)], x, y, z);
        }
  }
}

}  // namespace pcl_symmetry
