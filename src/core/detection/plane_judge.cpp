#include "core/detection/plane_judge.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/detection/candidates.h"
#include "core/detection/part_search.h"
#include "core/evidence/missing_surface.h"
#include "core/evidence/plane_stiffness.h"
#include "core/evidence/plane_support.h"
#include "core/evidence/surface_distance.h"
#include "core/geometry/open_borders.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/principal_axes.h"
#include "core/scan/sensor_noise.h"

namespace pcl_symmetry {

namespace {

// A scan yields many candidates and few planes: each is judged by one sample in this many. chosen: fewer samples make
// the confidence noisy, more cost time.
constexpr int kScanShare = 4;
// Share of the surface that a symmetry maps to within the tolerance. derived: the definition (evidence/README.md).
constexpr double kSymmetricShare = 0.97;
// Share within the tolerance from which nothing needs to be missing. chosen: above the 0.97 of a symmetry by the error
// of the share; at 1, borders are looked for in every cloud, which takes time.
constexpr double kSurelyWhole = 0.985;
// Samples whose distances are measured however far they are. chosen: the error of a share of 0.97 is 0.004; more cost
// time.
constexpr int kDeviationSamples = 2000;
// Offset stiffness from which an open border begins to excuse, and at twice which it does in full. chosen: 0.25 % of
// the surface across the plane has 0.01; at half, the noise of normals holds sheets, at twice, flat boxes are not held.
constexpr double kHeld = 0.02;
// Share of the surface near open borders up to which these say where something is missing, and from which on they say
// nothing, as of a wire, all of which is a border. chosen: clouds of 1000 to 10 000 points of 30 models of fold 0,
// whole and cut, have 0.56 at most; of 115 noisy curves nine of ten have more than 0.81. Limits of 0.4 and 0.5 doubt
// true planes of clouds of 1000 points.
constexpr double kFewBorders = 0.6, kBordersEverywhere = 0.75;
// Shares of the surface: less is missing by chance, and more is a piece; and the odds that a cloud lacks a piece
// although a plane explains all of it. chosen: cuts along a plane of symmetry are rare; at one, the plane across an
// open cup is as good as its others, at a hundredth, cut prisms lose planes.
constexpr double kNothingMissing = 0.01, kPieceMissing = 0.03, kOddsOfAPiece = 0.2;
// Share of the points that a plane leaves in place if it says nothing. chosen: half, as a sheet may be noisy; a box as
// thin as two tolerances keeps its plane at any value.
constexpr double kStillShare = 0.5;
// Tolerances by which a plane has to move a sample of a scan, so that its reflection says something: what lies at the
// plane is mapped onto itself, and a scan shows little else of some false planes. chosen: by cross-validation over
// scans of half of the models of fold 0: 0.206 nats a plane, 0.215 where all samples count.
constexpr double kStill = 2.0;
// Share of the samples of a scan that a plane moves to where something is known, below which its confidence falls: a
// table lies on itself, and what stands on it lands below, where nothing was seen. chosen: no right plane of 100
// labelled objects in frames of a Kinect is lost, and a table with a carton and bottles is no symmetry. Of 160 planes
// of virtual scans three are lost.
constexpr double kLeastTold = 0.1;
// Tolerances within which points that resolve no surface are a sheet or a line. chosen: noise of 1 % of the length of a
// line holds 97 % of the points within 2.7; at half, such lines have axes, at twice, thick noisy plates lose a plane.
constexpr double kNoisyThinness = 3.0;
// Spacings within which points of a line say nothing of its cross-section. derived: a tube of that radius has 2 pi 2 =
// 12 samples around.
constexpr double kRoundSpacings = 2.0;
// Samples of a first look, standard errors of their share, and the share of possible symmetries. chosen: planes that
// leave 7 % off have a confidence of 0.15 where nothing is missing; at half of the samples, fewer planes are refused.
constexpr int kLookSamples = 2000;
constexpr double kLookErrors = 2.0, kHopelessShare = 0.93;
constexpr double kLeastTelling = 1e-3;  // chosen: any small share; avoids a division by 0
constexpr double kLeastOwnShare = 0.1;  // chosen: any value far below that of surfaces; avoids a division by 0
// Tolerances at which the share is measured. derived: see PlaneEvidence.
constexpr std::array<double, 2> kTolerances{1.0, 2.0};
constexpr std::size_t kReflectedBlock = 1024;  // samples. chosen: large enough that threads start seldom

std::array<double, 2> sharesWithin(const std::vector<float>& distances, double tolerance) {
  std::array<double, 2> shares{};
  for (std::size_t k = 0; k < shares.size(); ++k)
    shares[k] = std::max(kLeastOwnShare, shareWithin(distances, kTolerances[k] * tolerance));
  return shares;
}

}  // namespace

PlaneJudge::PlaneJudge(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options)
    : cloud_(cloud),
      fit_(fit),
      options_(options),
      resolution_(cloud.isScan() ? resolvedTolerance(cloud.points, *cloud.visibility) : 0.0),
      tolerance_(options.absolute_tolerance > 0.0
                     ? options.absolute_tolerance / cloud.scale
                     : std::max(options.tolerance * cloud.extent,
                                std::min(resolution_, options.most_tolerance * cloud.extent))),
      thinness_(thinnessOf(cloud.points, cloud.principal_axes, (cloud.isVolume() ? kNoisyThinness : 1.0) * tolerance_,
                           lineTolerance())),
      halves_(cloud.isVolume() ? std::make_optional<SplitSurface>(cloud.points, options.seed, options.num_threads)
                               : std::nullopt),
      own_shares_(sharesWithin(
          halves_ ? halves_->ownDistances() : ownSurfaceDistances(cloud.samples, options.num_threads), tolerance_)),
      own_score_(halves_ ? halves_->ownScore(cloud.edt.numCells(), cloud.sigma, {Eigen::Vector3d::Zero(), 1.0},
                                             options.num_threads)
                         : 1.0) {}

double PlaneJudge::lineTolerance() const {
  const double noisy = kNoisyThinness * tolerance_;
  return cloud_.isVolume() ? noisy : std::clamp(kRoundSpacings * cloud_.spacing, tolerance_, noisy);
}

std::optional<ReflectionPlane> PlaneJudge::flatPlane() const {
  if (thinness_ != Thinness::Sheet) return std::nullopt;
  const PrincipalAxes& axes = cloud_.principal_axes;
  return ReflectionPlane(axes.axes.col(2), axes.axes.col(2).dot(axes.center));
}

std::vector<SymmetryPlane> PlaneJudge::judge(const std::vector<Candidate>& candidates) const {
  std::vector<SymmetryPlane> planes;
  for (JudgedPlane& judged : judgeWithEvidence(candidates)) planes.push_back(std::move(judged.plane));
  return planes;
}

std::vector<JudgedPlane> PlaneJudge::judgeWithEvidence(const std::vector<Candidate>& candidates) const {
  const Eigen::Index num_points = cloud_.points.cols();
  const std::vector<int> samples =
      cloud_.isScan() ? drawSamples(num_points, options_.num_refine_samples / kScanShare, options_.seed)
                      : allOf(num_points);
  std::vector<JudgedPlane> planes(candidates.size());
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    const Candidate& candidate = candidates[i];
    // The last stage may have matched these very samples.
    const bool has_matches = candidate.last.last.closest.size() == samples.size();
    const IspStep step = has_matches ? candidate.last.last : fit_.matches(candidate.plane, samples);
    planes[i] = judged(candidate.plane, fit_.shares(candidate.plane, samples, step), step, samples);
    planes[i].plane.iterations = candidate.iterations;
    planes[i].plane.converged = candidate.last.converged;
    planes[i].plane.residual = step.residual * cloud_.scale;
  });
  return planes;
}

