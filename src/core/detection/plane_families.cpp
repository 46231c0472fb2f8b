#include "core/detection/plane_families.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace pcl_symmetry {

namespace {

constexpr std::size_t kMostPlanes = 8;      // whose common lines are looked at
constexpr double kLeastAngle = 0.17;        // radians between planes that tell their common line
constexpr double kContainedAngle = 0.0524;  // radians, 3 degrees
constexpr int kScreening = 3, kFitted = 6, kTested = 8;
constexpr double kGoldenRatio = 0.61803398874989485;

double golden(int k) {
  return k * kGoldenRatio - std::floor(k * kGoldenRatio);
}

ReflectionPlane planeThrough(const AxisLine& line, int k) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  const double angle = M_PI * golden(k + 1);
  const Eigen::Vector3d n = std::cos(angle) * u + std::sin(angle) * v;
  return ReflectionPlane(n, n.dot(line.origin()));
}

/// Normals on a Fibonacci half sphere.
ReflectionPlane planeThrough(const Eigen::Vector3d& point, int k, int count) {
  const double z = (k + 0.5) / count, angle = 2.0 * M_PI * golden(k + 1), ring = std::sqrt(1.0 - z * z);
  const Eigen::Vector3d n(ring * std::cos(angle), ring * std::sin(angle), z);
  return ReflectionPlane(n, n.dot(point));
}

/// The point closest to all planes; of many such points the one closest to \p start.
Eigen::Vector3d commonPoint(const std::vector<ReflectionPlane>& planes, const Eigen::Vector3d& start) {
  Eigen::MatrixX3d normals(planes.size(), 3);
  Eigen::VectorXd distances(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    normals.row(i) = planes[i].normal();
    distances[i] = -planes[i].signedDistance(start);
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixX3d> solver;
  solver.setThreshold(0.05);
  solver.compute(normals);
  return start + solver.solve(distances);
}

AxisLine commonLine(const std::vector<ReflectionPlane>& planes) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const ReflectionPlane& plane : planes) sum += plane.normal() * plane.normal().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  const Eigen::Vector3d direction = solver.eigenvectors().col(0);
  const Eigen::Vector3d point = commonPoint(planes, Eigen::Vector3d::Zero());
  return AxisLine(point - direction.dot(point) * direction, direction);
}

/// Mean share of planes of a family; stops when it cannot reach the least any more.
template <typename PlaneAt>
double meanShare(const PlaneAt& plane_at, int count, double least,
                 const std::function<double(const ReflectionPlane&)>& share) {
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    sum += share(plane_at(k));
    if (sum + (count - k - 1) < least * count) return 0.0;
  }
  return sum / count;
}

template <typename PlaneAt>
std::vector<ReflectionPlane> planesAt(const PlaneAt& plane_at) {
  std::vector<ReflectionPlane> planes;
  for (int k = 0; k < kTested; ++k) planes.push_back(plane_at(k));
  return planes;
}

}  // namespace

bool contains(const ReflectionPlane& plane, const AxisLine& line, double tolerance) {
  return std::abs(plane.normal().dot(line.direction())) <= std::sin(kContainedAngle) &&
         std::abs(plane.signedDistance(line.origin())) <= tolerance;
}

std::optional<CenterFamily> findCenter(const std::vector<ReflectionPlane>& planes, const FamilyTest& test) {
  if (planes.size() < 3) return std::nullopt;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const ReflectionPlane& plane : planes) sum += plane.normal() * plane.normal().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum / static_cast<double>(planes.size()),
                                                              Eigen::EigenvaluesOnly);
  if (solver.eigenvalues()[0] < 0.02) return std::nullopt;  // all through one line
  Eigen::Vector3d point = commonPoint(planes, Eigen::Vector3d::Zero());
  const double least = std::max(test.min_share, test.share(planes[0]) - test.allowance);
  const auto at = [&](int k) { return planeThrough(point, k, kTested); };
  if (meanShare(at, kScreening, least - 2.0 * test.allowance, test.rough_share) == 0.0) return std::nullopt;
  std::vector<ReflectionPlane> refined;
  for (int k = 0; k < kFitted; ++k) refined.push_back(test.refine(planeThrough(point, k, kFitted)));
  point = commonPoint(refined, point);
  const double share = meanShare(at, kTested, least, test.share);
  if (share < least) return std::nullopt;
  return CenterFamily{point, share, planesAt(at)};
}

std::vector<AxisFamily> findAxes(const std::vector<ReflectionPlane>& planes, const FamilyTest& test) {
  std::vector<AxisFamily> axes;
  std::vector<AxisLine> tried;
  const std::size_t size = std::min(planes.size(), kMostPlanes);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double angle = planes[i].angleTo(planes[j]);
      if (angle < kLeastAngle) continue;
      AxisLine line = commonLine({planes[i], planes[j]});
      const bool known = std::any_of(tried.begin(), tried.end(), [&](const AxisLine& other) {
        return std::abs(other.direction().dot(line.direction())) > std::cos(kContainedAngle) &&
               other.distance(line.origin()) < test.tolerance;
      });
      if (known) continue;
      tried.push_back(line);
      const double least =
          std::max(test.min_share, std::max(test.share(planes[i]), test.share(planes[j])) - test.allowance);
      const auto at = [&](int k) { return planeThrough(line, k); };
      // A line of two rough planes may be off by a little, the refined one has to stand the test.
      if (meanShare(at, kScreening, least - 2.0 * test.allowance, test.rough_share) == 0.0) continue;
      std::vector<ReflectionPlane> refined;
      for (int k = 0; k < kFitted; ++k) refined.push_back(test.refine(planeThrough(line, k)));
      line = commonLine(refined);
      const double share = meanShare(at, kTested, least, test.share);
      if (share < least) continue;
      tried.push_back(line);
      axes.push_back({line, share, planesAt(at)});
    }
  }
  std::stable_sort(axes.begin(), axes.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  return axes;
}

}  // namespace pcl_symmetry
