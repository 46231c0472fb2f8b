#include "pcl_symmetry/core/detect_planes.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/stopwatch.h"
#include "core/detection/plane_decision.h"
#include "core/detection/plane_families.h"
#include "core/detection/plane_search.h"
#include "core/detection/standing_object.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/directions.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "core/rotation/scan_axes.h"
#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

/// Judges the candidates. In a whole cloud, the best one is judged first: if it, or an earlier plane, explains
/// everything, hopeless candidates are skipped, because no missing piece could account for their unmatched points.
/// \param candidates after the second stage, best first.
void refineAndJudgeBestFirst(const PlaneSearch& search, std::vector<Candidate> candidates,
                             std::vector<SymmetryPlane>& planes) {
  const CloudKind kind = search.cloud.kind();
  const bool skips_hopeless = !search.options.approximate && kind == CloudKind::Surface;
  const auto isExplained = [&] {
    return std::any_of(planes.begin(), planes.end(),
                       [&](const SymmetryPlane& plane) { return explainsAll(plane, kind); });
  };
  if (skips_hopeless && !isExplained() && candidates.size() > 1) {
    append(planes, search.refineAndJudge({candidates.front()}));
    candidates.erase(candidates.begin());
  }
  if (skips_hopeless && isExplained())
    eraseIf(candidates, [&](const Candidate& other) { return search.isHopeless(other); });
  append(planes, search.refineAndJudge(std::move(candidates)));
}

/// The evidence of all candidates, including those that the detection rejects early.
/// \param candidates after the second stage.
std::vector<MeasuredPlane> measureAllCandidates(const PlaneSearch& search, std::vector<Candidate> candidates) {
  candidates = search.fit.refineFully(std::move(candidates));
  search.fit.climb(candidates, std::vector<char>(candidates.size(), true));
  return search.judge(search.fit.distinct(std::move(candidates)));
}

/// The reflection of one symmetry in another is a symmetry, and so are the missing planes of a regular polygon.
void completeGroups(const PlaneSearch& search, DetectionState& state) {
  if (search.cloud.isScan()) return;
  std::vector<ReflectionPlane> tried;
  for (std::vector<Candidate> candidates;
       !(candidates = search.fit.refineImplied(reflectSymmetries(state.answer.planes, search.cloud, tried))).empty();)
    refineAndJudgeBestFirst(search, std::move(candidates), state.answer.planes);
}

/// Tries the planes of a scan that the map does not show because half of the surface that they map is hidden.
void tryRightAngles(const PlaneSearch& search, DetectionState& state) {
  if (!search.cloud.isScan()) return;
  std::vector<Candidate> candidates = proposeAtRightAngles(state.answer.planes, search.support_normals, search.cloud);
  if (!candidates.empty())
    refineAndJudgeBestFirst(search, search.fit.refineImplied(std::move(candidates)), state.answer.planes);
}

/// Whether the reflection in a plane exchanges the ends of a line.
bool isAcross(const ReflectionPlane& plane, const Line3d& line) {
  return angleBetweenLines(plane.normal(), line.direction()) < kDetection.decide.upright;
}

/// The body of a mug, if a symmetry contains its axis or lies across it.
std::optional<NearlyRound> bodyOfMug(const PlaneSearch& search, const RotationEvidence& rotations,
                                     const std::vector<Line3d>& lines, const std::vector<SymmetryPlane>& planes) {
  const auto concerns = [&](const ReflectionPlane& plane) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const Line3d& line) { return contains(plane, line) || isAcross(plane, line); });
  };
  const std::vector<ReflectionPlane> symmetries = planesOf(planes, {PlaneKind::Symmetry}, search.cloud);
  return std::any_of(symmetries.begin(), symmetries.end(), concerns) ? nearlyRound(rotations, lines) : std::nullopt;
}

/// Every plane through the axis of a mug maps its body onto itself. One that does not map its handle onto itself is
/// possible at most.
void limitByHandle(const PlaneSearch& search, const RotationEvidence& rotations, const NearlyRound& body,
                   std::vector<SymmetryPlane>& planes) {
  for (SymmetryPlane& plane : planes) {
    const ReflectionPlane normalized = search.cloud.toNormalized(plane);
    if (contains(normalized, body.axis) &&
        rotations.shareOn(normalized.reflection(), body.off_body) < kScanAxes.min_mapped)
      limitToPossible(plane, kPartOffRoundBody);
  }
}