PlaneJudge::Reflected PlaneJudge::reflected(const ReflectionPlane& plane, const std::vector<int>& samples,
                                            const IspStep& step) const {
  Reflected result{Points(3, static_cast<Eigen::Index>(samples.size())), std::vector<float>(samples.size())};
  parallelRanges(samples.size(), kReflectedBlock, options_.num_threads, [&](std::size_t begin, std::size_t end) {
    const auto size = static_cast<Eigen::Index>(end - begin), first = static_cast<Eigen::Index>(begin);
    Points some(3, size);
    for (Eigen::Index i = 0; i < size; ++i)
      some.col(i) =
          plane.reflect(cloud_.points.col(samples[static_cast<std::size_t>(first + i)]).cast<double>()).cast<float>();
    const std::vector<int> closest(step.closest.begin() + first, step.closest.begin() + first + size);
    const std::vector<float> distances = surfaceDistances(some, closest, cloud_.samples);
    std::copy(distances.begin(), distances.end(), result.distances.begin() + first);
    result.points.middleCols(first, size) = some;
  });
  return result;
}

Points PlaneJudge::matchedNormals(const IspStep& step) const {
  Points normals(3, static_cast<Eigen::Index>(step.closest.size()));
  for (std::size_t i = 0; i < step.closest.size(); ++i)
    normals.col(static_cast<Eigen::Index>(i)) = cloud_.geometry.normals.col(std::max(0, step.closest[i]));
  return normals;
}

