#pragma once

#include <Eigen/Geometry>

namespace pcl_symmetry {

/// The weighted sum of x x^T over rows x of seven numbers, many rows at a time. It is the same for every instruction
/// set.
class WeightedProducts {
public:
  static constexpr int kColumns = 7;  // derived: six unknowns and a right side
  using Matrix = Eigen::Matrix<double, kColumns, kColumns, Eigen::RowMajor>;

  void add(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double last, double weight) {
    for (int k = 0; k < 3; ++k) {
      columns_[k][num_rows_] = first[k];
      columns_[k + 3][num_rows_] = second[k];
    }
    columns_[kColumns - 1][num_rows_] = last;
    weights_[num_rows_] = weight;
    if (++num_rows_ == kMostRows) sumUp();
  }

  /// Of all rows that were added.
  Matrix sums();

private:
  static constexpr int kMostRows = 128;  // chosen: the columns fit the first cache; half calls twice as often

  void sumUp();

  double columns_[kColumns][kMostRows], weights_[kMostRows];
  int num_rows_ = 0;                  // that are not in the products yet
  Matrix products_ = Matrix::Zero();  // below the diagonal
};

/// Least squares in a small motion (rotation vector, translation).
class MotionEquations {
public:
  /// \param unit of the lengths, > 0, so that turns and translations count alike.
  explicit MotionEquations(double unit) : unit_(unit) {}

  /// w (n . (x + rotation x x + translation) - n . y)^2.
  void addPlane(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& n, double weight) {
    of_planes_.add(x.cross(n) / unit_, n, n.dot(y - x) / unit_, weight);
  }

  /// w |x + rotation x x + translation - y|^2: the sum of addPlane() over three normals.
  void addPoint(const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
    of_points_.add(x / unit_, (y - x) / unit_, 1.0, weight);
  }

  /// The motion of least squares; no motion where the points fix none.
  Eigen::Isometry3d motion();

private:
  double unit_;
  WeightedProducts of_planes_;  // of lever, normal and distance
  WeightedProducts of_points_;  // of arm, way and 1
};

}  // namespace pcl_symmetry
