#include "pcl_symmetry/core/plane_detection.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <mutex>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/detection/candidates.h"
#include "core/detection/cloud_subset.h"
#include "core/detection/even_density.h"
#include "core/detection/fold_spectrum.h"
#include "core/detection/plane_families.h"
#include "core/detection/plane_judge.h"
#include "core/detection/plane_ranking.h"
#include "core/detection/plane_settler.h"
#include "core/detection/scan_axes.h"
#include "core/detection/staged_refinement.h"
#include "core/detection/surface_fit.h"
#include "core/geometry/answerable_points.h"
#include "core/geometry/distinct_points.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/search_views.h"
#include "core/transform/free_space.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

Detection unanswered(std::string reason) {
  Detection detection;
  detection.reason = std::move(reason);
  return detection;
}

void append(std::vector<SymmetryPlane>& planes, std::vector<SymmetryPlane> more) {
  std::move(more.begin(), more.end(), std::back_inserter(planes));
}

/// The normals of the distinct points: where copies differ, that of the last copy.
Points normalsOf(const DistinctPoints& distinct, const Points& normals) {
  Points result(3, distinct.points.cols());
  for (std::size_t i = 0; i < distinct.index_of.size(); ++i)
    result.col(distinct.index_of[i]) = normals.col(static_cast<Eigen::Index>(i));
  return result;
}

/// What detect(points, normals) finds by the points that stand for a cloud, as the answer of the whole cloud.
template <typename Detect>
Detection bySubset(const CloudSubset& subset, const PointsRef& points, const Points* normals, int num_threads,
                   const Detect& detect) {
  const Points kept_normals = normals ? pointsAt(*normals, subset.kept) : Points();
  Detection detection = detect(subset.points, normals ? &kept_normals : nullptr);
  Stopwatch watch;
  if (!detection.planes.empty() || detection.best) spreadSupport(detection, subset.nearTo(points, num_threads));
  detection.timing_ms.emplace_back("support_of_all", watch.lap());
  return detection;
}

/// The evidence of all candidates, also of those that the detection leaves out early.
/// \param candidates after the second stage.
std::vector<JudgedPlane> evidenceOf(std::vector<Candidate> candidates, const StagedRefinement& refinement,
                                    const PlaneJudge& judge, const DetectionOptions& options) {
  candidates = refinement.full(std::move(candidates));
  refinement.climb(candidates);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.merit > b.merit; });
  const PlaneTolerance same{options.merge_angle, options.merge_offset};
  std::vector<Candidate> distinct;
  for (Candidate& candidate : candidates)
    if (!same.anySame(distinct, candidate.plane, [](const Candidate& other) { return other.plane; }))
      distinct.push_back(std::move(candidate));
  return judge.judgeWithEvidence(distinct);
}

/// Finds the axes of turns of a scan, and brings axes of revolution and planes in line with them.
std::vector<SymmetryPlane> withScanAxes(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud,
                                        double tolerance, const DetectionOptions& options, Detection& detection) {
  // A ball turns about every line through its center.
  if (!options.turns || !cloud.isScan() || !detection.centers.empty()) return planes;
  const TurnEvidence turns(cloud, tolerance, options.seed);
  detection.turns =
      scanAxes(turns, planes, detection.axes, options, detection.evidence ? &detection.evidence->turns : nullptr);
  detection.axes = withRoundTurns(turns, std::move(detection.axes), detection.turns, options);
  return withoutPlanesOf(std::move(planes), detection.axes, cloud);
}

