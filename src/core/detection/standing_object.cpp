#include "core/detection/standing_object.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

// Radians from upright or level within which a plane does not slant. chosen: planes of noisy scans are off by three
// degrees; half doubts some of them, twice lets a third of the slanting ones pass.
constexpr double kUpright = 5.0 * kPi / 180.0;
// Diameters farther from the points than the nearest support that others carry the object, too: a box stands on a table
// and touches a wall. chosen: half takes noise for a gap, twice takes in walls behind an object.
constexpr double kTouching = 0.05;
/// The least signed distance of the points from a support.
double heightOf(const PointsRef& points, const Eigen::Vector4d& support) {
  return (support.head<3>().transpose().cast<float>() * points).minCoeff() + support[3];
}

}  // namespace

std::vector<Eigen::Vector3d> carryingNormals(const PointsRef& points, const Visibility& seen) {
  std::vector<double> heights;
  for (const Eigen::Vector4d& support : seen.supports()) heights.push_back(heightOf(points, support));
  if (heights.empty()) return {};
  const double reach =
      *std::min_element(heights.begin(), heights.end()) + kTouching * 2.0 * boundingBall(points).radius;
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (heights[i] <= reach) normals.push_back(seen.supports()[i].head<3>().normalized());
  return normals;
}

bool slants(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& carrying_normals) {
  const auto is_along = [&](const Eigen::Vector3d& normal) {
    const double angle = std::acos(std::min(1.0, std::abs(normal.dot(plane.normal()))));
    return angle <= kUpright || angle >= 0.5 * kPi - kUpright;
  };
  return !carrying_normals.empty() && std::none_of(carrying_normals.begin(), carrying_normals.end(), is_along);
}

}  // namespace pcl_symmetry