/// Share of the points whose reflection would face the scanner but lies behind the surface that it measured, as the
/// inside of a mug does in the plane that exchanges its opening and its bottom.
double hiddenInside(const PlaneSearch& search, const ReflectionPlane& plane) {
  const NormalizedCloud& cloud = search.cloud;
  const Eigen::Vector3d viewpoint = cloud.seen()->viewpoint();
  const std::vector<int> samples = drawSamples(cloud.points.cols(), kScanAxes.num_samples, search.options.seed);
  const auto isInside = [&](int i) {
    const Eigen::Vector3d x = cloud.points.col(i).cast<double>(), image = plane.reflect(x);
    Eigen::Vector3d normal = cloud.geometry.normals.col(i).cast<double>();
    if (normal.dot(viewpoint - x) < 0.0) normal = -normal;
    const double behind = cloud.seen()->depthBehind(image);
    return std::isfinite(behind) && behind > search.measure.tolerance() &&
           (plane.reflection().linear() * normal).dot(viewpoint - image) > 0.0;
  };
  return static_cast<double>(std::count_if(samples.begin(), samples.end(), isInside)) /
         static_cast<double>(samples.size());
}

/// A mug, a bowl or a tube whose inside was seen through one end: whether the other end is open is unknown. A plane
/// that exchanges its ends is possible at most.
void limitByOpening(const PlaneSearch& search, const Line3d& axis, std::vector<SymmetryPlane>& planes) {
  for (SymmetryPlane& plane : planes) {
    const ReflectionPlane normalized = search.cloud.toNormalized(plane);
    if (plane.kind == PlaneKind::Symmetry && isAcross(normalized, axis) &&
        hiddenInside(search, normalized) > kDetection.decide.max_inside)
      limitToPossible(plane, "the inside of a hollow body was seen through one end alone");
  }
}

/// Finds axes of rotations of a scan and makes axes of revolution and planes consistent with them.
void findAxesOfScan(const PlaneSearch& search, DetectionState& state) {
  Detection& answer = state.answer;
  const DetectionOptions& options = search.options;
  if (search.measure.limits().isCutOff() || !options.rotations) return;
  // A ball is symmetric about every line through its center.
  if (!search.cloud.isScan() || !answer.centers.empty()) return;
  const RotationEvidence rotations(search.cloud, search.measure.tolerance(), options.seed);
  if (std::optional<SymmetryCenter> center = centerOfScan(rotations, options)) {
    answer.axes.clear();
    answer.planes = withoutPlanesThrough(std::move(answer.planes), *center, search.cloud);
    answer.centers.push_back(*std::move(center));
    return;
  }
  const std::vector<Line3d> lines = linesOfNormals(rotations, options);
  answer.rotations = scanAxes(rotations, lines, answer.planes, answer.axes, options,
                              state.evidence ? &state.evidence->rotations : nullptr);
  answer.axes = withRoundAxes(rotations, std::move(answer.axes), answer.rotations, options);
  answer.planes = withoutPlanesThrough(std::move(answer.planes), answer.axes, search.cloud);
  // A body other than a ball has one axis: further axes, as of a dome, are round only within the tolerance.
  sortDescending(answer.axes, &SymmetryAxis::confidence);
  if (answer.axes.size() > 1) answer.axes.resize(1);
  if (!answer.axes.empty()) {
    limitByOpening(search, search.cloud.lineOf(answer.axes.front()), answer.planes);
  } else if (const auto body = bodyOfMug(search, rotations, lines, answer.planes)) {
    limitByHandle(search, rotations, *body, answer.planes);
    limitByOpening(search, body->axis, answer.planes);
  }
}