bool PlaneJudge::isSeenEmpty(const Eigen::Vector3d& x, double rim) const {
  const Visibility& visibility = *cloud_.visibility;
  if (visibility.depthBehind(x) >= 0.0) return false;
  if (rim <= 0.0) return true;
  const Eigen::Vector3d ray = (x - visibility.viewpoint()).normalized(), u = ray.unitOrthogonal(), v = ray.cross(u);
  for (const Eigen::Vector3d& aside : {u, v, Eigen::Vector3d(-u), Eigen::Vector3d(-v)})
    if (visibility.depthBehind(x + rim * aside) >= 0.0) return false;
  return true;
}

std::vector<float> PlaneJudge::unknownMatches(const Reflected& reflected, const IspStep& step,
                                              const std::vector<char>& matched, double offset_stiffness,
                                              double rim) const {
  const std::size_t size = matched.size();
  std::vector<float> unknown(size, 0.0f);
  if (cloud_.isScan()) {
    for (std::size_t i = 0; i < size; ++i)
      if (!matched[i]) unknown[i] = isSeenEmpty(reflected.points.col(i).cast<double>(), rim) ? 0.0f : 1.0f;
    return unknown;
  }
  const double held = std::clamp(offset_stiffness / kHeld - 1.0, 0.0, 1.0);
  if (held <= 0.0 || static_cast<Eigen::Index>(size) != cloud_.points.cols()) return unknown;
  const std::vector<char>& open = borders();
  const auto trust = static_cast<float>(held * border_trust_);
  if (trust <= 0.0f) return unknown;
  unknown = missingCounterparts({*outermost_, cloud_.geometry, open, cloud_.spacing}, matched, step.closest,
                                reflected.points);
  for (std::size_t i = 0; i < size; ++i)
    if (!matched[i] && isCutOff(reflected.points.col(static_cast<Eigen::Index>(i)))) unknown[i] = 1.0f;
  for (float& value : unknown) value *= trust;
  return unknown;
}

