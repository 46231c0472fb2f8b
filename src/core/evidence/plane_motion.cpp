#include "core/evidence/plane_motion.h"

#include <algorithm>

#include "core/base/symmetric_solvers.h"
#include "core/evidence/surface_samples.h"

namespace pcl_symmetry {

PlaneChart::PlaneChart(const ReflectionPlane& plane, const Eigen::Vector3d& about, double unit_of_shift)
    : n(plane.normal()),
      u(n.unitOrthogonal()),
      v(n.cross(u)),
      pivot(about),
      extent(unit_of_shift),
      offset(plane.offset() - n.dot(pivot)) {}

ReflectionPlane PlaneChart::moved(const Eigen::Vector3d& step) const {
  const Eigen::Vector3d normal = (n + step[0] * u + step[1] * v).normalized();
  return ReflectionPlane(normal, normal.dot(pivot) + offset + step[2] * extent);
}

Eigen::Matrix3d motionStiffness(const Points& points, const Points& normals, const std::vector<char>& matched,
                                const ReflectionPlane& plane) {
  const PlaneChart chart(plane, Eigen::Vector3d::Zero());
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    if (!matched[i]) continue;
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d x = points.col(column).cast<double>(), normal = normals.col(column).cast<double>();
    const double height = -plane.signedDistance(x);  // of the point that x is the reflection of
    const Eigen::Vector3d gradient = chart.slope(x + 2.0 * height * chart.n, height, normal);
    information += gradient * gradient.transpose();
    count += 1.0;
  }
  return count > 0.0 ? Eigen::Matrix3d(information / count) : information;
}

double offsetStiffness(const Eigen::Matrix3d& stiffness) {
  Eigen::Matrix2d tilts = stiffness.topLeftCorner<2, 2>();
  tilts.diagonal().array() += kEvidence.tilt_ridge;
  const Eigen::Vector2d coupling = stiffness.topRightCorner<2, 1>();
  return std::max(0.0, stiffness(2, 2) - coupling.dot(solveSymmetric(tilts, coupling)));
}

double secondStiffness(const Eigen::Matrix3d& stiffness) {
  const SymmetricEigen<Eigen::Matrix3d> solver(stiffness);
  return std::max(0.0, solver.eigenvalues()[1]);
}

}  // namespace pcl_symmetry
