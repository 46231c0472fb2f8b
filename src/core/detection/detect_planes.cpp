#include "pcl_symmetry/core/detect_planes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/statistics.h"
#include "core/base/stopwatch.h"
#include "core/detection/cloud_subset.h"
#include "core/detection/part_search.h"
#include "core/detection/plane_decision.h"
#include "core/detection/plane_families.h"
#include "core/detection/plane_fit.h"
#include "core/detection/standing_object.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "core/rotation/rotation_evidence.h"
#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

/// Decides the planes that may be symmetries, and where there are none, the others too. In a whole cloud, once a plane
/// explains everything, hopeless candidates are skipped: no missing piece could account for what they fail to match.
/// \param candidates after the second stage, best first.
void decide(const JudgedCloud& judged, std::vector<Candidate> candidates, Found& found) {
  const CloudKind kind = judged.cloud.kind();
  const bool skips_hopeless = !judged.options.approximate && kKindRules.may_lack_piece[kind];
  const auto isExplained = [&] {
    return std::any_of(found.planes.begin(), found.planes.end(),
                       [&](const SymmetryPlane& plane) { return explainsAll(plane, kind); });
  };
  if (skips_hopeless && !isExplained() && candidates.size() > 1) {
    append(found.planes, judged.refinedAndJudged({candidates.front()}));
    candidates.erase(candidates.begin());
  }
  if (skips_hopeless && isExplained())
    eraseIf(candidates, [&](const Candidate& other) { return judged.decision.isHopeless(other); });
  append(found.planes, judged.refinedAndJudged(std::move(candidates)));
}

/// The evidence of all candidates, also of those that the detection leaves out early.
/// \param candidates after the second stage.
std::vector<MeasuredPlane> judgeAll(const JudgedCloud& judged, std::vector<Candidate> candidates) {
  candidates = judged.refinement.full(std::move(candidates));
  judged.refinement.climb(candidates, std::vector<char>(candidates.size(), true));
  return judged.decision.judge(judged.refinement.distinct(std::move(candidates)));
}

/// The reflection of one symmetry in another is a symmetry, and so are the missing planes of a regular polygon.
void completeGroups(const JudgedCloud& judged, Found& found) {
  if (!kKindRules.shows_all[judged.cloud.kind()]) return;
  std::vector<ReflectionPlane> tried;
  for (std::vector<Candidate> candidates;
       !(candidates = judged.refinement.closeSymmetries(impliedBy(found.planes, judged.cloud, tried))).empty();)
    decide(judged, std::move(candidates), found);
}

/// Finds axes of rotations of a scan and makes axes of revolution and planes consistent with them.
void findAxesOfScan(const JudgedCloud& judged, Found& found) {
  const DetectionOptions& options = judged.options;
  if (judged.measure.limits().isCutAllAround() || !options.rotations) return;
  // A ball is symmetric about every line through its center.
  if (kKindRules.shows_all[judged.cloud.kind()] || !found.centers.empty()) return;
  const ScanAxesOptions scan_axes{options.folds, options.min_confidence, options.min_possible, options.seed,
                                  options.num_threads};
  const RotationEvidence rotations(judged.cloud, judged.measure.tolerance(), options.seed);
  if (std::optional<SymmetryCenter> center = centerOfScan(rotations, scan_axes)) {
    found.axes.clear();
    found.planes = withoutPlanesThrough(std::move(found.planes), *center, judged.cloud);
    found.centers.push_back(*std::move(center));
    return;
  }
  found.rotations =
      scanAxes(rotations, found.planes, found.axes, scan_axes, found.evidence ? &found.evidence->rotations : nullptr);
  found.axes = withRoundAxes(rotations, std::move(found.axes), found.rotations, scan_axes);
  found.planes = withoutPlanesThrough(std::move(found.planes), found.axes, judged.cloud);
  // A body that is no ball has one axis: the others of a dome are as round within the tolerance.
  sortFalling(found.axes, &SymmetryAxis::confidence);
  if (found.axes.size() > 1) found.axes.resize(1);
}

/// Rules by which findings correct each other, applied in this order. Not in the paper.
constexpr struct {
  const char* name;  ///< in Detection::timing_ms
  void (*apply)(const JudgedCloud& judged, Found& found);
} kRules[] = {
    {"groups", completeGroups},
    {"missing_pieces", [](const JudgedCloud& judged,
                          Found& found) { doubtMissingPieces(found.planes, judged.cloud.kind(), judged.options); }},
    {"polygon", completePolygon},
    {"families", findFamilies},
    {"rotations", findAxesOfScan},
    {"beside_best",
     [](const JudgedCloud& judged, Found& found) {
       doubtFurtherPlanes(found.planes, found.hasFamily(), judged.cloud.kind(), judged.options);
     }},
    {"slanted",
     [](const JudgedCloud& judged, Found& found) {
       if (const Visibility* seen = judged.cloud.seen())
         doubtSlantedPlanes(found.planes, carryingNormals(judged.cloud.points, *seen), judged.options);
     }},
    {"parts", findPlanesOfParts},
};