PlaneJudge::Agreement PlaneJudge::agreement(const ReflectionPlane& plane, const Reflected& reflected,
                                            const IspStep& step, double rim) const {
  const std::size_t size = reflected.distances.size();
  const std::vector<float> of_halves = halves_ ? halves_->reflectedDistances(plane) : std::vector<float>();
  const std::vector<float> moved = halves_ ? of_halves : movedOnly(reflected.distances, plane, reflected.points);
  std::array<double, 2> within{};
  for (std::size_t k = 0; k < within.size() && !moved.empty(); ++k)
    within[k] = std::min(1.0, shareWithin(moved, kTolerances[k] * tolerance_) / own_shares_[k]);
  std::vector<char> matched(size);
  for (std::size_t i = 0; i < size; ++i) matched[i] = reflected.distances[i] <= tolerance_;
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  std::vector<float> unknown(size, 0.0f);
  if (cloud_.isScan() || (!cloud_.isVolume() && within[0] < kSurelyWhole)) {
    stiffness = motionStiffness(reflected.points, matchedNormals(step), matched, plane);
    unknown = unknownMatches(reflected, step, matched, offsetStiffness(stiffness), rim);
  }
  std::vector<float> telling;  // distances of the samples that say something
  std::size_t num_told = 0;
  std::array<double, 2> missing{};
  const double count = static_cast<double>(halves_ ? size : std::max<std::size_t>(1, moved.size()));
  for (std::size_t i = 0; i < size; ++i) {
    if (unknown[i] < 0.5f) telling.push_back(reflected.distances[i]);
    if (unknown[i] < 0.5f && moves(plane, reflected.points.col(static_cast<Eigen::Index>(i)))) ++num_told;
    for (std::size_t k = 0; k < missing.size(); ++k)
      if (reflected.distances[i] > kTolerances[k] * tolerance_) missing[k] += unknown[i] / count;
  }
  const auto share = [&](std::size_t k) {
    const double good = within[k], bad = std::max(0.0, 1.0 - good - missing[k]);
    return good + bad > 0.0 ? good / (good + bad) : 0.0;
  };
  const double told = cloud_.isScan() ? static_cast<double>(num_told) / static_cast<double>(size) : 1.0;
  // Within the tolerance is within twice of it; few points, whose own share is small, make more of the former.
  return {std::min(share(0), share(1)),    share(1), secondStiffness(stiffness), meanSupport(unknown),
          deviationOf(std::move(telling)), told};
}

bool PlaneJudge::moves(const ReflectionPlane& plane, const Eigen::Vector3f& x) const {
  return 2.0 * std::abs(plane.signedDistance(x.cast<double>())) > kStill * tolerance_;
}

std::vector<float> PlaneJudge::movedOnly(const std::vector<float>& distances, const ReflectionPlane& plane,
                                         const Points& reflected) const {
  if (!cloud_.isScan()) return distances;
  std::vector<float> moved;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (moves(plane, reflected.col(static_cast<Eigen::Index>(i)))) moved.push_back(distances[i]);
  return moved;
}

double PlaneJudge::deviationOf(std::vector<float> distances) const {
  if (distances.empty()) return 0.0;
  const auto last =
      distances.begin() + static_cast<std::ptrdiff_t>(kSymmetricShare * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), last, distances.end());
  return std::isfinite(*last) ? *last : cloud_.extent;
}

double PlaneJudge::deviation(const ReflectionPlane& plane) const {
  const ReflectionPlane normalized = cloud_.toNormalized(plane);
  const std::vector<int> samples = drawSamples(cloud_.points.cols(), kDeviationSamples, options_.seed);
  IspStep step;
  step.closest.assign(samples.size(), -1);
  Reflected all = reflected(normalized, samples, step);
  cloud_.search->search(all.points, 1, step.closest, step.sq_distances);
  return deviationOf(surfaceDistances(all.points, step.closest, cloud_.samples)) * cloud_.scale;
}

bool PlaneJudge::explainsAll(const SymmetryPlane& plane) const {
  return !cloud_.isScan() && plane.kind == PlaneKind::Symmetry && 1.0 - plane.seen <= kNothingMissing;
}

bool PlaneJudge::isHopeless(const Candidate& candidate) const {
  if (cloud_.isScan() || cloud_.isVolume() || candidate.merit >= kHopelessShare) return false;
  const std::vector<int> samples = drawSamples(cloud_.points.cols(), kLookSamples, options_.seed);
  const Reflected some = reflected(candidate.plane, samples, fit_.matches(candidate.plane, samples));
  const double share = std::min(1.0, shareWithin(some.distances, tolerance_) / own_shares_[0]);
  const double error = std::sqrt(share * (1.0 - share) / static_cast<double>(samples.size()));
  return share + kLookErrors * error < kHopelessShare;
}

PlaneEvidence PlaneJudge::evidence(const PlaneShares& shares, const Agreement& agreement, double score) const {
  PlaneEvidence evidence = fit_.evidence(shares.support, shares.conflict, score);
  evidence.share = agreement.share;
  evidence.double_share = agreement.double_share;
  evidence.hold = agreement.hold;
  evidence.tolerance = tolerance_;
  evidence.unknown = agreement.unknown;
  evidence.own_score = own_score_;
  evidence.flat = thinness_ == Thinness::Sheet;
  return evidence;
}