/// Planes of a cloud, from the maxima of its map to the list.
/// \param all the points of the cloud and those that were left out to make it evenly dense, normalised frame.
Detection planesOf(const NormalizedCloud& cloud, const Points& all, const SymmetryMap& map,
                   const DetectionOptions& options, Stopwatch& watch) {
  Detection detection;
  const auto timed = [&](const char* stage) { detection.timing_ms.emplace_back(stage, watch.lap()); };
  const std::unique_ptr<PlaneFit> fit = makePlaneFit(
      cloud, {options.update, options.num_refine_samples, options.max_iterations, options.seed, options.num_threads});
  const StagedRefinement refinement(cloud, *fit, options);
  const PlaneJudge judge(cloud, *fit, options);
  PlaneSettler settler(refinement, judge, !options.approximate && !cloud.isScan() && !cloud.isVolume());
  timed("surface");

  std::vector<Candidate> candidates = gatherCandidates(cloud, map, options);
  timed("maxima");
  candidates = refinement.coarse(std::move(candidates), map.grid);
  timed("coarse_refinement");
  candidates = refinement.close(std::move(candidates));
  timed("close_refinement");
  if (options.evidence) {
    detection.evidence = std::make_shared<DetectionEvidence>();
    detection.evidence->planes = evidenceOf(candidates, refinement, judge, options);
    timed("evidence");
  }
  std::vector<SymmetryPlane> planes = settler.planes(std::move(candidates));
  timed("full_refinement");

  GroupClosure closure(cloud, {options.merge_angle, options.merge_offset});
  while (!(candidates = refinement.closeSymmetries(closure.next(planes))).empty())
    append(planes, settler.planes(std::move(candidates)));
  PlanesAndPolygon completed = withPolygon(judge.preferringWhole(std::move(planes)), cloud, all, judge, options);
  planes = std::move(completed.planes);
  timed("closure");
  if (options.families) {
    PlanesAndFamilies found = collectFamilies(std::move(planes), cloud, all, *fit, judge, options);
    planes = std::move(found.planes);
    detection.axes = std::move(found.axes);
    detection.centers = std::move(found.centers);
  }
  timed("families");
  planes = withScanAxes(std::move(planes), cloud, judge.tolerance(), options, detection);
  planes = judge.preferringBest(std::move(planes), !detection.axes.empty() || !detection.centers.empty());
  timed("turns");
  if (options.approximate) append(planes, judge.findParts(planes));
  timed("parts");
  const bool answered = !detection.axes.empty() || !detection.centers.empty();
  if (!answered) detection.best = bestApproximate(planes, cloud, *fit);
  if (detection.best) detection.best->deviation = judge.deviation(*detection.best);
  if (const std::optional<ReflectionPlane> flat = judge.flatPlane()) detection.flat = cloud.toInput(*flat);
  detection.tolerance = judge.tolerance() * cloud.scale;
  detection.resolution = judge.resolution() * cloud.scale;
  detection.diameter = cloud.extent * cloud.scale;
  detection.planes = rankedPlanes(std::move(planes), completed.polygon, cloud, *fit, options);
  timed("report");
  return detection;
}

/// The same where one side of the cloud is thinner than the other, by points as dense on both; the support of all
/// points.
/// \param input the points of the cloud in the input frame.
/// \param kept indices of the points to judge by.
Detection planesOfEven(const NormalizedCloud& cloud, const Points& input, const std::vector<int>& kept,
                       const SymmetryMap& map, const DetectionOptions& options, Stopwatch& watch) {
  GaussianEdtOptions edt_options;
  edt_options.num_cells = cloud.edt.numCells();
  edt_options.sigma = cloud.edt.sigma();
  edt_options.center = cloud.edt.center();
  edt_options.radius = cloud.edt.radius();
  edt_options.num_threads = options.num_threads;
  const Points even_points = pointsAt(input, kept);
  const GaussianEdt edt(even_points, edt_options);
  const ClosestPointSearch::Ptr search =
      cloud.flann ? nullptr : among(cloud.search, static_cast<std::size_t>(cloud.points.cols()), kept);
  const NormalizedCloud even(even_points, edt, search, nullptr, options.num_threads);
  Detection detection = planesOf(even, cloud.points, map, options, watch);
  const SurfaceFit all(
      cloud, {options.update, options.num_refine_samples, options.max_iterations, options.seed, options.num_threads});
  const auto complete = [&](SymmetryPlane& plane) {
    plane.point_support = all.PlaneFit::shares(cloud.toNormalized(plane), allOf(cloud.points.cols())).point_support;
  };
  for (SymmetryPlane& plane : detection.planes) complete(plane);
  if (detection.best) complete(*detection.best);
  return detection;
}

/// Planes of points that can have an answer and need no subset, from the maxima of their map.
Detection planesOfMap(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                      const DetectionOptions& options, const MakeSearch& make_search, const Visibility* visibility,
                      const Points* normals) {
  Stopwatch watch;
  const DistinctPoints distinct(points);
  const bool repeated = distinct.points.cols() < points.cols();
  ClosestPointSearch::Ptr search;
  if (make_search) search = inFrame(make_search(distinct.points), edt.center(), edt.radius());
  const Points distinct_normals = normals ? normalsOf(distinct, *normals) : Points();
  const NormalizedCloud cloud(distinct.points, edt, std::move(search), visibility, options.num_threads,
                              normals ? &distinct_normals : nullptr);
  const std::vector<int> kept = cloud.isVolume() ? evenlyDense(cloud, options.seed) : allOf(cloud.points.cols());
  Detection detection = static_cast<Eigen::Index>(kept.size()) < cloud.points.cols()
                            ? planesOfEven(cloud, distinct.points, kept, map, options, watch)
                            : planesOf(cloud, cloud.points, map, options, watch);
  if (!repeated) return detection;
  spreadSupport(detection, distinct.index_of);
  return detection;
}

}  // namespace