/// The planes of a body of revolution contain its axis or are perpendicular to it. Those that are neither, and less
/// likely than the axis, are possible at most.
void limitAskewPlanes(const PlaneSearch& search, DetectionState& state) {
  for (SymmetryPlane& plane : state.answer.planes)
    if (std::any_of(state.answer.axes.begin(), state.answer.axes.end(), [&](const SymmetryAxis& axis) {
          return axis.confidence > plane.confidence &&
                 !isAcross(search.cloud.toNormalized(plane), search.cloud.lineOf(axis));
        }))
      limitToPossible(plane, "neither contains nor is perpendicular to an axis of revolution, which is likelier");
}

/// Corrections of results by each other, applied in this order. Not in the paper.
constexpr struct {
  const char* name;  ///< stage in Detection::timing_ms
  void (*apply)(const PlaneSearch& search, DetectionState& state);
} kCorrections[] = {
    {"groups", completeGroups},
    {"right_angles", tryRightAngles},
    {"missing_pieces",
     [](const PlaneSearch& search, DetectionState& state) {
       doubtMissingPieces(state.answer.planes, search.cloud.kind(), search.options);
     }},
    {"polygon", completePolygon},
    {"families", findFamilies},
    {"rotations", findAxesOfScan},
    {"beside_axis", limitAskewPlanes},
    {"beside_best",
     [](const PlaneSearch& search, DetectionState& state) {
       doubtFurtherPlanes(state.answer.planes, state.answer.hasFamily(), search.cloud.kind(), search.options);
     }},
    {"slanted",
     [](const PlaneSearch& search, DetectionState& state) {
       doubtSlantedPlanes(state.answer.planes, search.support_normals, search.options);
     }},
    {"parts", findPlanesOfParts},
};

/// Section 4.4 and what follows: from the maxima of the map of a cloud to the list of planes. publishedPlanes() is the
/// section alone.
/// \param[in,out] state receives the results.
void refineAndDecide(const PlaneSearch& search, const SymmetryMap& map, DetectionState& state, StageTimes& done) {
  // Candidates: local maxima of the transform, and the planes perpendicular to the principal axes.
  std::vector<Candidate> candidates = gatherCandidates(search.cloud, map, search.options);
  done("maxima");

  // Iterative Symmetric Points, with more samples and narrower weights in each stage; the last one with the decision.
  candidates = search.fit.refineCoarsely(std::move(candidates), map.grid);
  done("coarse_refinement");
  candidates = search.fit.refineClosely(std::move(candidates));
  done("close_refinement");
  if (state.evidence) {
    state.evidence->planes = measureAllCandidates(search, candidates);
    done("evidence");
  }
  refineAndJudgeBestFirst(search, std::move(candidates), state.answer.planes);
  done("full_refinement");

  for (const auto& correction : kCorrections) {
    correction.apply(search, state);
    done(correction.name);
  }

  report(search, state);
  done("report");
}

/// The bulk of a cloud: all points that are not stray. Of a large cloud, some points represent it.
struct UsedPoints {
  const std::vector<int> stray, in_bulk;  ///< indices of points of the cloud
  const Points bulk;
  const std::string reason;                      ///< why the bulk cannot be analyzed; empty if it can
  const std::optional<std::vector<int>> subset;  ///< indices of points of the bulk; none if all are used
  std::vector<int> indices;                      ///< of the points of the cloud that are used
  Points points;                                 ///< that are used

  UsedPoints(const PointsRef& cloud, const DetectionOptions& options)
      : stray(strayPoints(cloud)),
        in_bulk(complementOf(stray, cloud.cols())),
        bulk(pointsAt(cloud, in_bulk)),
        reason(whyUnanswerable(bulk)),
        subset(reason.empty() ? drawSubset(bulk, options) : std::nullopt),
        indices(subset ? *subset : allIndices(bulk.cols())) {
    for (int& i : indices) i = in_bulk[i];
    points = pointsAt(cloud, indices);
  }
};

/// Sections 4.1 to 4.3: the distance transform and the map, unless the input has them.
/// \param[in,out] answer receives the map.
/// \return none if the input has both.
std::optional<GaussianEdt> computeMap(const PlaneInput& input, const UsedPoints& used, const DetectionOptions& options,
                                      Detection& answer, StageTimes& done) {
  if (input.map) return std::nullopt;
  std::optional<GaussianEdt> edt(std::in_place, used.points, options.edtOptions());
  done("distance_transform");
  const std::vector<float> free_space = freeSpace(*edt, input.visibility, options.num_threads);
  done("free_space");
  const PlaneGrid grid(options.expert, edt->center(), edt->radius());
  answer.map =
      sampledTransform(*edt, grid, {options.expert.num_samples, options.seed, options.num_threads}, free_space);
  answer.map.center_of_mass = centerOfMass(used.bulk);
  done("transform");
  return edt;
}