JudgedPlane PlaneJudge::judged(const ReflectionPlane& plane, const PlaneShares& shares, const IspStep& step,
                               const std::vector<int>& samples) const {
  SymmetryPlane answer(cloud_.toInput(plane));
  answer.point_support = shares.point_support;
  answer.score = cloud_.score(answer);
  const Agreement agreed = agreement(plane, reflected(plane, samples, step), step, 0.0);
  const PlaneEvidence all = evidence(shares, agreed, answer.score);
  const ShareInterval interval = shareInterval(all);
  answer.support = seenSupport(all);
  answer.share = agreed.share;
  answer.share_low = interval.low;
  answer.share_high = interval.high;
  answer.deviation = agreed.deviation * cloud_.scale;
  answer.seen = cloud_.isScan() ? std::min(1.0, shares.support + shares.conflict) : 1.0 - agreed.unknown;
  answer.confidence = planeConfidence(all) * std::min(1.0, agreed.told / kLeastTold);
  answer.kind = kindOf(answer, answer.confidence);
  return {std::move(answer), all};
}

bool PlaneJudge::leavesAllInPlace(const ReflectionPlane& plane) const {
  if (thinness_ == Thinness::Solid) return false;
  if (thinness_ == Thinness::Line) return true;
  const ReflectionPlane normalized = cloud_.toNormalized(plane);
  const double still = (cloud_.isVolume() ? kNoisyThinness : 1.0) * tolerance_;
  Eigen::Index num_moved = 0;
  for (Eigen::Index i = 0; i < cloud_.points.cols(); ++i)
    num_moved += 2.0 * std::abs(normalized.signedDistance(cloud_.points.col(i).cast<double>())) > still ? 1 : 0;
  return static_cast<double>(num_moved) < (1.0 - kStillShare) * static_cast<double>(cloud_.points.cols());
}

PlaneKind PlaneJudge::kindOf(const ReflectionPlane& plane, double confidence) const {
  // What moves nothing says nothing: a sheet is mapped onto itself by its own plane, whatever it is a part of.
  const bool decides = confidence >= options_.min_confidence && isResolved() && !leavesAllInPlace(plane);
  return decides                               ? PlaneKind::Symmetry
         : confidence >= options_.min_possible ? PlaneKind::Possible
                                               : PlaneKind::Approximate;
}

std::vector<SymmetryPlane> PlaneJudge::preferringWhole(std::vector<SymmetryPlane> planes) const {
  const auto needs = [](const SymmetryPlane& plane, double missing) { return 1.0 - plane.seen > missing; };
  const bool is_whole =
      std::any_of(planes.begin(), planes.end(), [&](const SymmetryPlane& plane) { return explainsAll(plane); });
  for (SymmetryPlane& plane : planes) {
    if (!is_whole || !needs(plane, kPieceMissing)) continue;
    const double odds = kOddsOfAPiece * plane.confidence;
    plane.confidence = odds / (odds + 1.0 - plane.confidence);
    plane.kind = kindOf(plane, plane.confidence);
  }
  return planes;
}

std::vector<SymmetryPlane> PlaneJudge::preferringBest(std::vector<SymmetryPlane> planes, bool has_family) const {
  const EvidenceKind kind = cloud_.isScan()     ? EvidenceKind::Scan
                            : cloud_.isVolume() ? EvidenceKind::Volume
                                                : EvidenceKind::Surface;
  const auto best = std::max_element(planes.begin(), planes.end(), [](const SymmetryPlane& a, const SymmetryPlane& b) {
    return a.confidence < b.confidence;
  });
  for (auto plane = planes.begin(); plane != planes.end(); ++plane) {
    if (plane == best && !has_family) continue;
    plane->confidence = furtherConfidence(plane->confidence, kind, 1.0 - plane->seen);
    plane->kind = kindOf(*plane, plane->confidence);
  }
  return planes;
}

