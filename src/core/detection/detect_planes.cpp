#include "pcl_symmetry/core/detect_planes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/stopwatch.h"
#include "core/detection/cloud_subset.h"
#include "core/detection/detection_evidence.h"
#include "core/detection/part_search.h"
#include "core/detection/plane_decision.h"
#include "core/detection/plane_families.h"
#include "core/detection/plane_report.h"
#include "core/detection/plane_search.h"
#include "core/detection/standing_object.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "core/rotation/scan_axes.h"
#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

/// Judges the likely symmetries first or, if none of them is a symmetry, all candidates. In a whole cloud, once a plane
/// explains everything, hopeless candidates are skipped: no missing piece could account for their unmatched points.
/// \param candidates after the second stage, best first.
void decide(const PlaneSearch& search, std::vector<Candidate> candidates, Found& found) {
  const CloudKind kind = search.cloud.kind();
  const bool skips_hopeless = !search.options.approximate && kKindRules.may_lack_piece[kind];
  const auto isExplained = [&] {
    return std::any_of(found.planes.begin(), found.planes.end(),
                       [&](const SymmetryPlane& plane) { return explainsAll(plane, kind); });
  };
  if (skips_hopeless && !isExplained() && candidates.size() > 1) {
    append(found.planes, search.refinedAndJudged({candidates.front()}));
    candidates.erase(candidates.begin());
  }
  if (skips_hopeless && isExplained())
    eraseIf(candidates, [&](const Candidate& other) { return search.isHopeless(other); });
  append(found.planes, search.refinedAndJudged(std::move(candidates)));
}

/// The evidence of all candidates, including those that the detection rejects early.
/// \param candidates after the second stage.
std::vector<MeasuredPlane> judgeAll(const PlaneSearch& search, std::vector<Candidate> candidates) {
  candidates = search.refinement.refineFully(std::move(candidates));
  search.refinement.climb(candidates, std::vector<char>(candidates.size(), true));
  return search.judge(search.refinement.distinct(std::move(candidates)));
}

/// The reflection of one symmetry in another is a symmetry, and so are the missing planes of a regular polygon.
void completeGroups(const PlaneSearch& search, Found& found) {
  if (!kKindRules.shows_all[search.cloud.kind()]) return;
  std::vector<ReflectionPlane> tried;
  for (std::vector<Candidate> candidates;
       !(candidates = search.refinement.refineSymmetries(impliedBy(found.planes, search.cloud, tried))).empty();)
    decide(search, std::move(candidates), found);
}

/// Tries the planes of a scan that the map does not show because half of the surface that they map is hidden.
void tryRightAngles(const PlaneSearch& search, Found& found) {
  const NormalizedCloud& cloud = search.cloud;
  if (kKindRules.shows_all[cloud.kind()] || !cloud.seen()) return;
  std::vector<Candidate> candidates = atRightAngles(found.planes, carryingNormals(cloud.points, *cloud.seen()), cloud);
  if (!candidates.empty()) decide(search, search.refinement.refineSymmetries(std::move(candidates)), found);
}

/// Every plane through the axis of a mug maps its body onto itself. One that does not map its handle onto itself is
/// possible at most.
void limitByHandle(const PlaneSearch& search, const RotationEvidence& rotations, const ScanAxesOptions& options,
                   Found& found) {
  if (std::none_of(found.planes.begin(), found.planes.end(),
                   [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; }))
    return;
  const std::optional<NearlyRound> body = nearlyRound(rotations, options);
  if (!body) return;
  for (SymmetryPlane& plane : found.planes) {
    const ReflectionPlane normalized = search.cloud.toNormalized(plane);
    if (contains(normalized, body->axis) &&
        rotations.shareOn(normalized.reflection(), body->not_round) < kScanAxes.min_mapped)
      limitToPossible(plane, "contains the axis of a round body, and does not map what is not round of it onto itself");
  }
}

/// Finds axes of rotations of a scan and makes axes of revolution and planes consistent with them.
void findAxesOfScan(const PlaneSearch& search, Found& found) {
  const DetectionOptions& options = search.options;
  if (search.measure.limits().isCutAllAround() || !options.rotations) return;
  // A ball is symmetric about every line through its center.
  if (kKindRules.shows_all[search.cloud.kind()] || !found.centers.empty()) return;
  const ScanAxesOptions scan_axes{options.folds, options.min_confidence, options.min_possible, options.seed,
                                  options.num_threads};
  const RotationEvidence rotations(search.cloud, search.measure.tolerance(), options.seed);
  if (std::optional<SymmetryCenter> center = centerOfScan(rotations, scan_axes)) {
    found.axes.clear();
    found.planes = withoutPlanesThrough(std::move(found.planes), *center, search.cloud);
    found.centers.push_back(*std::move(center));
    return;
  }
  found.rotations =
      scanAxes(rotations, found.planes, found.axes, scan_axes, found.evidence ? &found.evidence->rotations : nullptr);
  found.axes = withRoundAxes(rotations, std::move(found.axes), found.rotations, scan_axes);
  found.planes = withoutPlanesThrough(std::move(found.planes), found.axes, search.cloud);
  // A body other than a ball has one axis: further axes, as of a dome, are round only within the tolerance.
  sortFalling(found.axes, &SymmetryAxis::confidence);
  if (found.axes.size() > 1) found.axes.resize(1);
  if (found.axes.empty()) limitByHandle(search, rotations, scan_axes, found);
}

