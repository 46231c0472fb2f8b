#include "pcl_symmetry/core/detect_planes.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/stopwatch.h"
#include "core/detection/cloud_subset.h"
#include "core/detection/part_search.h"
#include "core/detection/plane_decision.h"
#include "core/detection/plane_families.h"
#include "core/detection/plane_lattice.h"
#include "core/detection/staged_refinement.h"
#include "core/detection/standing_object.h"
#include "core/geometry/answerable_points.h"
#include "core/geometry/distinct_points.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/search_views.h"
#include "core/rotation/scan_axes.h"
#include "core/transform/free_space.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

void append(std::vector<SymmetryPlane>& planes, std::vector<SymmetryPlane> more) {
  std::move(more.begin(), more.end(), std::back_inserter(planes));
}

/// Refines candidates in full and decides them. In a whole cloud, once a plane explains everything, hopeless candidates
/// are skipped; planes climb only where that may decide.
class FinalRefinement {
public:
  /// \param refinement,decision must outlive this object.
  /// \param skips_hopeless the cloud is a whole surface, and other planes than symmetries are not wanted where there are any.
  FinalRefinement(const StagedRefinement& refinement, const PlaneDecision& decision, bool skips_hopeless)
      : refinement_(refinement), decision_(decision), skips_hopeless_(skips_hopeless) {}

  /// \param candidates after the second stage, best first.
  /// \return the planes that may be symmetries, and where there are none, the others too; input frame.
  std::vector<SymmetryPlane> decide(std::vector<Candidate> candidates) {
    std::vector<SymmetryPlane> found;
    if (skips_hopeless_ && !explained_ && candidates.size() > 1) {
      found = refineAndJudge({candidates.front()});
      candidates.erase(candidates.begin());
    }
    // Nothing is missing then that could excuse what others leave off.
    if (skips_hopeless_ && explained_)
      candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                      [&](const Candidate& other) { return decision_.isHopeless(other); }),
                       candidates.end());
    append(found, refineAndJudge(std::move(candidates)));
    return found;
  }

private:
  /// Refines candidates in full and judges them.
  std::vector<SymmetryPlane> refineAndJudge(std::vector<Candidate> candidates) {
    candidates = refinement_.full(std::move(candidates));
    std::vector<SymmetryPlane> planes;
    std::vector<Candidate> climbing;
    std::vector<std::size_t> index_of;
    for (MeasuredPlane& judged : decision_.judge(candidates)) {
      if (judged.plane.confidence >= kDetection.fit.climbing_confidence) {
        climbing.push_back(std::move(candidates[planes.size()]));
        index_of.push_back(planes.size());
      }
      planes.push_back(std::move(judged.plane));
    }
    const std::vector<bool> moved = refinement_.climb(climbing);
    std::vector<Candidate> again;
    std::vector<std::size_t> index_of_again;
    for (std::size_t k = 0; k < moved.size(); ++k) {
      if (!moved[k]) continue;
      again.push_back(std::move(climbing[k]));
      index_of_again.push_back(index_of[k]);
    }
    std::vector<MeasuredPlane> judged_again = decision_.judge(again);
    for (std::size_t k = 0; k < again.size(); ++k) planes[index_of_again[k]] = std::move(judged_again[k].plane);
    for (const SymmetryPlane& plane : planes) explained_ = explained_ || decision_.explainsAll(plane);
    return planes;
  }

  const StagedRefinement& refinement_;
  const PlaneDecision& decision_;
  bool skips_hopeless_;
  bool explained_ = false;  ///< a plane explains all of the cloud, so that nothing is missing
};

/// The evidence of all candidates, also of those that the detection leaves out early.
/// \param candidates after the second stage.
std::vector<MeasuredPlane> judgeAll(std::vector<Candidate> candidates, const StagedRefinement& refinement,
                                    const PlaneDecision& decision) {
  candidates = refinement.full(std::move(candidates));
  refinement.climb(candidates);
  return decision.judge(refinement.distinct(std::move(candidates)));
}