/// Section 4.4 and what follows: the planes of a cloud, from the maxima of its map to the list. publishedPlanes() is
/// the section alone.
/// \param all the points of the cloud and those that were left out to make it evenly dense, normalized frame.
Detection refineAndDecide(const NormalizedCloud& cloud, const Points& all, const SymmetryMap& map,
                          const DetectionOptions& options, Stopwatch& watch) {
  Found found;
  const auto timed = [&](const char* stage) { found.timing_ms.emplace_back(stage, watch.lap()); };
  const JudgedCloud judged(cloud, all, options);
  const PlaneMeasure& measure = judged.measure;
  timed("surface");

  // Candidates: local maxima of the transform and the planes across the principal axes.
  std::vector<Candidate> candidates = gatherCandidates(cloud, map, options);
  timed("maxima");

  // Iterative Symmetric Points, with more samples and narrower weights in each stage; the last one with the decision.
  candidates = judged.refinement.coarse(std::move(candidates), map.grid);
  timed("coarse_refinement");
  candidates = judged.refinement.close(std::move(candidates));
  timed("close_refinement");
  if (options.evidence) {
    found.evidence = std::make_shared<DetectionEvidence>();
    found.evidence->planes = judgeAll(judged, candidates);
    timed("evidence");
  }
  decide(judged, std::move(candidates), found);
  timed("full_refinement");

  for (const auto& rule : kRules) {
    rule.apply(judged, found);
    timed(rule.name);
  }

  // The answer.
  if (!found.hasFamily()) found.best = bestApproximate(judged, found.planes);
  if (found.best) found.best->deviation = measure.deviation(cloud.toNormalized(*found.best)) * cloud.scale;
  found.flat = flatPlane(judged);
  found.tolerance = measure.tolerance() * cloud.scale;
  const bool is_raised = options.absolute_tolerance == 0.0 && measure.tolerance() > options.tolerance * cloud.extent;
  found.resolution = std::max(measure.resolution(), is_raised ? measure.tolerance() : 0.0) * cloud.scale;
  found.diameter = cloud.extent * cloud.scale;
  found.planes = rankedPlanes(judged, std::move(found.planes), found.polygon);
  timed("report");
  return std::move(found);
}

/// Detects planes on the evenly dense subset of a cloud whose density differs between its sides, then computes the
/// support of all its points.
/// \param input the points of the cloud in the input frame.
/// \param kept indices of the points to judge by.
Detection detectOnEvenSubset(const NormalizedCloud& cloud, const Points& input, const std::vector<int>& kept,
                             const SymmetryMap& map, const DetectionOptions& options, Stopwatch& watch) {
  const GaussianEdt& whole = cloud.edt;
  const Points even_points = pointsAt(input, kept);
  const GaussianEdt edt(even_points,
                        {whole.numCells(), whole.sigma(), options.num_threads, whole.radius(), whole.center()});
  const ClosestPointSearch::Ptr search =
      cloud.flann ? nullptr : among(cloud.search, static_cast<std::size_t>(cloud.points.cols()), kept);
  const NormalizedCloud even(even_points, edt, search, nullptr, options.num_threads);
  Detection detection = refineAndDecide(even, cloud.points, map, options, watch);
  const auto complete = [&](SymmetryPlane& plane) {
    plane.point_support = surfaceSupport(cloud, cloud.toNormalized(plane), options);
  };
  for (SymmetryPlane& plane : detection.planes) complete(plane);
  if (detection.best) complete(*detection.best);
  return detection;
}

/// The normals of the distinct points: where copies differ, that of the last copy.
Points normalsOf(const DistinctPoints& distinct, const Points& normals) {
  Points result(3, distinct.points.cols());
  for (std::size_t i = 0; i < distinct.index_of.size(); ++i) result.col(distinct.index_of[i]) = normals.col(i);
  return result;
}

