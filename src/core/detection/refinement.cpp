#include "core/detection/refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/detection/part_search.h"
#include "core/distance_transform/edt_correlation.h"
#include "core/distance_transform/free_space.h"
#include "core/evidence/plane_confidence.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/principal_axes.h"

namespace pcl_symmetry {

namespace {

constexpr double kCandidateAngle = 0.1;        // radians: maxima closer than this ...
constexpr double kCandidateOffset = 0.06;      // ... in angle and radii share one basin of refinement
constexpr double kFinalSigmaInSpacings = 3.0;  // weights at the end: well above the spacing, below sigma
constexpr int kCoarseIterations = 5, kCloseIterations = 6, kFullIterations = 8;  // symmetries converge in fewer
constexpr int kRoughIterations = 4;                                              // of planes that will never settle
constexpr double kLeastMerit = 0.93;                                             // of a symmetry of a whole cloud
constexpr double kCoarseSlack = 0.4, kCloseSlack = 0.1;                          // of merit below that after the stages
constexpr std::size_t kKeptCoarsely = 8, kKeptClosely = 4;                       // of planes that have less
constexpr double kSlopeAngle = 0.2, kSlopeOffset = 0.15;  // radians, radii: how far a slope may reach
constexpr double kSlopeDip = 0.005;                       // of D: what counts as falling
// In standard errors: once a Gauss-Newton step of a symmetry is this short, another one over all points leaves the
// errors of boxes and prisms (exact and sampled) where they are.
constexpr double kSettledErrorShare = 3.0;
constexpr int kRoughShare = 10;            // of them for planes that will never settle, one in so many
constexpr int kScanShare = 4;              // of the samples of the last stage, one in so many
constexpr std::size_t kMaxClosed = 16;     // planes whose group is completed; more belong to a continuous family
constexpr double kVolumeRoughness = 0.36;  // of the spacing: neighbours on all sides (0.42) rather than on a surface
constexpr double kDensityBandwidth = 1.5;  // spacings
constexpr int kDensityIterations = 6, kDensitySampleFactor = 10;  // a sample costs a tenth of a closest point
constexpr double kFamilyShare = 0.92, kSeenFamilyShare = 0.98;   // of all planes of a family; where only a part is seen
constexpr double kAllowance = 0.015, kDensityAllowance = 0.004;  // of the share, from the best plane to its family
constexpr double kFamilyTolerance = 0.03;                        // radii
constexpr int kFamilySamples = 1500;
constexpr double kUnseen = 0.02;  // of the points: less that is seen of a reflection says nothing

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Distance of two planes about the origin of the normalised frame: are they one within both limits?
bool samePlane(const ReflectionPlane& a, const ReflectionPlane& b, double angle, double offset) {
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  return a.angleTo(b) <= angle && std::abs(a.offset() - sign * b.offset()) <= offset;
}

/// D at one plane.
double correlation(const GaussianEdt& edt, const ReflectionPlane& plane) {
  const ReflectionPlane cells(plane.normal(), plane.signedDistance(edt.origin()) / -edt.cellSize());
  const Eigen::Vector3d step = Eigen::Vector3d::UnitX() - 2.0 * plane.normal().x() * plane.normal();
  return correlation(
      edt, [&](const Eigen::Vector3d& x) { return cells.reflect(x); }, step);
}

}  // namespace

Refinement::Refinement(const PointsRef& points, const GaussianEdt& edt, const DetectionOptions& options,
                       ClosestPointSearch::Ptr search, const Visibility* visibility)
    : edt_(edt),
      options_(options),
      center_(edt.center()),
      scale_(edt.radius()),
      points_(normalizePoints(points, center_, scale_)),
      search_(search ? std::move(search) : makeFlannSearch(points_)),
      geometry_(localGeometry(points_, *search_, kNumSupportNeighbours, options.num_threads)),
      far_(edt, center_, scale_),
      surface_{points_, geometry_.normals,  *search_, visibility ? &geometry_.at_border : nullptr,
               &far_,   options.num_threads},
      sigma_(edt.sigma() / scale_),
      spacing_(median(geometry_.spacing)),
      roughness_(median(geometry_.roughness) / std::max(spacing_, 1e-6)) {
  if (visibility) visibility_ = visibility->normalized(center_, scale_);
  final_sigma_ = std::min(sigma_, std::max(1e-6, kFinalSigmaInSpacings * spacing_));
  baseline_ = std::max(mean(ownSupport(points_, geometry_)), 1e-3);
  if (roughness_ > kVolumeRoughness && !visibility_)
    density_.emplace(points_, kDensityBandwidth * spacing_, options.num_threads);
}

std::vector<Candidate> Refinement::gather(const SymmetryMap& map) const {
  std::vector<Candidate> candidates;
  LocalMaximaOptions maxima = options_.maxima;
  maxima.num_threads = options_.num_threads;
  for (const LocalMaximum& maximum : findLocalMaxima(map, maxima)) {
    if (static_cast<int>(candidates.size()) >= options_.max_candidates) break;
    const ReflectionPlane plane = toNormalized(maximum.plane);
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
      return samePlane(c.plane, plane, kCandidateAngle, kCandidateOffset);
    });
    if (!known) candidates.push_back({plane, true});
  }
  if (options_.principal_planes)
    for (const ReflectionPlane& plane : principalPlanes(principalAxes(points_))) candidates.push_back({plane, false});
  return candidates;
}