/// Finds the axes of rotations of a scan, and brings axes of revolution and planes in line with them.
std::vector<SymmetryPlane> withScanAxes(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud,
                                        double tolerance, const DetectionOptions& options, Detection& detection) {
  // A ball is symmetric about every line through its center.
  if (!options.rotations || !kKindRules.has_rotations[cloud.kind()] || !detection.centers.empty()) return planes;
  const ScanAxesOptions scan_axes{options.folds, options.min_confidence, options.min_possible, options.seed,
                                  options.num_threads};
  const RotationEvidence rotations(cloud, tolerance, options.seed);
  detection.rotations = scanAxes(rotations, planes, detection.axes, scan_axes,
                                 detection.evidence ? &detection.evidence->rotations : nullptr);
  detection.axes = withRoundAxes(rotations, std::move(detection.axes), detection.rotations, scan_axes);
  return withoutPlanesThrough(std::move(planes), detection.axes, cloud);
}

/// Section 4.4 and what follows: the planes of a cloud, from the maxima of its map to the list. publishedPlanes() is
/// the section alone.
/// \param all the points of the cloud and those that were left out to make it evenly dense, normalized frame.
Detection refineAndDecide(const NormalizedCloud& cloud, const Points& all, const SymmetryMap& map,
                          const DetectionOptions& options, Stopwatch& watch) {
  Detection detection;
  const auto timed = [&](const char* stage) { detection.timing_ms.emplace_back(stage, watch.lap()); };
  const std::unique_ptr<PlaneFit> fit = makePlaneFit(cloud, options);
  const StagedRefinement refinement(cloud, *fit, options);
  const PlaneMeasure measure(cloud, *fit, options);
  const PlaneDecision decision(cloud, measure, options);
  timed("surface");

  // Candidates: local maxima of the transform and the planes across the principal axes.
  std::vector<Candidate> candidates = gatherCandidates(cloud, map, options);
  timed("maxima");

  // Iterative Symmetric Points, with more samples and narrower weights in each stage; the last one with the decision.
  candidates = refinement.coarse(std::move(candidates), map.grid);
  timed("coarse_refinement");
  candidates = refinement.close(std::move(candidates));
  timed("close_refinement");
  if (options.evidence) {
    detection.evidence = std::make_shared<DetectionEvidence>();
    detection.evidence->planes = judgeAll(candidates, refinement, decision);
    timed("evidence");
  }
  FinalRefinement final_refinement(refinement, decision,
                                   !options.approximate && kKindRules.may_lack_piece[cloud.kind()]);
  std::vector<SymmetryPlane> planes = final_refinement.decide(std::move(candidates));
  timed("full_refinement");

  // Planes that follow from others: reflections of one symmetry in another, and those of a polygon.
  GroupClosure closure(cloud);
  while (!(candidates = refinement.closeSymmetries(closure.next(planes))).empty())
    append(planes, final_refinement.decide(std::move(candidates)));
  decision.doubtMissingPieces(planes);
  PlanesAndPolygon completed = withPolygon(std::move(planes), cloud, all, decision, options);
  planes = std::move(completed.planes);
  timed("closure");

  // Families: bodies of revolution, spheres, and what only rotations of a scan show.
  if (!decision.isCutAllAround()) {
    PlanesAndFamilies found = collectFamilies(std::move(planes), cloud, all, *fit, decision, options);
    planes = std::move(found.planes);
    detection.axes = std::move(found.axes);
    detection.centers = std::move(found.centers);
  }
  timed("families");
  if (!decision.isCutAllAround())
    planes = withScanAxes(std::move(planes), cloud, measure.tolerance(), options, detection);
  const bool has_family = !detection.axes.empty() || !detection.centers.empty();
  decision.doubtFurtherPlanes(planes, has_family);
  decision.doubtSlantedPlanes(planes);
  timed("rotations");

  if (options.approximate) append(planes, localPlanes(planes, cloud, *fit, decision, options));
  timed("parts");

  // The answer.
  if (!has_family) detection.best = bestApproximate(planes, cloud, *fit);
  if (detection.best) detection.best->deviation = measure.deviation(cloud.toNormalized(*detection.best)) * cloud.scale;
  detection.flat = flatPlane(cloud, measure.thinness());
  detection.tolerance = measure.tolerance() * cloud.scale;
  const bool is_raised = options.absolute_tolerance == 0.0 && measure.tolerance() > options.tolerance * cloud.extent;
  detection.resolution = std::max(measure.resolution(), is_raised ? measure.tolerance() : 0.0) * cloud.scale;
  detection.diameter = cloud.extent * cloud.scale;
  detection.planes = rankedPlanes(std::move(planes), completed.polygon, cloud, *fit, options);
  timed("report");
  return detection;
}

