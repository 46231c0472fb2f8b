#include "core/neighbours/closest_point_grid.h"

#include <cmath>
#include <limits>

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

// radii of the bounding ball; chosen: less sends more queries to the border, more makes cells wider
constexpr double kCoveredRadii = 1.25;

/// Distance transform with the index of the closest point, by eight sweeps that hand points on from cell to cell.
class ClosestPointSweeps {
public:
  ClosestPointSweeps(const PointsRef& points, int num_cells, const Eigen::Vector3f& origin, float cell_size)
      : points_(points),
        n_(num_cells),
        origin_(origin),
        cell_size_(cell_size),
        nearest_(static_cast<std::size_t>(n_) * n_ * n_, -1),
        sq_distances_(nearest_.size(), std::numeric_limits<float>::infinity()) {}

  /// Offers each point to the cell that contains it. \param last greatest coordinate inside the cube, in cells.
  void enterPoints(float last) {
    for (Eigen::Index i = 0; i < points_.cols(); ++i) {
      const Eigen::Array3i cell = ((points_.col(i) - origin_) / cell_size_).array().max(0.0f).min(last).cast<int>();
      offer(index(cell.x(), cell.y(), cell.z()), centerOf(cell.x(), cell.y(), cell.z()), static_cast<int>(i));
    }
  }

  /// Goes through the cells towards one corner of the cube; each cell takes over what its three predecessors know.
  void sweep(int dx, int dy, int dz) {
    for (int k = 0, z = dz > 0 ? 0 : n_ - 1; k < n_; ++k, z += dz) {
      for (int j = 0, y = dy > 0 ? 0 : n_ - 1; j < n_; ++j, y += dy) {
        for (int i = 0, x = dx > 0 ? 0 : n_ - 1; i < n_; ++i, x += dx) {
          const std::size_t cell = index(x, y, z);
          const Eigen::Vector3f center = centerOf(x, y, z);
          if (i > 0) takeOver(cell, center, cell - dx);
          if (j > 0) takeOver(cell, center, cell - static_cast<std::ptrdiff_t>(dy) * n_);
          if (k > 0) takeOver(cell, center, cell - static_cast<std::ptrdiff_t>(dz) * n_ * n_);
        }
      }
    }
  }

  std::vector<int> nearest() && { return std::move(nearest_); }

private:
  std::size_t index(int x, int y, int z) const { return (static_cast<std::size_t>(z) * n_ + y) * n_ + x; }
  Eigen::Vector3f centerOf(int x, int y, int z) const {
    return origin_ + cell_size_ * Eigen::Vector3f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                                                  static_cast<float>(z) + 0.5f);
  }
  void offer(std::size_t cell, const Eigen::Vector3f& center, int point) {
    const float sq_distance = (points_.col(point) - center).squaredNorm();
    if (!(sq_distance < sq_distances_[cell])) return;
    sq_distances_[cell] = sq_distance;
    nearest_[cell] = point;
  }
  void takeOver(std::size_t cell, const Eigen::Vector3f& center, std::size_t from) {
    if (nearest_[from] >= 0 && nearest_[from] != nearest_[cell]) offer(cell, center, nearest_[from]);
  }

  const PointsRef& points_;
  int n_;
  Eigen::Vector3f origin_;
  float cell_size_;
  std::vector<int> nearest_;
  std::vector<float> sq_distances_;
};

}  // namespace

ClosestPointGrid::ClosestPointGrid(const PointsRef& points, int num_cells) : num_cells_(num_cells) {
  check(points.cols() >= 1, "number of points", points.cols(), ">= 1");
  check(num_cells >= 2, "num_cells", num_cells, ">= 2");
  const BoundingBall ball = boundingBall(points);
  const double half = ball.radius > 0.0 ? kCoveredRadii * ball.radius : 1.0;
  cell_size_ = static_cast<float>(2.0 * half / num_cells);
  last_ = static_cast<float>(num_cells) - 0.5f;
  origin_ = (ball.center.array() - half).matrix().cast<float>();

  ClosestPointSweeps sweeps(points, num_cells, origin_, cell_size_);
  sweeps.enterPoints(last_);
  for (int corner = 0; corner < 8; ++corner)
    sweeps.sweep(corner & 1 ? -1 : 1, corner & 2 ? -1 : 1, corner & 4 ? -1 : 1);
  nearest_ = std::move(sweeps).nearest();
}

}  // namespace pcl_symmetry