void Refinement::refineCoarsely(const SymmetryMap& map, std::vector<Candidate>& candidates) const {
  std::vector<ReflectionPlane> starts;
  for (const Candidate& candidate : candidates) starts.push_back(candidate.plane);
  run(candidates, options_.num_coarse_samples, sigma_, std::clamp(final_sigma_, 0.5 * sigma_, sigma_),
      std::min(kCoarseIterations, options_.max_iterations));
  const double reach = 0.5 + options_.max_drift;
  const double angle = M_SQRT2 * reach * std::max(map.grid.thetaStep(), map.grid.phiStep());
  const double offset = reach * map.grid.radiusStep() / scale_;
  std::vector<Candidate> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (!candidates[i].from_map || samePlane(starts[i], candidates[i].plane, angle, offset))
      kept.push_back(candidates[i]);
  candidates = distinct(std::move(kept), leastMerit(kCoarseSlack), kKeptCoarsely);
}

void Refinement::refineClosely(std::vector<Candidate>& candidates, double least_merit) const {
  run(candidates, std::min(4 * options_.num_coarse_samples, options_.num_refine_samples),
      std::clamp(final_sigma_, 0.5 * sigma_, sigma_), final_sigma_,
      std::min(kCloseIterations, options_.max_iterations));
  candidates = distinct(std::move(candidates), std::max(least_merit, leastMerit(kCloseSlack)), kKeptClosely);
}

std::vector<SymmetryPlane> Refinement::finish(std::vector<Candidate>& candidates) const {
  // Of a scan, what is not seen limits a plane, not the number of points.
  run(candidates, options_.num_refine_samples / (visibility_ ? kScanShare : 1), final_sigma_, final_sigma_,
      std::min(kFullIterations, options_.max_iterations));
  // A plane of a scan is judged by fewer, as many are judged and few reported.
  const std::vector<int> all =
      visibility_ ? drawSamples(points_.cols(), options_.num_refine_samples / kScanShare, options_.seed)
                  : allOf(points_.cols());
  std::vector<SymmetryPlane> planes(candidates.size());
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    const Candidate& candidate = candidates[i];
    const bool seen_all = candidate.last.last.closest.size() == all.size();
    const IspStep step =
        seen_all ? candidate.last.last
                 : iterateSymmetricPoints(surface_, all, candidate.plane, final_sigma_, IspUpdate::PointToPoint);
    SymmetryPlane& plane = planes[i];
    static_cast<ReflectionPlane&>(plane) = toInput(candidate.plane).canonical();
    plane.iterations = candidate.iterations;
    plane.converged = candidate.last.converged;
    plane.residual = step.residual * scale_;
    judge(plane, sharesOf(candidate.plane, all, step));
  });
  return planes;
}

