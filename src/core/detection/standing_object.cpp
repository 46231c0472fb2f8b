#include "core/detection/standing_object.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/base/median.h"
#include "core/detection/detection_rules.h"
#include "core/detection/plane_decision.h"
#include "core/detection/plane_measure.h"
#include "core/geometry/surface_normals.h"
#include "core/scan/upright_box.h"

namespace pcl_symmetry {

namespace {

/// The least signed distance of the points from a support.
double heightOf(const PointsRef& points, const Eigen::Vector4d& support) {
  return (support.head<3>().transpose().cast<float>() * points).minCoeff() + support[3];
}

}  // namespace

std::vector<Eigen::Vector3d> carryingNormals(const PointsRef& points, const Visibility& seen) {
  std::vector<double> heights;
  for (const Eigen::Vector4d& support : seen.supports()) heights.push_back(heightOf(points, support));
  if (heights.empty()) return {};
  const double reach = *std::min_element(heights.begin(), heights.end()) +
                       kDetection.decide.touching * 2.0 * boundingBall(points).radius;
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (heights[i] <= reach) normals.push_back(seen.supports()[i].head<3>().normalized());
  return normals;
}

bool slants(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& carrying_normals) {
  const auto is_along = [&](const Eigen::Vector3d& normal) {
    const double angle = std::acos(std::min(1.0, std::abs(normal.dot(plane.normal()))));
    return angle <= kDetection.decide.upright || angle >= 0.5 * kPi - kDetection.decide.upright;
  };
  return !carrying_normals.empty() && std::none_of(carrying_normals.begin(), carrying_normals.end(), is_along);
}

void decideByUprightBox(const PlaneInput& input, const DetectionOptions& options, Detection& found) {
  const PointsRef points = input.points;
  const Visibility& seen = *input.visibility;
  const std::vector<Eigen::Vector3d> up = carryingNormals(points, seen);
  if (up.empty()) return;
  const ClosestPointSearch::Ptr search = input.make_search ? input.make_search(points) : makeFlannSearch(points);
  const double spacing = median(localGeometry(points, *search, kNumSupportNeighbors, options.num_threads).spacing);
  const bool is_sparse = spacing > kDetection.decide.no_surface * found.tolerance;
  const bool is_decided = !found.axes.empty() || !found.centers.empty() ||
                          (!found.planes.empty() && found.planes.front().kind == PlaneKind::Symmetry);
  if (is_decided && !is_sparse) return;
  const std::optional<MiddlePlane> middle = middlePlaneOfBox(points, up.front(), seen.viewpoint());
  std::optional<SymmetryPlane> plane;
  if (middle) {
    plane.emplace(middle->plane);
    plane->share = middle->num_met / (middle->num_met + middle->num_free);
    plane->share_low = middle->num_met / middle->num_moved;
    plane->share_high = 1.0 - middle->num_free / middle->num_moved;
    plane->support = middle->num_met / middle->num_moved;
    plane->seen = (middle->num_met + middle->num_free) / middle->num_moved;
    plane->residual = middle->residual;
    plane->converged = true;
    plane->point_support = middle->point_support;
    const CloudLimits limits(points, principalAxes(points), CloudKind::Scan, &seen,
                             {found.tolerance, found.resolution, spacing, found.diameter});
    for (const char* rule : limits.of(*plane, points)) limitToPossible(*plane, rule);
    setConfidence(*plane, middle->confidence, "the sides of the upright box around the points", options);
  }
  if (is_sparse) {
    found.planes.clear();
    found.axes.clear();
    found.centers.clear();
    found.rotations.clear();
    found.best = plane;
  }
  if (!plane || plane->confidence < (is_sparse ? options.min_possible : options.min_confidence)) return;
  // Found before, it was no more than possible.
  const BoundingBall ball = boundingBall(points);
  const auto in_ball = [&](const ReflectionPlane& other) { return normalized(other, ball.center, ball.radius); };
  found.planes.erase(
      std::remove_if(found.planes.begin(), found.planes.end(),
                     [&](const SymmetryPlane& other) { return kSamePlane.same(in_ball(other), in_ball(*plane)); }),
      found.planes.end());
  found.planes.insert(found.planes.begin(), std::move(*plane));
  found.planes = reordered(std::move(found.planes), options);
  if (static_cast<int>(found.planes.size()) > options.max_planes) found.planes.resize(options.max_planes);
  found.best.reset();
}

}  // namespace pcl_symmetry
