#include "core/geometry/closest_point_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

// radii of the bounding ball; chosen: less sends more queries to the border, more makes cells wider
constexpr double kCoveredRadii = 1.25;

/// Cells along x, and what each knows: the place and index of a point, and the squared distance of its center from it.
/// Cells that know none have a point at infinity.
struct CellRow {
  float *x, *y, *z, *sq_distance;
  int* index;
};

/// Each cell takes over the point of the cell of another row where that is closer.
/// \param cx,cy,cz centers of the cells.
/// \param[in,out] taken 1 where a cell has taken over a point.
PCL_SYMMETRY_MULTIVERSION
void takeOverRow(const CellRow& row, const CellRow& from, const float* cx, float cy, float cz, int size, int* taken) {
  float *const x = row.x, *const y = row.y, *const z = row.z, *const sq_distance = row.sq_distance;
  const float *const from_x = from.x, *const from_y = from.y, *const from_z = from.z;
  int* const index = row.index;
  const int* const from_index = from.index;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const float dx = from_x[i] - cx[i], dy = from_y[i] - cy, dz = from_z[i] - cz;
    const float sq = dx * dx + (dy * dy + dz * dz);
    const bool closer = sq < sq_distance[i];
    x[i] = closer ? from_x[i] : x[i];
    y[i] = closer ? from_y[i] : y[i];
    z[i] = closer ? from_z[i] : z[i];
    sq_distance[i] = closer ? sq : sq_distance[i];
    index[i] = closer ? from_index[i] : index[i];
    taken[i] = closer ? 1 : taken[i];
  }
}

/// Marks the cells that the point of the cell one step before is closer to than their own, or as close as one that they
/// have taken over.
/// \param before the cells one step before those of \p row.
/// \return whether there are any.
PCL_SYMMETRY_MULTIVERSION
bool markBehind(const CellRow& row, const CellRow& before, const float* cx, float cy, float cz, int size,
                const int* taken, int* marks) {
  const float *const x = before.x, *const y = before.y, *const z = before.z, *const sq_distance = row.sq_distance;
  int any = 0;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    const float dx = x[i] - cx[i], dy = y[i] - cy, dz = z[i] - cz;
    const float sq = dx * dx + (dy * dy + dz * dz);
    marks[i] = (sq < sq_distance[i]) | ((sq == sq_distance[i]) & taken[i]);
    any |= marks[i];
  }
  return any != 0;
}

/// Distance transform with the index of the closest point, by eight sweeps that hand points on from cell to cell.
///
/// Each cell asks its three predecessors along x, y and z, in this order, for closer points. Those along y and z are
/// final before a row begins, so that all cells of the row ask them at once. The one along x comes afterwards, and
/// takes its place before them where points are equally far away.
class ClosestPointSweeps {
public:
  ClosestPointSweeps(const PointsRef& points, int num_cells, const Eigen::Vector3f& origin, float cell_size)
      : points_(points),
        n_(num_cells),
        origin_(origin),
        cell_size_(cell_size),
        places_(3 * numCells(), kUnknown),
        sq_distances_(numCells(), kUnknown),
        nearest_(numCells(), -1),
        taken_(static_cast<std::size_t>(n_)),
        marks_(static_cast<std::size_t>(n_)),
        centers_(static_cast<std::size_t>(n_)) {
    for (int x = 0; x < n_; ++x) centers_[static_cast<std::size_t>(x)] = centerOf(x, 0, 0).x();
  }