std::vector<Candidate> Refinement::closure(const std::vector<SymmetryPlane>& planes,
                                           std::vector<ReflectionPlane>& known) const {
  std::vector<ReflectionPlane> symmetries;
  for (const SymmetryPlane& plane : planes)
    if (isSymmetry(plane)) symmetries.push_back(toNormalized(plane));
  std::vector<Candidate> found;
  if (visibility_ || symmetries.size() > kMaxClosed) return found;
  known.insert(known.end(), symmetries.begin(), symmetries.end());
  for (const ReflectionPlane& plane : symmetries) {
    for (const ReflectionPlane& across : symmetries) {
      const Eigen::Vector3d normal = plane.normal() - 2.0 * plane.normal().dot(across.normal()) * across.normal();
      const ReflectionPlane image(normal, normal.dot(across.reflect(plane.offset() * plane.normal())));
      const bool is_known =
          std::any_of(known.begin(), known.end(), [&](const ReflectionPlane& other) { return same(other, image); });
      if (is_known) continue;
      known.push_back(image);
      found.push_back({image, false});
    }
  }
  if (!found.empty()) refineClosely(found, kLeastMerit - kCloseSlack);
  return found;
}

void Refinement::collectFamilies(Detection& detection) const {
  std::vector<const SymmetryPlane*> symmetries;
  for (const SymmetryPlane& plane : detection.planes)
    if (isSymmetry(plane)) symmetries.push_back(&plane);
  if (symmetries.size() < 2) return;
  std::stable_sort(symmetries.begin(), symmetries.end(),
                   [](const auto* a, const auto* b) { return a->confidence > b->confidence; });
  std::vector<ReflectionPlane> planes;
  for (const SymmetryPlane* plane : symmetries) {
    const ReflectionPlane normalized = toNormalized(*plane);
    const bool known = std::any_of(planes.begin(), planes.end(),
                                   [&](const ReflectionPlane& other) { return same(other, normalized); });
    if (!known) planes.push_back(normalized);
  }
  const std::vector<int> samples = drawSamples(points_.cols(), kFamilySamples, options_.seed);
  const FamilyTest test = familyTest(samples);
  const auto drop = [&](const auto& belongs) {
    auto& list = detection.planes;
    list.erase(
        std::remove_if(list.begin(), list.end(), [&](const SymmetryPlane& p) { return belongs(toNormalized(p)); }),
        list.end());
  };
  if (const auto center = findCenter(planes, test)) {
    const SymmetryAxis judged = judgedFamily(center->planes, samples);
    detection.centers.push_back({center->point * scale_ + center_, judged.confidence, judged.score, judged.support});
    drop([&](const ReflectionPlane& p) { return std::abs(p.signedDistance(center->point)) <= test.tolerance; });
    return;
  }
  for (const AxisFamily& family : findAxes(planes, test)) {
    SymmetryAxis axis = judgedFamily(family.planes, samples);
    axis.point = family.line.origin() * scale_ + center_;
    axis.direction = family.line.direction();
    detection.axes.push_back(axis);
    drop([&](const ReflectionPlane& p) { return contains(p, family.line, test.tolerance); });
  }
}