/// Each position counts once, and volumes of points are made evenly dense.
Detection detectFromMap(const PlaneInput& input, const GaussianEdt& edt, const SymmetryMap& map,
                        const DetectionOptions& options) {
  Stopwatch watch;
  const DistinctPoints distinct(input.points);
  const Points normals = input.normals ? normalsOf(distinct, *input.normals) : Points();
  ClosestPointSearch::Ptr search;
  if (input.make_search) search = inFrame(input.make_search(distinct.points), edt.center(), edt.radius());
  const NormalizedCloud cloud(distinct.points, edt, std::move(search), input.visibility, options.num_threads,
                              input.normals ? &normals : nullptr);
  const std::vector<int> kept =
      kKindRules.resolves_surface[cloud.kind()] ? allOf(cloud.points.cols()) : evenlyDense(cloud, options.seed);
  Detection detection = static_cast<Eigen::Index>(kept.size()) < cloud.points.cols()
                            ? detectOnEvenSubset(cloud, distinct.points, kept, map, options, watch)
                            : refineAndDecide(cloud, cloud.points, map, options, watch);
  if (distinct.points.cols() < input.points.cols()) spreadSupport(detection, distinct.index_of);
  return detection;
}

/// Sections 4.1 to 4.3, unless the input has a map; then the rest.
Detection detectAmong(const PlaneInput& input, const DetectionOptions& options) {
  if (input.map) return detectFromMap(input, *input.edt, *input.map, options);
  Stopwatch watch;
  std::vector<std::pair<std::string, double>> timing;
  const GaussianEdt edt(input.points, options.edtOptions());
  timing.emplace_back("distance_transform", watch.lap());
  const std::vector<float> free_space = freeSpace(edt, input.visibility, options.num_threads);
  timing.emplace_back("free_space", watch.lap());
  const DetectionOptions::Expert& expert = options.expert;
  const PlaneGrid grid(expert, edt.center(), edt.radius());
  SymmetryMap map = sampledTransform(edt, grid, {expert.num_samples, options.seed, options.num_threads}, free_space);
  map.center_of_mass = centerOfMass(input.points);
  timing.emplace_back("transform", watch.lap());
  Detection detection = detectFromMap(input, edt, map, options);
  detection.map = std::move(map);
  detection.timing_ms.insert(detection.timing_ms.begin(), timing.begin(), timing.end());
  return detection;
}

/// Some of the points of an input, as an input.
struct PartOfInput {
  Points points, normals;
  PlaneInput input;

  PartOfInput(const PlaneInput& all, const std::vector<int>& kept)
      : points(pointsAt(all.points, kept)),
        normals(all.normals ? pointsAt(*all.normals, kept) : Points()),
        input(points, all.visibility) {
    input.normals = all.normals ? &normals : nullptr;
    input.edt = all.edt;
    input.map = all.map;
    input.make_search = all.make_search;
    input.may_be_rings = all.may_be_rings;
  }
};

/// Detects planes on the points that represent the cloud; all others take their support.
/// \param input without stray points.
Detection detectInBulk(const PlaneInput& input, const DetectionOptions& options) {
  Detection detection;
  detection.reason = whyUnanswerable(input.points);
  if (!detection.reason.empty()) return detection;
  Stopwatch watch;
  if (const std::optional<std::vector<int>> subset = subsetOf(input.points, options)) {
    const double subset_ms = watch.lap();
    const PartOfInput part(input, *subset);
    detection = detectAmong(part.input, options);
    if (!input.map) detection.map.center_of_mass = centerOfMass(input.points);
    watch.lap();
    if (!detection.planes.empty() || detection.best)
      spreadSupport(detection, closestPoints(*makeFlannSearch(part.points), input.points, options.num_threads).index);
    detection.timing_ms.insert(detection.timing_ms.begin(), {"subset", subset_ms});
    detection.timing_ms.emplace_back("support_of_all", watch.lap());
  } else {
    detection = detectAmong(input, options);
  }
  if (input.may_be_rings && input.visibility) decideByUprightBox(input, options, detection);
  return detection;
}

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
  options.validate();
  if (input.normals)
    check(input.normals->cols() == input.points.cols(), "number of normals", input.normals->cols(),
          "the number of points");
  check(!input.map == !input.edt, "map", input.map ? "given" : "missing", "given together with edt");
  const std::vector<int> stray = strayPoints(input.points);
  if (stray.empty()) return detectInBulk(input, options);
  // Stray points support no plane.
  const std::vector<int> others = allBut(stray, input.points.cols());
  Detection detection = detectInBulk(PartOfInput(input, others).input, options);
  std::vector<int> index_of(input.points.cols(), -1);
  for (std::size_t i = 0; i < others.size(); ++i) index_of[others[i]] = static_cast<int>(i);
  spreadSupport(detection, index_of);
  detection.num_stray_points = static_cast<int>(stray.size());
  return detection;
}

}  // namespace pcl_symmetry
