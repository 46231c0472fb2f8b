#include "core/detection/judged_cloud.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/detection/cloud_subset.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

std::vector<SymmetryPlane> JudgedCloud::refinedAndJudged(std::vector<Candidate> candidates) const {
  candidates = refinement.refineFully(std::move(candidates));
  std::vector<MeasuredPlane> measured = decision.judge(candidates);
  std::vector<char> may_climb;
  for (const MeasuredPlane& one : measured)
    may_climb.push_back(one.plane.confidence >= kDetection.fit.climbing_confidence);
  decision.judge(candidates, refinement.climb(candidates, may_climb), measured);
  std::vector<SymmetryPlane> planes;
  for (MeasuredPlane& one : measured) planes.push_back(std::move(one.plane));
  return planes;
}

std::vector<SymmetryPlane> refinedAt(const std::vector<ReflectionPlane>& starts, const PlaneInput& input,
                                     const DetectionOptions& options) {
  if (!whyUnanswerable(input.points).empty()) return {};
  const std::optional<std::vector<int>> subset = subsetOf(input.points, options);
  const DistinctPoints distinct(subset ? pointsAt(input.points, *subset) : Points(input.points));
  const GaussianEdt edt(distinct.points, options.edtOptions());
  const NormalizedCloud cloud(distinct.points, edt, nullptr, input.visibility, options.num_threads);
  const JudgedCloud judged(cloud, cloud.points, options);
  std::vector<Candidate> candidates;
  for (const ReflectionPlane& start : starts) candidates.push_back({cloud.toNormalized(start)});
  return judged.refinedAndJudged(judged.refinement.refineClosely(std::move(candidates)));
}

namespace {

/// Refinement can stop on the way to a maximum where few points guide it, as on flat pieces. A plane is a maximum of
/// its own only if D falls on the way to a better plane nearby.
bool isOnSlopeOf(const SymmetryPlane& better, const SymmetryPlane& plane, const NormalizedCloud& cloud) {
  const ReflectionPlane a = cloud.toNormalized(better), b = cloud.toNormalized(plane);
  if (!MergeTolerance{kDetection.decide.slope_angle, kDetection.decide.slope_offset}.same(a, b)) return false;
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d normal = a.normal() + sign * b.normal();
  const ReflectionPlane between(normal, 0.5 * normal.norm() * (a.offset() + sign * b.offset()));
  return cloud.score(cloud.toInput(between)) > plane.score - kDetection.decide.slope_dip;
}

/// Whether a plane is of a polygon, between whose planes noise may leave no dip.
bool isOfPolygon(const std::optional<PlaneLattice>& polygon, const SymmetryPlane& plane, const NormalizedCloud& cloud) {
  return polygon && contains(cloud.toNormalized(plane), polygon->line);
}

/// Judges every point, where the plane was judged by some of them.
void completeSupport(SymmetryPlane& plane, const JudgedCloud& judged) {
  const NormalizedCloud& cloud = judged.cloud;
  if (static_cast<Eigen::Index>(plane.point_support.size()) == cloud.points.cols()) return;
  plane.point_support = judged.fit->shares(cloud.toNormalized(plane), allOf(cloud.points.cols())).points.seenSupport();
}

/// An approximate plane that is a symmetry of a part is reported as that.
std::vector<SymmetryPlane> withoutPlanesOfParts(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud) {
  const std::vector<ReflectionPlane> local = planesOf(planes, {PlaneKind::Local}, cloud);
  const auto is_of_part = [&](const SymmetryPlane& plane) {
    return plane.kind == PlaneKind::Approximate && kSamePlane.anySame(local, cloud.toNormalized(plane));
  };
  eraseIf(planes, is_of_part);
  return planes;
}

}  // namespace

std::vector<SymmetryPlane> rankedPlanes(const JudgedCloud& judged, std::vector<SymmetryPlane> planes,
                                        const std::optional<PlaneLattice>& polygon) {
  const NormalizedCloud& cloud = judged.cloud;
  const DetectionOptions& options = judged.options;
  planes = withoutPlanesOfParts(std::move(planes), cloud);
  // Equally confident planes, such as those of a polygon, are ordered by support.
  sortFalling(planes, &SymmetryPlane::support);
  std::vector<SymmetryPlane> ranked;
  for (SymmetryPlane& plane : reordered(std::move(planes), options)) {
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
  parallelBlocks(ranked.size(), options.num_threads, [&](std::size_t i) { completeSupport(ranked[i], judged); });
  return ranked;
}

std::optional<ReflectionPlane> flatPlane(const JudgedCloud& judged) {
  const PrincipalAxes& axes = judged.cloud.principal_axes;
  const ReflectionPlane plane(axes.axes.col(2), axes.axes.col(2).dot(axes.center));
  if (!judged.measure.limits().movesNothing(plane, judged.cloud.points)) return std::nullopt;
  return judged.cloud.toInput(plane);
}

std::optional<SymmetryPlane> bestApproximate(const JudgedCloud& judged, const std::vector<SymmetryPlane>& planes) {
  const SymmetryPlane* best = nullptr;
  for (const SymmetryPlane& plane : planes) {
    if (isDecided(plane)) return std::nullopt;
    if (plane.kind == PlaneKind::Approximate && (!best || plane.share * plane.seen > best->share * best->seen))
      best = &plane;
  }
  if (!best) return std::nullopt;
  SymmetryPlane answer = *best;
  completeSupport(answer, judged);
  return answer;
}

}  // namespace pcl_symmetry