/// Rules by which results correct each other, applied in this order. Not in the paper.
constexpr struct {
  const char* name;  ///< stage in Detection::timing_ms
  void (*apply)(const PlaneSearch& search, Found& found);
} kRules[] = {
    {"groups", completeGroups},
    {"right_angles", tryRightAngles},
    {"missing_pieces", [](const PlaneSearch& search,
                          Found& found) { doubtMissingPieces(found.planes, search.cloud.kind(), search.options); }},
    {"polygon", completePolygon},
    {"families", findFamilies},
    {"rotations", findAxesOfScan},
    {"beside_best",
     [](const PlaneSearch& search, Found& found) {
       doubtFurtherPlanes(found.planes, found.hasFamily(), search.cloud.kind(), search.options);
     }},
    {"slanted",
     [](const PlaneSearch& search, Found& found) {
       if (const Visibility* seen = search.cloud.seen())
         doubtSlantedPlanes(found.planes, carryingNormals(search.cloud.points, *seen), search.options);
     }},
    {"parts", findPlanesOfParts},
};

/// Section 4.4 and what follows: from the maxima of the map of a cloud to the list of planes. publishedPlanes() is the
/// section alone.
/// \param[in,out] found receives the results.
void refineAndDecide(const PlaneSearch& search, const SymmetryMap& map, Found& found, StageTimes& timed) {
  // Candidates: local maxima of the transform, and the planes perpendicular to the principal axes.
  std::vector<Candidate> candidates = gatherCandidates(search.cloud, map, search.options);
  timed("maxima");

  // Iterative Symmetric Points, with more samples and narrower weights in each stage; the last one with the decision.
  candidates = search.refinement.refineCoarsely(std::move(candidates), map.grid);
  timed("coarse_refinement");
  candidates = search.refinement.refineClosely(std::move(candidates));
  timed("close_refinement");
  if (found.evidence) {
    found.evidence->planes = judgeAll(search, candidates);
    timed("evidence");
  }
  decide(search, std::move(candidates), found);
  timed("full_refinement");

  for (const auto& rule : kRules) {
    rule.apply(search, found);
    timed(rule.name);
  }

  report(search, found);
  timed("report");
}

/// The normals of the distinct points; if copies differ, that of the last copy.
/// \param used indices of the input points that became distinct ones, in the order of DistinctPoints::index_of.
Points normalsOf(const DistinctPoints& distinct, const Points& normals, const std::vector<int>& used) {
  Points result(3, distinct.points.cols());
  for (std::size_t i = 0; i < used.size(); ++i) result.col(distinct.index_of[i]) = normals.col(used[i]);
  return result;
}

/// The evenly dense part of a cloud whose density differs between its sides.
struct EvenCloud {
  const Points points;  ///< input frame
  const GaussianEdt edt;
  const NormalizedCloud cloud;

  /// \param whole cloud of the points \p distinct.
  /// \param kept indices of the points of \p distinct that are kept.
  EvenCloud(const NormalizedCloud& whole, const Points& distinct, const std::vector<int>& kept, int num_threads)
      : points(pointsAt(distinct, kept)),
        edt(points, {whole.edt.numCells(), whole.edt.sigma(), num_threads, whole.edt.radius(), whole.edt.center()}),
        cloud(points, edt, nullptr, nullptr, num_threads) {}
};

}  // namespace

void DetectionOptions::validate() const {
  check(tolerance > 0.0 && tolerance <= 0.1, "tolerance", tolerance, "in (0, 0.1]");
  check(max_tolerance > 0.0 && max_tolerance <= 0.1, "max_tolerance", max_tolerance, "in (0, 0.1]");
  check(absolute_tolerance >= 0.0, "absolute_tolerance", absolute_tolerance, ">= 0");
  check(min_confidence >= 0.0 && min_confidence <= 1.0, "min_confidence", min_confidence, "in [0, 1]");
  std::ostringstream rule;
  rule << "in [0, min_confidence = " << min_confidence << "]";
  check(min_possible >= 0.0 && min_possible <= min_confidence, "min_possible", min_possible, rule.str().c_str());
  check(max_planes >= 1, "max_planes", max_planes, ">= 1");
  edtOptions().validate();
  checkNumThreads(num_threads);
  expert.maxima.validate();
  expert.MapSize::validate();
  check(expert.num_samples >= 1, "num_samples", expert.num_samples, ">= 1");
  check(expert.max_candidates >= 1, "max_candidates", expert.max_candidates, ">= 1");
  check(expert.num_refine_samples >= 10, "num_refine_samples", expert.num_refine_samples, ">= 10");
}

