#include "core/detection/plane_search.h"

#include <algorithm>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/detection/plane_decision.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

/// Refinement can stop short of a maximum where few points guide it, as on flat pieces. A plane is a separate maximum
/// only if D falls on the way to a better plane nearby.
bool isOnSlopeOf(const SymmetryPlane& better, const SymmetryPlane& plane, const NormalizedCloud& cloud) {
  const ReflectionPlane a = cloud.toNormalized(better), b = cloud.toNormalized(plane);
  if (!MergeTolerance{kDetection.decide.slope_angle, kDetection.decide.slope_offset}.same(a, b)) return false;
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d normal = a.normal() + sign * b.normal();
  const ReflectionPlane between(normal, 0.5 * normal.norm() * (a.offset() + sign * b.offset()));
  return cloud.score(cloud.toInput(between)) > plane.score - kDetection.decide.slope_dip;
}

/// Whether a plane belongs to a polygon; noise may level the dips of D between its planes.
bool isOfPolygon(const std::optional<RegularPolygon>& polygon, const SymmetryPlane& plane,
                 const NormalizedCloud& cloud) {
  return polygon && contains(cloud.toNormalized(plane), polygon->line);
}

/// Computes the support of all points for a plane that was judged by some of them.
void completeSupport(SymmetryPlane& plane, const PlaneSearch& search) {
  const NormalizedCloud& cloud = search.cloud;
  if (static_cast<Eigen::Index>(plane.point_support.size()) == cloud.points.cols()) return;
  plane.point_support =
      search.fit.shares(cloud.toNormalized(plane), allIndices(cloud.points.cols())).points.seenSupport();
}

/// Removes approximate planes that are symmetries of parts: they are reported as local ones.
std::vector<SymmetryPlane> withoutPlanesOfParts(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud) {
  const std::vector<ReflectionPlane> local = planesOf(planes, {PlaneKind::Local}, cloud);
  const auto isOfPart = [&](const SymmetryPlane& plane) {
    return plane.kind == PlaneKind::Approximate && kSamePlane.anySame(local, cloud.toNormalized(plane));
  };
  eraseIf(planes, isOfPart);
  return planes;
}

/// \return the plane of a cloud that is a sheet at the tolerance, input frame; else empty.
std::optional<ReflectionPlane> flatPlane(const PlaneSearch& search) {
  const ReflectionPlane plane = principalPlanes(search.cloud.principal_axes)[2];
  if (!search.measure.limits().leavesMostInPlace(plane, search.cloud.points)) return std::nullopt;
  return search.cloud.toInput(plane);
}

}  // namespace

std::vector<SymmetryPlane> selectReported(const PlaneSearch& search, std::vector<SymmetryPlane> planes,
                                          const std::optional<RegularPolygon>& polygon) {
  const NormalizedCloud& cloud = search.cloud;
  const DetectionOptions& options = search.options;
  planes = withoutPlanesOfParts(std::move(planes), cloud);
  // Equally confident planes, such as those of a polygon, are ordered by support.
  sortDescending(planes, &SymmetryPlane::support);
  std::vector<SymmetryPlane> ranked;
  for (SymmetryPlane& plane : sortPlanes(std::move(planes), options)) {
    if (static_cast<int>(ranked.size()) >= options.max_planes) break;
    if (plane.kind == PlaneKind::Possible && static_cast<int>(ranked.size()) >= kDetection.decide.max_possible)
      continue;
    const bool of_polygon = isOfPolygon(polygon, plane, cloud);
    const bool is_known = std::any_of(ranked.begin(), ranked.end(), [&](const SymmetryPlane& other) {
      if (of_polygon && isOfPolygon(polygon, other, cloud)) return plane.angleTo(other) < 0.5 * kPi / polygon->fold;
      if (kSamePlane.same(cloud.toNormalized(other), cloud.toNormalized(plane))) return true;
      // D is of the whole shape: planes of a part need not be maxima of it.
      return plane.kind != PlaneKind::Local && isOnSlopeOf(other, plane, cloud);
    });
    if (!is_known) ranked.push_back(std::move(plane));
  }
  parallelBlocks(ranked.size(), options.num_threads, [&](std::size_t i) { completeSupport(ranked[i], search); });
  return ranked;
}

std::optional<SymmetryPlane> bestApproximate(const PlaneSearch& search, const std::vector<SymmetryPlane>& planes) {
  const SymmetryPlane* best = nullptr;
  for (const SymmetryPlane& plane : planes) {
    if (isDecided(plane)) return std::nullopt;
    if (plane.kind == PlaneKind::Approximate && (!best || plane.share * plane.seen > best->share * best->seen))
      best = &plane;
  }
  if (!best) return std::nullopt;
  SymmetryPlane answer = *best;
  completeSupport(answer, search);
  return answer;
}

void report(const PlaneSearch& search, DetectionState& state) {
  Detection& found = state.answer;
  const NormalizedCloud& cloud = search.cloud;
  const PlaneMeasure& measure = search.measure;
  if (!found.hasFamily()) found.best = bestApproximate(search, found.planes);
  if (found.best) found.best->deviation = measure.deviation(cloud.toNormalized(*found.best)) * cloud.scale;
  found.undecided = found.best && !cloud.isScan() && found.best->share_low < kNearlySymmetricShare &&
                    found.best->share_high >= kSymmetricShare;
  found.flat = flatPlane(search);
  found.tolerance = measure.tolerance() * cloud.scale;
  const bool is_raised =
      search.options.absolute_tolerance == 0.0 && measure.tolerance() > search.options.tolerance * cloud.diameter;
  found.resolution = std::max(measure.resolution(), is_raised ? measure.tolerance() : 0.0) * cloud.scale;
  found.diameter = cloud.diameter * cloud.scale;
  found.planes = selectReported(search, std::move(found.planes), state.polygon);
}

}  // namespace pcl_symmetry
