#include "scene/support_bulge.h"

#include <pcl/common/common.h>
#include <pcl/common/point_tests.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace pcl_symmetry::detail {

namespace {

// Tolerances, root mean square distance of the points of a flat piece from their plane. measured: 17 pieces of the wall
// of PCL's stereo picture have 0.5 to 2.4. At half, a third of them stay, at twice, low objects count as flat.
constexpr double kFlat = 3.0;
// Share of the outline of a bulge along which the surface goes on into a support. measured: 0.58 to 1 for 16 of these
// pieces; at most 0.18 for objects of nine scenes of fold 0 on a table, with the noise of a depth camera.
constexpr double kGoesOn = 0.5;

/// Root mean square distance of points from their plane of least squares.
double thicknessOf(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster) {
  const Eigen::Vector3d origin = frame[cluster.front()].getVector3fMap().cast<double>();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const pcl::index_t i : cluster) {
    const Eigen::Vector3d x = frame[i].getVector3fMap().cast<double>() - origin;
    sum += x;
    squares += x * x.transpose();
  }
  const auto count = static_cast<double>(cluster.size());
  const Eigen::Vector3d mean = sum / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares / count - mean * mean.transpose(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

double diagonalOf(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster) {
  Eigen::Vector4f low, high;
  pcl::getMinMax3D(frame, cluster, low, high);
  return static_cast<double>((high - low).head<3>().norm());
}

/// Share of the outline of a cluster beyond which the next pixel is of a support and no farther than \p distance.
double goingOn(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster,
               const std::vector<SupportingPlane>& supports, double distance) {
  enum : char { Other, Inside, Support };
  std::vector<char> kinds(frame.size(), Other);
  for (const SupportingPlane& support : supports)
    for (const pcl::index_t i : support.indices) kinds[static_cast<std::size_t>(i)] = Support;
  for (const pcl::index_t i : cluster) kinds[static_cast<std::size_t>(i)] = Inside;
  const auto width = static_cast<std::ptrdiff_t>(frame.width), height = static_cast<std::ptrdiff_t>(frame.height);
  std::size_t num_ends = 0, num_going_on = 0;
  for (const pcl::index_t i : cluster) {
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const std::ptrdiff_t x = i % width + dx, y = i / width + dy;
      const bool is_in_picture = x >= 0 && y >= 0 && x < width && y < height;
      const auto next = static_cast<std::size_t>(is_in_picture ? y * width + x : i);
      if (is_in_picture && kinds[next] == Inside) continue;
      ++num_ends;
      if (kinds[next] == Support && (frame[next].getVector3fMap() - frame[i].getVector3fMap()).norm() < distance)
        ++num_going_on;
    }
  }
  return num_ends == 0 ? 0.0 : static_cast<double>(num_going_on) / static_cast<double>(num_ends);
}

}  // namespace

bool isBulge(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster,
             const std::vector<SupportingPlane>& supports, double tolerance, double distance) {
  if (!frame.isOrganized()) return false;
  return thicknessOf(frame, cluster) < kFlat * tolerance * diagonalOf(frame, cluster) &&
         goingOn(frame, cluster, supports, distance) > kGoesOn;
}

}  // namespace pcl_symmetry::detail