/// The normals of the distinct points: where copies differ, that of the last copy.
/// \param used indices of the points that became distinct ones, in the order of DistinctPoints::index_of.
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

/// Replaces the support of the evenly dense part by that of the whole cloud.
void supportWholeCloud(const NormalizedCloud& cloud, Detection& answer) {
  const std::vector<int> all = allIndices(cloud.points.cols());
  const auto complete = [&](SymmetryPlane& plane) {
    const ReflectionPlane normalized = cloud.toNormalized(plane);
    const IspStep step = matchSymmetricPoints(cloud.surface, all, normalized, cloud.final_sigma);
    plane.point_support = surfaceShares(cloud, normalized, all, step.closest).points.seenSupport();
  };
  for (SymmetryPlane& plane : answer.planes) complete(plane);
  if (answer.best) complete(*answer.best);
}

/// Spreads the support of the distinct points to the bulk.
void spreadToBulk(const UsedPoints& used, const DistinctPoints& distinct, int num_threads, Detection& answer) {
  if (answer.planes.empty() && !answer.best) return;
  spreadSupport(answer, used.subset ? closestPoints(*makeFlannSearch(used.points), used.bulk, num_threads).index
                                    : distinct.index_of);
}

/// Spreads the support of the bulk to the input. Stray points support no plane.
void spreadToInput(const UsedPoints& used, Eigen::Index num_points, Detection& answer) {
  if (used.stray.empty()) return;
  std::vector<int> index_in_bulk(num_points, -1);
  for (std::size_t i = 0; i < used.in_bulk.size(); ++i) index_in_bulk[used.in_bulk[i]] = static_cast<int>(i);
  spreadSupport(answer, index_in_bulk);
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
  edtOptions().validate();  // num_threads, too
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
  DetectionState state;
  state.evidence = evidence;
  Detection& answer = state.answer;
  StageTimes done(answer.timing_ms);

  const UsedPoints used(input.points, options);
  answer.num_stray_points = static_cast<int>(used.stray.size());
  answer.reason = used.reason;
  if (!answer.reason.empty()) return std::move(answer);
  if (used.subset) done("subset");

  const std::optional<GaussianEdt> own_edt = computeMap(input, used, options, answer, done);
  const GaussianEdt& edt = input.edt ? *input.edt : *own_edt;

  // The cloud: each position once and, where noise leaves no surface, evenly dense.
  const DistinctPoints distinct(used.points);
  const Points normals = input.normals ? normalsOf(distinct, *input.normals, used.indices) : Points();
  ClosestPointSearch::Ptr search;
  if (input.make_search) search = inFrame(input.make_search(distinct.points), edt.center(), edt.radius());
  const NormalizedCloud cloud(distinct.points, edt, std::move(search), input.visibility, options.num_threads,
                              input.normals ? &normals : nullptr);
  std::optional<EvenCloud> even;
  if (cloud.isVolume())
    if (const std::vector<int> kept = thinToEvenDensity(cloud, options.seed); kept.size() < distinct.first_of.size())
      even.emplace(cloud, distinct.points, kept, options.num_threads);

  // Section 4.4: planes.
  const PlaneSearch plane_search(even ? even->cloud : cloud, cloud.points, options);
  done("surface");
  refineAndDecide(plane_search, input.map ? *input.map : answer.map, state, done);

  if (even) supportWholeCloud(cloud, answer);
  spreadToBulk(used, distinct, options.num_threads, answer);
  if (used.subset) done("support_of_all");
  if (input.may_be_rings && input.visibility) decideByUprightBox(used.bulk, *input.visibility, options, answer);
  spreadToInput(used, input.points.cols(), answer);
  return std::move(answer);
}

}  // namespace pcl_symmetry
