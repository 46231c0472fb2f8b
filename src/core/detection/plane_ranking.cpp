#include "core/detection/plane_ranking.h"
#include "core/detection/candidates.h"
#include "core/detection/plane_decision.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/detection/plane_tolerance.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

// Radians, and radii: how far the slope of a maximum may reach. chosen: twice the limits of a basin of refinement;
// smaller values report planes that came to rest on a slope, larger ones only cost a value of D each.
constexpr PlaneTolerance kSlope{0.2, 0.15};
// Difference of D. chosen: what rounding and cells make of a level slope; larger values drop shallow maxima of their
// own.
constexpr double kSlopeDip = 0.005;

/// Refinement can come to rest on the way to a maximum, where few points say how to go on (on flat pieces, for
/// instance). A plane is a maximum of its own only if D falls on the way to a better plane nearby.
bool isOnSlopeOf(const SymmetryPlane& better, const SymmetryPlane& plane, const NormalizedCloud& cloud) {
  const ReflectionPlane a = cloud.toNormalized(better), b = cloud.toNormalized(plane);
  if (!kSlope.same(a, b)) return false;
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d normal = a.normal() + sign * b.normal();
  const ReflectionPlane between(normal, 0.5 * normal.norm() * (a.offset() + sign * b.offset()));
  return cloud.score(cloud.toInput(between)) > plane.score - kSlopeDip;
}

/// Whether a plane is of a polygon, between whose planes noise may leave no dip.
bool isOf(const std::optional<PlaneLattice>& polygon, const SymmetryPlane& plane, const NormalizedCloud& cloud) {
  return polygon && contains(cloud.toNormalized(plane), polygon->line, kContainedOffset);
}

/// Judges every point, where the plane was judged by some of them.
void completeSupport(SymmetryPlane& plane, const NormalizedCloud& cloud, const PlaneFit& fit) {
  if (static_cast<Eigen::Index>(plane.point_support.size()) == cloud.points.cols()) return;
  plane.point_support = fit.shares(cloud.toNormalized(plane), allOf(cloud.points.cols())).point_support;
}

/// An approximate plane that is a symmetry of a part is reported as that.
std::vector<SymmetryPlane> withoutPlanesOfParts(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud,
                                                const PlaneTolerance& tolerance) {
  std::vector<ReflectionPlane> local;
  for (const SymmetryPlane& plane : planes)
    if (plane.kind == PlaneKind::Local) local.push_back(cloud.toNormalized(plane));
  const auto is_of_part = [&](const SymmetryPlane& plane) {
    return plane.kind == PlaneKind::Approximate && tolerance.anySame(local, cloud.toNormalized(plane));
  };
  planes.erase(std::remove_if(planes.begin(), planes.end(), is_of_part), planes.end());
  return planes;
}

}  // namespace

std::vector<SymmetryPlane> rankedPlanes(std::vector<SymmetryPlane> planes, const std::optional<PlaneLattice>& polygon,
                                        const NormalizedCloud& cloud, const PlaneFit& fit,
                                        const DetectionOptions& options) {
  const PlaneTolerance tolerance = mergeTolerance(options);
  planes = withoutPlanesOfParts(std::move(planes), cloud, tolerance);
  std::stable_sort(planes.begin(), planes.end(), isBetter);
  std::vector<SymmetryPlane> ranked;
  for (SymmetryPlane& plane : planes) {
    if (static_cast<int>(ranked.size()) >= options.max_planes) break;
    if (rankOf(plane) == 2 && !options.approximate) continue;
    if (rankOf(plane) == 1 && static_cast<int>(ranked.size()) >= options.max_possible) continue;
    const bool of_polygon = isOf(polygon, plane, cloud);
    const bool is_known = std::any_of(ranked.begin(), ranked.end(), [&](const SymmetryPlane& other) {
      if (tolerance.same(cloud.toNormalized(other), cloud.toNormalized(plane))) return true;
      // D is of the whole shape: planes of a part need not be maxima of it.
      if (plane.kind == PlaneKind::Local) return false;
      return !(of_polygon && isOf(polygon, other, cloud)) && isOnSlopeOf(other, plane, cloud);
    });
    if (!is_known) ranked.push_back(std::move(plane));
  }
  parallelBlocks(ranked.size(), options.num_threads, [&](std::size_t i) { completeSupport(ranked[i], cloud, fit); });
  return ranked;
}

std::optional<ReflectionPlane> flatPlane(const NormalizedCloud& cloud, Thinness thinness) {
  if (thinness != Thinness::Sheet) return std::nullopt;
  const PrincipalAxes& axes = cloud.principal_axes;
  return cloud.toInput(ReflectionPlane(axes.axes.col(2), axes.axes.col(2).dot(axes.center)));
}

std::optional<SymmetryPlane> bestApproximate(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                             const PlaneFit& fit) {
  const SymmetryPlane* best = nullptr;
  for (const SymmetryPlane& plane : planes) {
    if (rankOf(plane) < 2) return std::nullopt;
    if (plane.kind == PlaneKind::Approximate && (!best || plane.share * plane.seen > best->share * best->seen))
      best = &plane;
  }
  if (!best) return std::nullopt;
  SymmetryPlane answer = *best;
  completeSupport(answer, cloud, fit);
  return answer;
}

}  // namespace pcl_symmetry
