#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// Sums over points that give their mean and covariance.
/// Floats are precise enough for points near the origin of their frame.
struct Moments {
  float count = 0.0f;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();

  void add(const Eigen::Vector3f& p) {
    count += 1.0f;
    sum += p;
    squares += p * p.transpose();
  }
  void operator+=(const Moments& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }

  /// Sum of the outer products of the deviations from the mean: the covariance times count.
  Eigen::Matrix3f scatter() const { return squares - sum * sum.transpose() / count; }
};

}  // namespace pcl_symmetry