std::vector<SymmetryPlane> Refinement::report(std::vector<SymmetryPlane> planes) const {
  // Nearly symmetries and symmetries of parts come last, those that more of the surface supports first.
  const auto rank = [](const SymmetryPlane& p) {
    return p.kind == PlaneKind::Symmetry ? 0 : p.kind == PlaneKind::Possible ? 1 : 2;
  };
  std::stable_sort(planes.begin(), planes.end(), [&](const SymmetryPlane& a, const SymmetryPlane& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    if (rank(a) < 2 && a.confidence != b.confidence) return a.confidence > b.confidence;
    return a.support > b.support;
  });
  std::vector<SymmetryPlane> reported;
  for (SymmetryPlane& plane : planes) {
    if (static_cast<int>(reported.size()) >= options_.max_planes) break;
    if (rank(plane) == 2 && !options_.approximate) continue;
    if (rank(plane) == 1 && static_cast<int>(reported.size()) >= options_.max_possible) continue;
    const bool known = std::any_of(reported.begin(), reported.end(), [&](const SymmetryPlane& other) {
      return same(toNormalized(other), toNormalized(plane)) || onSlopeOf(other, plane);
    });
    if (!known) reported.push_back(std::move(plane));
  }
  parallelBlocks(reported.size(), options_.num_threads, [&](std::size_t i) {
    if (reported[i].point_support.size() != static_cast<std::size_t>(points_.cols()))
      reported[i].point_support = sharesOf(toNormalized(reported[i]), allOf(points_.cols())).point_support;
  });
  return reported;
}

bool Refinement::same(const ReflectionPlane& a, const ReflectionPlane& b) const {
  return samePlane(a, b, options_.merge_angle, options_.merge_offset);
}

/// Refinement can come to rest on the way to a maximum, where few points say how to go on (on flat pieces, say): a
/// plane is a maximum of its own only if D falls on the way to a better one nearby.
bool Refinement::onSlopeOf(const SymmetryPlane& better, const SymmetryPlane& plane) const {
  const ReflectionPlane a = toNormalized(better), b = toNormalized(plane);
  if (!samePlane(a, b, kSlopeAngle, kSlopeOffset)) return false;
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d normal = a.normal() + sign * b.normal();
  const ReflectionPlane between(normal, 0.5 * normal.norm() * (a.offset() + sign * b.offset()));
  return correlation(edt_, toInput(between)) > plane.score - kSlopeDip;
}

double Refinement::meritOf(const Shares& shares) const {
  if (density_) return shares.support;
  return seenSymmetry(std::min(1.0, shares.support / baseline_), shares.conflict);
}

/// What a stage asks of candidates; of scans, and where approximate symmetries are wanted, the best few go on anyway.
double Refinement::leastMerit(double slack) const {
  return visibility_ || options_.approximate ? -1.0 : kLeastMerit - slack;
}

void Refinement::run(std::vector<Candidate>& candidates, int num_samples, double sigma, double final_sigma,
                     int max_iterations) const {
  if (density_) return runByDensity(candidates, num_samples);
  const std::vector<int> samples = drawSamples(points_.cols(), num_samples, options_.seed);
  // Matches of an approximate symmetry never settle: a tenth of the samples places it as well as it can be placed.
  const std::vector<int> fewer =
      drawSamples(points_.cols(),
                  std::min(num_samples, options_.num_refine_samples / (visibility_ ? 2 * kRoughShare : kRoughShare)),
                  options_.seed);
  IspOptions isp;
  isp.update = options_.update;
  isp.sigma = sigma;
  isp.final_sigma = final_sigma;
  isp.max_iterations = max_iterations;
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    const bool settles =
        candidate.iterations == 0 || candidate.merit >= kLeastMerit - (visibility_ ? 0.0 : kCloseSlack);
    const std::vector<int>& used = settles ? samples : fewer;
    IspOptions own = isp;
    // On the way to narrow weights a scan is led by whole distances: across flat pieces alone it would slide.
    if (visibility_ && num_samples > options_.num_coarse_samples && final_sigma < sigma)
      own.update = IspUpdate::PointToPoint;
    if (!settles) own.max_iterations = std::min(own.max_iterations, kRoughIterations);
    if (settles && options_.update == IspUpdate::PointToPlane) own.error_share = kSettledErrorShare;
    const ReflectionPlane start = candidate.plane;
    candidate.last = refineSymmetricPoints(surface_, used, start, own);
    candidate.plane = candidate.last.plane;
    candidate.iterations += candidate.last.iterations;
    candidate.merit = meritOf(sharesOf(candidate.plane, used, candidate.last.last));
    if (visibility_ && final_sigma == sigma) returnIfSlid(candidate, start, used, sigma);
  });
}

