#include "core/geometry/revolution_of_normals.h"

#include <algorithm>

#include "core/base/symmetric_solvers.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/small_motion.h"

namespace pcl_symmetry {

namespace {

double weightOf(double miss) {
  const double scaled = miss / kGeometry.normal_miss, sum = 1.0 + scaled * scaled;
  return 1.0 / (sum * sum);
}

/// A motion of space: rotation and shift, so that a point x moves by shift + rotation x x.
struct Motion {
  Eigen::Vector3d rotation, shift;

  Eigen::Vector3d velocityAt(const Eigen::Vector3d& x) const { return shift + rotation.cross(x); }
};

/// The motion with a rotation of length one that moves the samples the least along their normals.
Motion slowestAlongNormals(const Matrix6d& sum) {
  Eigen::Matrix3d shifts = sum.bottomRightCorner<3, 3>();
  shifts.diagonal().array() += kGeometry.translation_ridge * std::max(1e-12, shifts.trace());
  const Eigen::Matrix3d coupling = sum.topRightCorner<3, 3>();
  const Eigen::Matrix3d best_shifts = -solveSymmetric(shifts, Eigen::Matrix3d(coupling.transpose()));
  const Eigen::Matrix3d rotations = sum.topLeftCorner<3, 3>() + coupling * best_shifts;
  const SymmetricEigen<Eigen::Matrix3d> solver(0.5 * (rotations + rotations.transpose()));
  const Eigen::Vector3d rotation = solver.eigenvectors().col(0);
  const Eigen::Vector3d shift = best_shifts * rotation;
  return {rotation, shift - rotation.dot(shift) * rotation};  // without the translation along the axis
}

/// A point of a surface.
struct Oriented {
  Eigen::Vector3d point, normal;
};

std::vector<Oriented> orientedAt(const Points& points, const Points& normals, const std::vector<int>& samples) {
  std::vector<Oriented> oriented;
  oriented.reserve(samples.size());
  for (const int i : samples) oriented.push_back({points.col(i).cast<double>(), normals.col(i).cast<double>()});
  return oriented;
}

}  // namespace

Line3d axisOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples) {
  const std::vector<Oriented> oriented = orientedAt(points, normals, samples);
  std::vector<double> weights(oriented.size(), 1.0);
  Motion motion{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()};
  for (int k = 0; k < kGeometry.reweightings; ++k) {
    WeightedProducts products;  // of how fast points move along their normals, by rotation and by shift
    for (std::size_t i = 0; i < oriented.size(); ++i)
      products.add(oriented[i].point.cross(oriented[i].normal), oriented[i].normal, 0.0, weights[i]);
    motion = slowestAlongNormals(products.sums().topLeftCorner<6, 6>());
    for (std::size_t i = 0; i < oriented.size(); ++i) {
      const Eigen::Vector3d velocity = motion.velocityAt(oriented[i].point);
      const double lever = std::max(kGeometry.min_lever, velocity.norm());
      weights[i] = weightOf(velocity.dot(oriented[i].normal) / lever) / (lever * lever);
    }
  }
  // The axis is where the motion stands still.
  return {motion.rotation.cross(motion.shift), motion.rotation};
}

Eigen::Vector3d centerOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples) {
  const std::vector<Oriented> oriented = orientedAt(points, normals, samples);
  std::vector<double> weights(oriented.size(), 1.0);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (int k = 0; k < kGeometry.reweightings; ++k) {
    // The point with the least sum of w |(I - n n^T) (x - center)|^2.
    WeightedProducts products;
    for (std::size_t i = 0; i < oriented.size(); ++i) {
      const auto& [x, n] = oriented[i];
      products.add(n, x - n.dot(x) * n, 1.0, weights[i]);
    }
    const WeightedProducts::Matrix sums = products.sums();
    const Eigen::Matrix3d across =
        (sums(6, 6) + kGeometry.position_ridge) * Eigen::Matrix3d::Identity() - sums.topLeftCorner<3, 3>();
    const Eigen::Vector3d pull = sums.block<3, 1>(3, 6);
    center = solveSymmetric(across, pull);
    for (std::size_t i = 0; i < oriented.size(); ++i) {
      const Eigen::Vector3d d = oriented[i].point - center;
      const double lever = std::max(kGeometry.min_lever, d.norm());
      weights[i] = weightOf(d.cross(oriented[i].normal).norm() / lever) / (lever * lever);
    }
  }
  return center;
}

}  // namespace pcl_symmetry