void DetectionOptions::validate() const {
  edt.validate();
  maxima.validate();
  check(num_theta >= 1, "num_theta", num_theta, ">= 1");
  check(num_phi >= 2 && num_phi % 2 == 0, "num_phi", num_phi, "even and >= 2");
  check(num_radius >= 1, "num_radius", num_radius, ">= 1");
  check(num_samples >= 1, "num_samples", num_samples, ">= 1");
  check(max_candidates >= 1, "max_candidates", max_candidates, ">= 1");
  check(max_drift >= 0.0, "max_drift", max_drift, ">= 0");
  check(num_coarse_samples >= 10, "num_coarse_samples", num_coarse_samples, ">= 10");
  check(num_refine_samples >= 10, "num_refine_samples", num_refine_samples, ">= 10");
  check(max_iterations >= 1, "max_iterations", max_iterations, ">= 1");
  check(merge_angle >= 0.0, "merge_angle", merge_angle, ">= 0");
  check(merge_offset >= 0.0, "merge_offset", merge_offset, ">= 0");
  check(min_confidence >= 0.0 && min_confidence <= 1.0, "min_confidence", min_confidence, "in [0, 1]");
  check(min_possible >= 0.0 && min_possible <= 1.0, "min_possible", min_possible, "in [0, 1]");
  check(tolerance > 0.0 && tolerance <= 0.1, "tolerance", tolerance, "in (0, 0.1]");
  check(most_tolerance > 0.0 && most_tolerance <= 0.1, "most_tolerance", most_tolerance, "in (0, 0.1]");
  check(absolute_tolerance >= 0.0, "absolute_tolerance", absolute_tolerance, ">= 0");
  check(max_possible >= 1, "max_possible", max_possible, ">= 1");
  check(max_planes >= 1, "max_planes", max_planes, ">= 1");
  checkNumThreads(num_threads);
}

Detection detectPlanes(const PointsRef& points, const DetectionOptions& options, const MakeSearch& make_search,
                       const Visibility* visibility, const Points* normals) {
  options.validate();
  if (normals) check(normals->cols() == points.cols(), "number of normals", normals->cols(), "the number of points");
  if (std::string reason = whyUnanswerable(points); !reason.empty()) return unanswered(std::move(reason));
  Stopwatch watch;
  if (const std::optional<CloudSubset> subset = subsetOf(points, options)) {
    const double subset_ms = watch.lap();
    Detection detection = bySubset(
        *subset, points, normals, options.num_threads,
        [&](const Points& p, const Points* n) { return detectPlanes(p, options, make_search, visibility, n); });
    detection.map.center_of_mass = centerOfMass(points);
    detection.timing_ms.insert(detection.timing_ms.begin(), {"subset", subset_ms});
    return detection;
  }
  const GaussianEdt edt(points, options.edt);
  const double edt_ms = watch.lap();
  std::vector<float> free_space;
  if (visibility) free_space = freeSpace(edt, *visibility, options.num_threads);
  const double visibility_ms = watch.lap();
  const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
  SampledTransformOptions sampling;
  sampling.num_samples = options.num_samples;
  sampling.seed = options.seed;
  sampling.num_threads = options.num_threads;
  SymmetryMap map = sampledTransform(edt, grid, sampling, free_space);
  map.center_of_mass = centerOfMass(points);
  const double transform_ms = watch.lap();
  Detection detection = planesOfMap(points, edt, map, options, make_search, visibility, normals);
  detection.map = std::move(map);
  detection.timing_ms.insert(
      detection.timing_ms.begin(),
      {{"distance_transform", edt_ms}, {"free_space", visibility_ms}, {"transform", transform_ms}});
  return detection;
}

void detectPlanesOfMany(std::size_t num_clouds, const std::function<Points(std::size_t)>& cloud,
                        const std::function<void(std::size_t, Detection)>& found, const DetectionOptions& options) {
  options.validate();
  DetectionOptions alone = options;
  alone.num_threads = alone.edt.num_threads = 1;
  std::mutex one_at_a_time;
  parallelBlocks(num_clouds, options.num_threads, [&](std::size_t i) {
    Detection detection = detectPlanes(cloud(i), alone);
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    found(i, std::move(detection));
  });
}

Detection refineMaxima(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                       const DetectionOptions& options, const MakeSearch& make_search, const Visibility* visibility,
                       const Points* normals) {
  options.validate();
  if (normals) check(normals->cols() == points.cols(), "number of normals", normals->cols(), "the number of points");
  if (std::string reason = whyUnanswerable(points); !reason.empty()) return unanswered(std::move(reason));
  if (const std::optional<CloudSubset> subset = subsetOf(points, options))
    return bySubset(*subset, points, normals, options.num_threads, [&](const Points& p, const Points* n) {
      return refineMaxima(p, edt, map, options, make_search, visibility, n);
    });
  return planesOfMap(points, edt, map, options, make_search, visibility, normals);
}

}  // namespace pcl_symmetry
