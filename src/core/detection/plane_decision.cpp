#include "core/detection/plane_decision.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/detection/cloud_subset.h"
#include "core/detection/standing_object.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

bool isLimit(const Reason& reason) {
  return !reason.odds;
}

double oddsOf(double confidence) {
  constexpr double least = 1e-9;  // keeps the odds of certainty finite
  return std::max(least, confidence) / std::max(least, 1.0 - confidence);
}

void write(SymmetryPlane& plane, double confidence, const Reason& reason, const DetectionOptions& options) {
  plane.reasons.push_back(reason);
  plane.confidence = confidence;
  const bool is_limited = std::any_of(plane.reasons.begin(), plane.reasons.end(), isLimit);
  plane.kind = confidence >= options.min_confidence && !is_limited ? PlaneKind::Symmetry
               : confidence >= options.min_possible                ? PlaneKind::Possible
                                                                   : PlaneKind::Approximate;
}

/// Among the planes that are as likely as the likeliest, D decides.
/// \return null where there is none.
const SymmetryPlane* bestOf(const std::vector<SymmetryPlane>& planes) {
  double most = 0.0;
  for (const SymmetryPlane& plane : planes) most = std::max(most, plane.confidence);
  const auto best = std::max_element(planes.begin(), planes.end(), [&](const SymmetryPlane& a, const SymmetryPlane& b) {
    const bool a_likely = a.confidence >= most - kDetection.decide.as_likely,
               b_likely = b.confidence >= most - kDetection.decide.as_likely;
    return a_likely != b_likely ? b_likely : a.score < b.score;
  });
  return best == planes.end() ? nullptr : &*best;
}

/// The order of answers: symmetries, then possible ones, both by falling confidence, then others by falling support.
/// Equally confident ones stay in their order.
bool isBetter(const SymmetryPlane& a, const SymmetryPlane& b) {
  const auto rank = [](const SymmetryPlane& plane) {
    return plane.kind == PlaneKind::Symmetry ? 0 : plane.kind == PlaneKind::Possible ? 1 : 2;
  };
  if (rank(a) != rank(b)) return rank(a) < rank(b);
  return isDecided(a) ? a.confidence > b.confidence : a.support > b.support;
}

}  // namespace

void setConfidence(SymmetryPlane& plane, double confidence, const char* evidence, const DetectionOptions& options) {
  std::vector<Reason>& reasons = plane.reasons;
  eraseIf(reasons, [](const Reason& reason) { return !isLimit(reason); });
  write(plane, confidence, {evidence, oddsOf(confidence)}, options);
}

void changeConfidence(SymmetryPlane& plane, double confidence, const char* rule, const DetectionOptions& options) {
  write(plane, confidence, {rule, oddsOf(confidence) / oddsOf(plane.confidence)}, options);
}

void multiplyOdds(SymmetryPlane& plane, double odds, const char* rule, const DetectionOptions& options) {
  if (odds != 1.0) write(plane, withOdds(plane.confidence, odds), {rule, odds}, options);
}

void limitToPossible(SymmetryPlane& plane, const char* rule) {
  plane.reasons.push_back({rule, std::nullopt});
  if (plane.kind == PlaneKind::Symmetry) plane.kind = PlaneKind::Possible;
}

bool explainsAll(const SymmetryPlane& plane, CloudKind kind) {
  return kKindRules.may_lack_piece[kind] && plane.kind == PlaneKind::Symmetry &&
         1.0 - plane.seen <= kDetection.decide.nothing_missing;
}

void doubtMissingPieces(std::vector<SymmetryPlane>& planes, CloudKind kind, const DetectionOptions& options) {
  if (std::none_of(planes.begin(), planes.end(), [&](const SymmetryPlane& plane) { return explainsAll(plane, kind); }))
    return;
  for (SymmetryPlane& plane : planes)
    if (1.0 - plane.seen > kDetection.decide.piece_missing)
      multiplyOdds(plane, kDetection.decide.odds_of_a_piece, "needs a missing piece, but another plane explains all",
                   options);
}

void doubtFurtherPlanes(std::vector<SymmetryPlane>& planes, bool has_family, CloudKind kind,
                        const DetectionOptions& options) {
  const SymmetryPlane* const best = has_family ? nullptr : bestOf(planes);
  const char* const rule = has_family ? "there is an axis or a center, which explains more than a plane"
                                      : "another plane is likelier, or as likely with a greater score";
  for (SymmetryPlane& plane : planes)
    if (&plane != best) multiplyOdds(plane, furtherOdds(kind, 1.0 - plane.seen), rule, options);
}