/// Detects planes on the evenly dense subset of a cloud whose density differs between its sides, then computes the
/// support of all its points.
/// \param input the points of the cloud in the input frame.
/// \param kept indices of the points to judge by.
Detection detectOnEvenSubset(const NormalizedCloud& cloud, const Points& input, const std::vector<int>& kept,
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
  for (std::size_t i = 0; i < distinct.index_of.size(); ++i)
    result.col(distinct.index_of[i]) = normals.col(static_cast<Eigen::Index>(i));
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
      kKindRules.evens_density[cloud.kind()] ? evenlyDense(cloud, options.seed) : allOf(cloud.points.cols());
  Detection detection = static_cast<Eigen::Index>(kept.size()) < cloud.points.cols()
                            ? detectOnEvenSubset(cloud, distinct.points, kept, map, options, watch)
                            : refineAndDecide(cloud, cloud.points, map, options, watch);
  if (distinct.points.cols() < input.points.cols()) spreadSupport(detection, distinct.index_of);
  return detection;
}

/// Sections 4.1 to 4.3, then the rest.
Detection detectFromPoints(const PlaneInput& input, const DetectionOptions& options) {
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

/// Detects planes on a subset of a large cloud, and turns them into the answer of the whole cloud.
Detection detectOnSubset(const PlaneInput& input, const CloudSubset& subset, const DetectionOptions& options) {
  const Points normals = input.normals ? pointsAt(*input.normals, subset.kept) : Points();
  PlaneInput kept(subset.points, input.visibility);
  kept.normals = input.normals ? &normals : nullptr;
  kept.make_search = input.make_search;
  Detection detection =
      input.map ? detectFromMap(kept, *input.edt, *input.map, options) : detectFromPoints(kept, options);
  if (!input.map) detection.map.center_of_mass = centerOfMass(input.points);
  Stopwatch watch;
  if (!detection.planes.empty() || detection.best)
    spreadSupport(detection, subset.nearestTo(input.points, options.num_threads));
  detection.timing_ms.emplace_back("support_of_all", watch.lap());
  return detection;
}

}  // namespace

GaussianEdtOptions DetectionOptions::edtOptions() const {
  GaussianEdtOptions edt;
  edt.num_cells = num_cells;
  edt.sigma = sigma;
  edt.num_threads = num_threads;
  return edt;
}

void DetectionOptions::validate() const {
  check(tolerance > 0.0 && tolerance <= 0.1, "tolerance", tolerance, "in (0, 0.1]");
  check(most_tolerance > 0.0 && most_tolerance <= 0.1, "most_tolerance", most_tolerance, "in (0, 0.1]");
  check(absolute_tolerance >= 0.0, "absolute_tolerance", absolute_tolerance, ">= 0");
  check(min_confidence >= 0.0 && min_confidence <= 1.0, "min_confidence", min_confidence, "in [0, 1]");
  check(min_possible >= 0.0 && min_possible <= 1.0, "min_possible", min_possible, "in [0, 1]");
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
  Detection detection;
  detection.reason = whyUnanswerable(input.points);
  if (!detection.reason.empty()) return detection;
  Stopwatch watch;
  if (const std::optional<CloudSubset> subset = subsetOf(input.points, options)) {
    const double subset_ms = watch.lap();
    detection = detectOnSubset(input, *subset, options);
    detection.timing_ms.insert(detection.timing_ms.begin(), {"subset", subset_ms});
  } else {
    detection = input.map ? detectFromMap(input, *input.edt, *input.map, options) : detectFromPoints(input, options);
  }
  if (input.may_be_rings && input.visibility && detection.reason.empty())
    decideByUprightBox(input.points, *input.visibility, options, detection);
  return detection;
}

}  // namespace pcl_symmetry