/// Distances across the surface say nothing about a plane along flat pieces, and half a shape may have little else: the
/// plane takes one step by whole distances instead if what is seen then speaks for it more.
void Refinement::returnIfSlid(Candidate& candidate, const ReflectionPlane& start, const std::vector<int>& samples,
                              double sigma) const {
  IspStep step =
      iterateSymmetricPoints(surface_, samples, start, sigma, IspUpdate::PointToPoint, &candidate.last.last.closest);
  const double merit = meritOf(sharesOf(step.plane, samples, step));
  if (merit <= candidate.merit) return;
  candidate.plane = step.plane;
  candidate.merit = merit;
  candidate.last.last = std::move(step);
}

void Refinement::runByDensity(std::vector<Candidate>& candidates, int num_samples) const {
  const int wanted = std::min(kDensitySampleFactor * num_samples, options_.num_refine_samples);
  const Points samples = pointsAt(points_, drawSamples(points_.cols(), wanted, options_.seed));
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    const int most = std::min(kDensityIterations, options_.max_iterations);
    int iterations = 0;
    candidate.plane = density_->refine(samples, candidate.plane, most, iterations);
    candidate.last.converged = iterations < most;
    candidate.iterations += iterations;
    candidate.merit = density_->overlap(samples, candidate.plane);
  });
}

Refinement::Shares Refinement::sharesOf(const ReflectionPlane& plane, const std::vector<int>& samples,
                                        const IspStep& step) const {
  const auto size = static_cast<Eigen::Index>(samples.size());
  Points reflected(3, size), normals(3, size);
  const Eigen::Vector3f n = plane.normal().cast<float>();
  for (Eigen::Index i = 0; i < size; ++i) {
    reflected.col(i) = plane.reflect(points_.col(samples[i]).cast<double>()).cast<float>();
    const Eigen::Vector3f normal = geometry_.normals.col(samples[i]);
    normals.col(i) = normal - 2.0f * n.dot(normal) * n;
  }
  PointEvidence evidence =
      pointEvidence(reflected, normals, step.closest, points_, geometry_, visibility_ ? &*visibility_ : nullptr);
  Shares shares{mean(evidence.support), mean(evidence.conflict), std::move(evidence.support)};
  if (density_) {
    shares.support = density_->overlap(pointsAt(points_, samples), plane);
    shares.conflict = std::max(0.0, 1.0 - shares.support);
  }
  return shares;
}

Refinement::Shares Refinement::sharesOf(const ReflectionPlane& plane, const std::vector<int>& samples) const {
  return sharesOf(plane, samples,
                  iterateSymmetricPoints(surface_, samples, plane, final_sigma_, IspUpdate::PointToPoint));
}

/// The best of each group of like planes, best first: all that may be symmetries, and of the others so many that there
/// are \p most.
std::vector<Candidate> Refinement::distinct(std::vector<Candidate> candidates, double least_merit,
                                            std::size_t most) const {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.merit > b.merit; });
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    if (candidate.merit < least_merit) break;
    if (candidate.merit < kLeastMerit - kCloseSlack && kept.size() >= most) break;
    const bool known = std::any_of(kept.begin(), kept.end(),
                                   [&](const Candidate& other) { return same(other.plane, candidate.plane); });
    if (!known) kept.push_back(std::move(candidate));
  }
  return kept;
}

void Refinement::judge(SymmetryPlane& plane, const Shares& shares) const {
  plane.point_support = shares.point_support;
  plane.score = correlation(edt_, plane);
  const PlaneEvidence evidence{
      shares.support, shares.conflict,         plane.score,         density_ ? 1.0 : baseline_, spacing_,
      roughness_,     visibility_.has_value(), density_.has_value()};
  plane.support = seenSupport(evidence);
  plane.seen = std::min(1.0, shares.support + shares.conflict);
  plane.confidence = planeConfidence(evidence);
  plane.kind = plane.confidence >= options_.min_confidence                ? PlaneKind::Symmetry
               : visibility_ && plane.confidence >= options_.min_possible ? PlaneKind::Possible
                                                                          : PlaneKind::Approximate;
}