JudgedFamily PlaneJudge::judgeFamily(const std::vector<ReflectionPlane>& planes,
                                     const std::vector<int>& samples) const {
  const double count = static_cast<double>(planes.size());
  JudgedFamily family;
  Agreement together{};
  double support = 0.0, conflict = 0.0, telling = 0.0, best_score = 0.0;
  for (const ReflectionPlane& plane : planes) {
    const IspStep step = fit_.matches(plane, samples);
    const PlaneShares shares = fit_.shares(plane, samples, step);
    const Agreement agreed =
        agreement(plane, reflected(plane, samples, step), step, cloud_.isScan() ? tolerance_ : 0.0);
    const double score = cloud_.score(cloud_.toInput(plane));
    support += shares.support / count;
    conflict += shares.conflict / count;
    const double told = (1.0 - agreed.unknown) / count;
    telling += told;
    together.share += told * agreed.share;
    together.double_share += told * agreed.double_share;
    together.hold += agreed.hold / count;
    best_score = std::max(best_score, score);
    family.score += score / count;
    family.least_confidence = std::min(family.least_confidence, planeConfidence(evidence(shares, agreed, score)));
  }
  // Planes of a family say as much as the scan shows of them, and D falls with what it does not show: the plane that
  // is shown best stands for it.
  for (double* share : {&together.share, &together.double_share}) *share /= std::max(kLeastTelling, telling);
  together.unknown = 1.0 - telling;
  const PlaneEvidence all = evidence({support, conflict, {}}, together, cloud_.isScan() ? best_score : family.score);
  family.confidence = planeConfidence(all);
  family.support = seenSupport(all);
  return family;
}

std::vector<SymmetryPlane> PlaneJudge::findParts(const std::vector<SymmetryPlane>& known) const {
  std::vector<SymmetryPlane> decided;
  std::copy_if(known.begin(), known.end(), std::back_inserter(decided), [](const SymmetryPlane& plane) {
    return plane.kind == PlaneKind::Symmetry || plane.kind == PlaneKind::Possible;
  });
  const std::vector<SymmetricPart> parts =
      findSymmetricParts(cloud_, fit_, {options_.update, options_.seed, options_.num_threads});
  const std::vector<int> all = allOf(cloud_.points.cols());
  std::vector<std::optional<SymmetryPlane>> of_parts(parts.size());
  parallelBlocks(parts.size(), options_.num_threads, [&](std::size_t i) {
    const SymmetricPart& part = parts[i];
    const auto normalized = [this](const SymmetryPlane& plane) { return cloud_.toNormalized(plane); };
    if (basinTolerance().anySame(decided, part.plane, normalized)) return;
    const IspStep step = fit_.matches(part.plane, all);
    SymmetryPlane plane = judged(part.plane, fit_.shares(part.plane, all, step), step, all).plane;
    if (plane.kind == PlaneKind::Symmetry) return;  // one of a family, which is known as its axis or center
    plane.kind = PlaneKind::Local;
    plane.iterations = part.iterations;
    plane.residual = step.residual * cloud_.scale;
    of_parts[i] = std::move(plane);
  });
  std::vector<SymmetryPlane> planes;
  for (std::optional<SymmetryPlane>& plane : of_parts)
    if (plane) planes.push_back(std::move(*plane));
  return planes;
}

const std::vector<char>& PlaneJudge::borders() const {
  std::call_once(borders_found_, [this] {
    borders_ =
        openBorders(cloud_.points, *cloud_.search, cloud_.geometry.normals, options_.num_threads, &cloud_.neighbours);
    outermost_.emplace(cloud_.points);
    cuts_ = findCutPlanes(cloud_.points, borders_, cloud_.spacing, options_.seed);
    const double near = shareNearBorders(borders_, cloud_.geometry);
    border_trust_ = std::clamp((kBordersEverywhere - near) / (kBordersEverywhere - kFewBorders), 0.0, 1.0);
  });
  return borders_;
}

bool PlaneJudge::isCutOff(const Eigen::Vector3f& x) const {
  return std::any_of(cuts_.begin(), cuts_.end(), [&](const CutPlane& cut) { return cut.normal.dot(x) > cut.offset; });
}

}  // namespace pcl_symmetry