void doubtSlantedPlanes(std::vector<SymmetryPlane>& planes, const std::vector<Eigen::Vector3d>& carrying_normals,
                        const DetectionOptions& options) {
  for (SymmetryPlane& plane : planes)
    if (isDecided(plane) && slants(plane, carrying_normals))
      multiplyOdds(plane, kDetection.decide.slanted_odds, "slants on what the object stands on", options);
}

MeasuredPlane PlaneDecision::decided(MeasuredPlane measured, const ReflectionPlane& plane) const {
  SymmetryPlane& result = measured.plane;
  for (const char* rule : measure_.limits().rulesAgainst(plane, cloud_.points)) limitToPossible(result, rule);
  constexpr KindRule<const char*> kRule{
      "how much of the surface the plane maps onto it, and how finely the points show it",
      "how much of the surface the plane maps onto it, and how much was seen",
      "how well each half of the points predicts the other; few points leave it open"};
  setConfidence(result, planeConfidence(measured.evidence), kRule[cloud_.kind()], options_);
  const double informative = std::min(1.0, measured.informative / kDetection.decide.min_informative);
  if (informative < 1.0)
    changeConfidence(result, result.confidence * informative, "few points move and land where the scanner saw",
                     options_);
  return measured;
}

bool PlaneDecision::isHopeless(const Candidate& candidate) const {
  if (!kKindRules.may_lack_piece[cloud_.kind()] || candidate.merit >= kDetection.stages.symmetric_merit) return false;
  const PlaneMeasure::ScreenedShare quick = measure_.screenedShare(candidate);
  return quick.share + kDetection.decide.screening_errors * quick.error < kDetection.decide.hopeful_share;
}

std::vector<MeasuredPlane> PlaneDecision::judge(const std::vector<Candidate>& candidates) const {
  std::vector<MeasuredPlane> judged(candidates.size());
  judge(candidates, std::vector<char>(candidates.size(), true), judged);
  return judged;
}

void PlaneDecision::judge(const std::vector<Candidate>& candidates, const std::vector<char>& some,
                          std::vector<MeasuredPlane>& judged) const {
  const std::vector<int> samples = measure_.samples();
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    if (some[i]) judged[i] = decided(measure_.measured(candidates[i], samples), candidates[i].plane);
  });
}

MeasuredPlane PlaneDecision::judge(const ReflectionPlane& plane, const std::vector<int>& samples) const {
  return decided(measure_.measured(plane, samples), plane);
}

JudgedFamily PlaneDecision::judgeFamily(const std::vector<ReflectionPlane>& planes,
                                        const std::vector<int>& samples) const {
  const double count = static_cast<double>(planes.size());
  const bool is_scan = !kKindRules.shows_all[cloud_.kind()];
  JudgedFamily family;
  PlaneEvidence together;
  together.share = together.double_share = together.hold = 0.0;
  double informative = 0.0, best_score = 0.0;
  for (const ReflectionPlane& plane : planes) {
    const PlaneEvidence one = measure_.measured(plane, samples, is_scan ? measure_.tolerance() : 0.0).evidence;
    together.support += one.support / count;
    together.conflict += one.conflict / count;
    const double part = (1.0 - one.unknown) / count;
    informative += part;
    together.share += part * one.share;
    together.double_share += part * one.double_share;
    together.hold += one.hold / count;
    best_score = std::max(best_score, one.score);
    family.score += one.score / count;
    family.min_confidence = std::min(family.min_confidence, planeConfidence(one));
  }
  // A scan shows some planes of a family better than others, and D falls with what is hidden: the plane that is shown
  // best represents the family.
  constexpr double least = 1e-3;  // avoids a division by 0
  PlaneEvidence mean = measure_.evidenceOf(together.support, together.conflict, is_scan ? best_score : family.score);
  mean.share = together.share / std::max(least, informative);
  mean.double_share = together.double_share / std::max(least, informative);
  mean.hold = together.hold;
  mean.unknown = 1.0 - informative;
  family.confidence = planeConfidence(mean);
  family.support = seenSupport(mean);
  return family;
}

std::vector<SymmetryPlane> JudgedCloud::refinedAndJudged(std::vector<Candidate> candidates) const {
  candidates = refinement.full(std::move(candidates));
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
  return judged.refinedAndJudged(judged.refinement.close(std::move(candidates)));
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
  std::stable_sort(planes.begin(), planes.end(), isBetter);
  std::vector<SymmetryPlane> ranked;
  for (SymmetryPlane& plane : planes) {
    if (static_cast<int>(ranked.size()) >= options.max_planes) break;
    if (!isDecided(plane) && !options.approximate) continue;
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

std::vector<SymmetryPlane> reordered(std::vector<SymmetryPlane> planes, const DetectionOptions& options) {
  if (!options.approximate) eraseIf(planes, [](const SymmetryPlane& p) { return !isDecided(p); });
  std::stable_sort(planes.begin(), planes.end(), isBetter);
  return planes;
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
