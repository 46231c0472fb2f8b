#include "evaluate/references/plane_families.h"
#include "core/base/constants.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>

namespace pcl_symmetry::apps {

namespace {

double goldenFraction(int k) {
  constexpr double kGoldenRatio = 0.61803398874989485;  // derived: (sqrt(5) - 1) / 2
  return k * kGoldenRatio - std::floor(k * kGoldenRatio);
}

}  // namespace

std::vector<ReflectionPlane> planesThrough(const Line3d& line, int count) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  std::vector<ReflectionPlane> planes;
  for (int k = 0; k < count; ++k) {
    const double angle = kPi * goldenFraction(k);
    const Eigen::Vector3d n = std::cos(angle) * u + std::sin(angle) * v;
    planes.emplace_back(n, n.dot(line.origin()));
  }
  return planes;
}

std::vector<ReflectionPlane> planesThrough(const Eigen::Vector3d& point, int count) {
  std::vector<ReflectionPlane> planes;
  for (int k = 0; k < count; ++k) {
    const double z = (k + 0.5) / count, angle = 2.0 * kPi * goldenFraction(k), ring = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d n(ring * std::cos(angle), ring * std::sin(angle), z);
    planes.emplace_back(n, n.dot(point));
  }
  return planes;
}

Line3d commonLine(const std::vector<ReflectionPlane>& planes, const Line3d& start) {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (const ReflectionPlane& plane : planes) normals += plane.normal() * plane.normal().transpose();
  const Eigen::Vector3d direction = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(normals).eigenvectors().col(0);
  const auto size = static_cast<Eigen::Index>(planes.size());
  Eigen::MatrixX3d a(size + 1, 3);
  Eigen::VectorXd b(size + 1);
  for (Eigen::Index i = 0; i < size; ++i) {
    a.row(i) = planes[i].normal().transpose();
    b[i] = planes[i].offset();
  }
  a.row(size) = direction.transpose();
  b[size] = direction.dot(start.origin());
  return Line3d(a.colPivHouseholderQr().solve(b), direction);
}

Eigen::Vector3d commonPoint(const std::vector<Line3d>& lines) {
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Line3d& line : lines) {
    const Eigen::Matrix3d p = Eigen::Matrix3d::Identity() - line.direction() * line.direction().transpose();
    across += p;
    sum += p * line.origin();
  }
  return across.ldlt().solve(sum);
}

}  // namespace pcl_symmetry::apps
