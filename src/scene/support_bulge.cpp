#include "scene/support_bulge.h"

#include <pcl/common/point_tests.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "core/geometry/cloud_extent.h"
#include "scene/scene_parts.h"

namespace pcl_symmetry::detail {

namespace {

// Root mean square distance of the points of a flat piece from their plane, in tolerances. 17 pieces of the wall in
// PCL's stereo picture have 0.5 to 2.4.
constexpr double kFlat = 3.0;
// Shares of the outline of a piece of a wall or table along which the surface goes on, at least, and behind which
// something farther is seen, at most: 0.3 to 0.94 and 0.01 to 0.02 for such pieces in PCL's frames of a
// stereo camera and of a Kinect; 0.22 to 0.43 of the outlines of flat objects on tables are before something farther.
constexpr double kGoesOn = 0.25, kBeforeFarther = 0.05;
constexpr double kDepthErrors = 4.0;  // of the sensor, by which neighbors on one surface may be apart

/// Whether the surface goes on at the outline of a cluster, and is seen to end nowhere before something farther.
bool goesOn(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster, const Visibility& seen, double distance) {
  std::vector<char> is_inside(frame.size(), 0);
  for (const pcl::index_t i : cluster) is_inside[i] = 1;
  const Eigen::Vector3d viewpoint = seen.viewpoint();
  const auto width = static_cast<std::ptrdiff_t>(frame.width), height = static_cast<std::ptrdiff_t>(frame.height);
  double num_ends = 0.0, num_going_on = 0.0, num_before_farther = 0.0;
  for (const pcl::index_t i : cluster) {
    const Eigen::Vector3d x = frame[i].getVector3fMap().cast<double>();
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const std::ptrdiff_t u = i % width + dx, v = i / width + dy;
      const bool is_in_picture = u >= 0 && v >= 0 && u < width && v < height;
      const auto next = static_cast<std::size_t>(is_in_picture ? v * width + u : i);
      if (is_in_picture && is_inside[next]) continue;
      num_ends += 1.0;
      if (!is_in_picture || !pcl::isXYZFinite(frame[next])) continue;
      const Eigen::Vector3d beside = frame[next].getVector3fMap().cast<double>();
      if ((beside - x).norm() < distance + kDepthErrors * seen.depthError(x))
        num_going_on += 1.0;
      else if ((beside - viewpoint).norm() > (x - viewpoint).norm())
        num_before_farther += 1.0;
    }
  }
  return num_going_on > kGoesOn * num_ends && num_before_farther < kBeforeFarther * num_ends;
}

}  // namespace

bool isBulge(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster, const Visibility* seen, double tolerance,
             double distance) {
  if (!frame.isOrganized() || !seen) return false;
  const Points points = pointsOf(frame, cluster);
  const double thickness = std::sqrt(principalAxes(points).variances[2]);  // root mean square distance from their plane
  return thickness < kFlat * tolerance * boxDiagonal(points) && goesOn(frame, cluster, *seen, distance);
}

}  // namespace pcl_symmetry::detail