double Refinement::familyShare(const ReflectionPlane& plane, const std::vector<int>& samples) const {
  const Shares shares = sharesOf(plane, samples);
  const double support = std::min(1.0, density_ ? shares.support : shares.support / baseline_);
  return (support + kUnseen) / (std::min(1.0, support + shares.conflict) + kUnseen);
}

FamilyTest Refinement::familyTest(const std::vector<int>& samples) const {
  FamilyTest test;
  test.min_share = visibility_ ? kSeenFamilyShare : kFamilyShare;
  test.allowance = density_ ? kDensityAllowance : kAllowance;
  test.tolerance = kFamilyTolerance;
  test.share = [this, samples](const ReflectionPlane& plane) { return familyShare(plane, samples); };
  const std::vector<int> fewer(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 5));
  test.rough_share = [this, fewer](const ReflectionPlane& plane) { return familyShare(plane, fewer); };
  test.refine = [this, samples](const ReflectionPlane& plane) {
    int iterations = 0;
    if (density_) return density_->refine(pointsAt(points_, samples), plane, kDensityIterations, iterations);
    IspOptions isp;
    isp.update = options_.update;
    isp.sigma = isp.final_sigma = final_sigma_;
    isp.max_iterations = kCloseIterations;
    return refineSymmetricPoints(surface_, samples, plane, isp).plane;
  };
  return test;
}

/// Confidence, score and support of the planes of a family together.
SymmetryAxis Refinement::judgedFamily(const std::vector<ReflectionPlane>& planes,
                                      const std::vector<int>& samples) const {
  SymmetryAxis family{};
  double support = 0.0, conflict = 0.0;
  const double count = static_cast<double>(planes.size());
  for (const ReflectionPlane& plane : planes) {
    const Shares shares = sharesOf(plane, samples);
    support += shares.support / count;
    conflict += shares.conflict / count;
    family.score += correlation(edt_, toInput(plane)) / count;
  }
  const PlaneEvidence evidence{support,
                               conflict,
                               family.score,
                               density_ ? 1.0 : baseline_,
                               spacing_,
                               roughness_,
                               visibility_.has_value(),
                               density_.has_value()};
  family.support = seenSupport(evidence);
  family.confidence = planeConfidence(evidence);
  return family;
}

std::vector<SymmetryPlane> Refinement::findParts(const std::vector<SymmetryPlane>& known) const {
  IspOptions isp;
  isp.update = options_.update;
  isp.sigma = sigma_;
  isp.final_sigma = final_sigma_;
  isp.max_iterations = kCloseIterations;
  const auto support = [this](const ReflectionPlane& plane, const std::vector<int>& samples) {
    return std::min(1.0, sharesOf(plane, samples).support / baseline_);
  };
  const std::vector<int> all = allOf(points_.cols());
  std::vector<SymmetryPlane> planes;
  for (const SymmetricPart& part : findSymmetricParts(surface_, isp, support)) {
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const SymmetryPlane& other) {
      return samePlane(toNormalized(other), part.plane, kCandidateAngle, kCandidateOffset);
    });
    if (is_known) continue;
    SymmetryPlane plane;
    static_cast<ReflectionPlane&>(plane) = toInput(part.plane).canonical();
    const IspStep step = iterateSymmetricPoints(surface_, all, part.plane, final_sigma_, IspUpdate::PointToPoint);
    judge(plane, sharesOf(part.plane, all, step));
    if (isSymmetry(plane)) continue;  // one of a family, which is known as its axis or center
    plane.kind = PlaneKind::Local;
    plane.iterations = part.iterations;
    plane.residual = step.residual * scale_;
    planes.push_back(std::move(plane));
  }
  return planes;
}

}  // namespace pcl_symmetry