  /// Offers each point to the cell that contains it.
  /// \param last greatest coordinate inside the cube, in cells.
  void enterPoints(float last) {
    for (Eigen::Index i = 0; i < points_.cols(); ++i) {
      const Eigen::Array3i cell = ((points_.col(i) - origin_) / cell_size_).array().max(0.0f).min(last).cast<int>();
      const CellRow row = rowOf(cell.y(), cell.z());
      const float sq_distance = (points_.col(i) - centerOf(cell.x(), cell.y(), cell.z())).squaredNorm();
      if (!(sq_distance < row.sq_distance[cell.x()])) continue;
      row.x[cell.x()] = points_(0, i);
      row.y[cell.x()] = points_(1, i);
      row.z[cell.x()] = points_(2, i);
      row.sq_distance[cell.x()] = sq_distance;
      row.index[cell.x()] = static_cast<int>(i);
    }
  }

  /// Goes through the cells towards one corner of the cube; each cell takes over what its three predecessors know.
  void sweep(int dx, int dy, int dz) {
    for (int k = 0, z = dz > 0 ? 0 : n_ - 1; k < n_; ++k, z += dz) {
      for (int j = 0, y = dy > 0 ? 0 : n_ - 1; j < n_; ++j, y += dy) {
        const CellRow row = rowOf(y, z);
        const Eigen::Vector3f center = centerOf(0, y, z);
        std::fill(taken_.begin(), taken_.end(), 0);
        if (j > 0) takeOverRow(row, rowOf(y - dy, z), centers_.data(), center.y(), center.z(), n_, taken_.data());
        if (k > 0) takeOverRow(row, rowOf(y, z - dz), centers_.data(), center.y(), center.z(), n_, taken_.data());
        const int first = dx > 0 ? 1 : 0;  // of the cells with one before them
        if (markBehind(shifted(row, first), shifted(row, first - dx), centers_.data() + first, center.y(), center.z(),
                       n_ - 1, taken_.data() + first, marks_.data() + first))
          handOn(row, dx, center.y(), center.z());
      }
    }
  }

  std::vector<int> nearest() && { return std::move(nearest_); }

private:
  static constexpr float kUnknown = std::numeric_limits<float>::infinity();  // derived: farther than every point

  std::size_t numCells() const { return static_cast<std::size_t>(n_) * n_ * n_; }
  CellRow rowOf(int y, int z) {
    const std::size_t first = (static_cast<std::size_t>(z) * n_ + y) * n_;
    float* const x = places_.data() + first;
    return {x, x + numCells(), x + 2 * numCells(), sq_distances_.data() + first, nearest_.data() + first};
  }
  Eigen::Vector3f centerOf(int x, int y, int z) const {
    return origin_ + cell_size_ * Eigen::Vector3f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                                                  static_cast<float>(z) + 0.5f);
  }

  static CellRow shifted(const CellRow& row, int by) {
    return {row.x + by, row.y + by, row.z + by, row.sq_distance + by, row.index + by};
  }

  /// Marked cells of a row take over points from the cells before them, and those behind them may, one after the other.
  void handOn(const CellRow& row, int step, float cy, float cz) {
    bool is_new = false;  // the point of the cell before
    for (int i = step > 0 ? 1 : n_ - 2; i >= 0 && i < n_; i += step) {
      const auto at = static_cast<std::size_t>(i);
      if (!is_new && marks_[at] == 0) continue;
      const int before = i - step;
      const float dx = row.x[before] - centers_[at], dy = row.y[before] - cy, dz = row.z[before] - cz;
      const float sq = dx * dx + (dy * dy + dz * dz);
      is_new = sq < row.sq_distance[i] || (sq == row.sq_distance[i] && taken_[at] != 0);
      if (!is_new) continue;
      row.x[i] = row.x[before];
      row.y[i] = row.y[before];
      row.z[i] = row.z[before];
      row.sq_distance[i] = sq;
      row.index[i] = row.index[before];
    }
  }

  const PointsRef& points_;
  int n_;
  Eigen::Vector3f origin_;
  float cell_size_;
  std::vector<float> places_, sq_distances_;  // of the points of the cells
  std::vector<int> nearest_;
  std::vector<int> taken_, marks_;  // of the cells of a row
  std::vector<float> centers_;      // of cells along x
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
