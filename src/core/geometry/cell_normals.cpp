#include "core/geometry/cell_normals.h"

#include <algorithm>

#include "core/base/symmetric_solvers.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/moments.h"

namespace pcl_symmetry {

namespace {

/// Moments of the points in each occupied cell. Occupied cells have slots, in the order of their first points.
class CellMoments {
public:
  explicit CellMoments(int num_cells)
      : side_(num_cells + 2), slot_of_cells_(static_cast<std::size_t>(side_) * side_ * side_, -1) {}

  /// \param x position in cells from the corner of the cube.
  /// \return the slot of its cell.
  int add(const Eigen::Vector3d& x) {
    const Eigen::Array3i at = (x.array() + 1.0).max(1.0).min(static_cast<double>(side_ - 2)).cast<int>();
    const int index = (at.z() * side_ + at.y()) * side_ + at.x();
    int& slot = slot_of_cells_[index];
    if (slot < 0) {
      slot = static_cast<int>(occupied_.size());
      occupied_.push_back(index);
      moments_.emplace_back();
    }
    // Relative to the middle of the cube: floats are precise enough there.
    moments_[slot].add((x - Eigen::Vector3d::Constant(0.5 * (side_ - 2))).cast<float>());
    return slot;
  }

  std::size_t numOccupied() const { return occupied_.size(); }

  /// Sum over a cell and its 26 neighbors.
  Moments around(std::size_t slot) const {
    Moments sum;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const int near = slot_of_cells_[occupied_[slot] + (z * side_ + y) * side_ + x];
          if (near >= 0) sum += moments_[near];
        }
    return sum;
  }

private:
  int side_;  // cells along each side, with a border of one empty cell
  std::vector<int> slot_of_cells_;
  std::vector<int> occupied_;  // index of the cell of each slot
  std::vector<Moments> moments_;
};

}  // namespace

CellNormals cellNormals(const PointsRef& points, const Eigen::Vector3d& origin, double cell_size, int num_cells) {
  CellMoments cells(num_cells);
  CellNormals result;
  result.cell_of_points.resize(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    result.cell_of_points[i] = cells.add((points.col(i).cast<double>() - origin) / cell_size);
  result.normals.resize(3, cells.numOccupied());
  result.flatness.setZero(result.normals.cols());
  for (std::size_t c = 0; c < cells.numOccupied(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    result.normals.col(column).setUnit(2);
    const Moments near = cells.around(c);
    if (near.count < kGeometry.fewest_cell_points) continue;
    const SymmetricEigen<Eigen::Matrix3f> axes(near.scatter());
    const Eigen::Vector3f& values = axes.eigenvalues();
    if (!(values[2] > 0.0f) || !axes.eigenvectors().allFinite()) continue;
    result.normals.col(column) = axes.eigenvectors().col(0).normalized();
    result.flatness[column] = std::max(0.0f, (values[1] - values[0]) / values[2]);
  }
  return result;
}

}  // namespace pcl_symmetry