Detection detectPlanes(const PlaneInput& input, const DetectionOptions& options) {
  return detectWithEvidence(input, options, nullptr);
}

Detection detectWithEvidence(const PlaneInput& input, const DetectionOptions& options, DetectionEvidence* evidence) {
  options.validate();
  if (input.normals)
    check(input.normals->cols() == input.points.cols(), "number of normals", input.normals->cols(),
          "the number of points");
  check(!input.map == !input.edt, "map", input.map ? "given" : "missing", "given together with edt");
  Found found;
  StageTimes timed(found.timing_ms);
  found.evidence = evidence;

  // The bulk: all points that are not stray, of a large cloud a subset.
  const std::vector<int> stray = strayPoints(input.points), in_bulk = allBut(stray, input.points.cols());
  const Points bulk = pointsAt(input.points, in_bulk);
  found.num_stray_points = static_cast<int>(stray.size());
  found.reason = whyUnanswerable(bulk);
  if (!found.reason.empty()) return std::move(found);
  const std::optional<std::vector<int>> subset = subsetOf(bulk, options);
  std::vector<int> used = subset ? *subset : allOf(bulk.cols());
  for (int& i : used) i = in_bulk[i];
  const Points points = pointsAt(input.points, used);
  if (subset) timed("subset");

  // Sections 4.1 to 4.3: the distance transform and the map, unless the input has them.
  std::optional<GaussianEdt> own_edt;
  if (!input.map) {
    own_edt.emplace(points, options.edtOptions());
    timed("distance_transform");
    const std::vector<float> free_space = freeSpace(*own_edt, input.visibility, options.num_threads);
    timed("free_space");
    const PlaneGrid grid(options.expert, own_edt->center(), own_edt->radius());
    found.map =
        sampledTransform(*own_edt, grid, {options.expert.num_samples, options.seed, options.num_threads}, free_space);
    found.map.center_of_mass = centerOfMass(bulk);
    timed("transform");
  }
  const GaussianEdt& edt = input.edt ? *input.edt : *own_edt;

  // The cloud: each position once and, where noise leaves no surface, evenly dense.
  const DistinctPoints distinct(points);
  const Points normals = input.normals ? normalsOf(distinct, *input.normals, used) : Points();
  ClosestPointSearch::Ptr search;
  if (input.make_search) search = inFrame(input.make_search(distinct.points), edt.center(), edt.radius());
  const NormalizedCloud cloud(distinct.points, edt, std::move(search), input.visibility, options.num_threads,
                              input.normals ? &normals : nullptr);
  std::optional<EvenCloud> even;
  if (!kKindRules.resolves_surface[cloud.kind()])
    if (const std::vector<int> kept = evenlyDense(cloud, options.seed); kept.size() < distinct.first_of.size())
      even.emplace(cloud, distinct.points, kept, options.num_threads);

  // Section 4.4: planes.
  const PlaneSearch plane_search(even ? even->cloud : cloud, cloud.points, options);
  timed("surface");
  refineAndDecide(plane_search, input.map ? *input.map : found.map, found, timed);

  // The support of all points: of the whole cloud, then of the bulk, then of the input. Stray points support no plane.
  const auto complete = [&](SymmetryPlane& plane) {
    plane.point_support = surfaceSupport(cloud, cloud.toNormalized(plane), options);
  };
  if (even) {
    for (SymmetryPlane& plane : found.planes) complete(plane);
    if (found.best) complete(*found.best);
  }
  if (!found.planes.empty() || found.best)
    spreadSupport(
        found, subset ? closestPoints(*makeFlannSearch(points), bulk, options.num_threads).index : distinct.index_of);
  if (subset) timed("support_of_all");
  if (input.may_be_rings && input.visibility) decideByUprightBox(bulk, *input.visibility, options, found);
  if (stray.empty()) return std::move(found);
  std::vector<int> index_in_bulk(input.points.cols(), -1);
  for (std::size_t i = 0; i < in_bulk.size(); ++i) index_in_bulk[in_bulk[i]] = static_cast<int>(i);
  spreadSupport(found, index_in_bulk);
  return std::move(found);
}

}  // namespace pcl_symmetry
