#include "pcl_symmetry/core/plane_detection.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>

#include "check.h"
#include "pcl_symmetry/core/parallel.h"
#include "pcl_symmetry/core/plane_support.h"
#include "pcl_symmetry/core/principal_axes.h"
#include "pcl_symmetry/core/random.h"
#include "pcl_symmetry/core/sampled_transform.h"
#include "pcl_symmetry/core/surface_normals.h"

namespace pcl_symmetry {

namespace {

constexpr double kCandidateAngle = 0.1;        // radians: maxima closer than this ...
constexpr double kCandidateOffset = 0.06;      // ... in angle and radii share one basin of refinement
constexpr double kFinalSigmaInSpacings = 3.0;  // weights at the end: well above the spacing, well below sigma
constexpr double kLeastShare = 0.5;  // of min_score in a bin that may hold a plane of it: off its center D is half
constexpr double kCoarseSlack = 0.3, kCloseSlack = 0.05;    // of support below min_support after the stages
constexpr int kCoarseIterations = 5, kCloseIterations = 6;  // symmetries converge in fewer
constexpr double kSlopeAngle = 0.2, kSlopeOffset = 0.15;    // radians, radii: how far a slope may reach
constexpr double kSlopeDip = 0.005;                         // of D: what counts as falling
// In standard errors: once a Gauss-Newton step of a symmetry is this short, another one over all points leaves the
// errors of boxes and prisms (exact and sampled) where they are.
constexpr double kSettledErrorShare = 3.0;
constexpr int kFewestKept = 12;
constexpr std::size_t kMaxClosed = 16;  // planes whose group is completed; more belong to a continuous family

class Stopwatch {
public:
  /// Milliseconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return elapsed;
  }

private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Planes in the frame in which everything is refined: the points lie in the unit ball about 0.
struct NormalizedFrame {
  Eigen::Vector3d center;
  double scale;

  ReflectionPlane toNormalized(const ReflectionPlane& p) const {
    return ReflectionPlane(p.normal(), p.signedDistance(center) / -scale);
  }
  ReflectionPlane toInput(const ReflectionPlane& p) const {
    return ReflectionPlane(p.normal(), p.offset() * scale + p.normal().dot(center));
  }
};

struct Candidate {
  ReflectionPlane plane;  // normalised frame, where the last stage left it
  bool from_map;          // has a cell to stay in
  int iterations = 0;
  IspResult last = {};
  double support = 0.0;  // of the samples of the last stage
};

/// Distance of two planes about the origin of the normalised frame: are they one within both limits?
bool samePlane(const ReflectionPlane& a, const ReflectionPlane& b, double angle, double offset) {
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  return a.angleTo(b) <= angle && std::abs(a.offset() - sign * b.offset()) <= offset;
}

std::vector<int> drawSamples(int size, int num_samples, std::uint64_t seed) {
  std::vector<int> samples(size);
  std::iota(samples.begin(), samples.end(), 0);
  if (num_samples >= size) return samples;
  RandomStream random(seed);
  for (int i = 0; i < num_samples; ++i) std::swap(samples[i], samples[i + random.below(size - i)]);
  samples.resize(num_samples);
  return samples;
}

std::vector<Candidate> gatherCandidates(const SymmetryMap& map, const Points& points, const NormalizedFrame& frame,
                                        const DetectionOptions& options) {
  std::vector<Candidate> candidates;
  LocalMaximaOptions maxima = options.maxima;
  maxima.num_threads = options.num_threads;
  for (const LocalMaximum& maximum : findLocalMaxima(map, maxima)) {
    if (static_cast<int>(candidates.size()) >= options.max_candidates) break;
    if (!options.approximate && maximum.value < kLeastShare * options.min_score) break;
    const ReflectionPlane plane = frame.toNormalized(maximum.plane);
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
      return samePlane(c.plane, plane, kCandidateAngle, kCandidateOffset);
    });
    if (!known) candidates.push_back({plane, true});
  }
  if (options.principal_planes)
    for (const ReflectionPlane& plane : principalPlanes(principalAxes(points))) candidates.push_back({plane, false});
  return candidates;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// D at one plane: the full sum over the cells of the EDT.
double correlation(const GaussianEdt& edt, const ReflectionPlane& plane) {
  const auto& f = edt.values();
  double sum = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i)
    if (f[i] > 0.0f) sum += f[i] * edt(plane.reflect(edt.cellCenter(i)));
  return std::clamp(sum / edt.sqNorm(), 0.0, 1.0);
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
  check(min_support >= 0.0 && min_support <= 1.0, "min_support", min_support, "in [0, 1]");
  check(min_score >= 0.0 && min_score <= 1.0, "min_score", min_score, "in [0, 1]");
  check(max_planes >= 1, "max_planes", max_planes, ">= 1");
  checkNumThreads(num_threads);
}

Detection detectPlanes(const PointsRef& points, const DetectionOptions& options,
                       const std::function<ClosestPointSearch::Ptr(const GaussianEdt&)>& make_search) {
  options.validate();
  Stopwatch watch;
  const GaussianEdt edt(points, options.edt);
  const double edt_ms = watch.lap();
  const PlaneGrid grid(options.num_theta, options.num_phi, options.num_radius, edt.center(), edt.radius());
  SampledTransformOptions sampling;
  sampling.num_samples = options.num_samples;
  sampling.seed = options.seed;
  sampling.num_threads = options.num_threads;
  SymmetryMap map = sampledTransform(edt, grid, sampling);
  map.center_of_mass = centerOfMass(points);
  const double transform_ms = watch.lap();
  Detection detection = refineMaxima(points, edt, map, options, make_search ? make_search(edt) : nullptr);
  detection.map = std::move(map);
  detection.timing_ms.insert(detection.timing_ms.begin(),
                             {{"distance_transform", edt_ms}, {"transform", transform_ms}});
  return detection;
}

namespace {

/// The stages of refinement, in the normalised frame.
class Refinement {
public:
  Refinement(const PointsRef& points, const GaussianEdt& edt, const DetectionOptions& options,
             ClosestPointSearch::Ptr search)
      : edt_(edt),
        options_(options),
        frame_{edt.center(), edt.radius()},
        points_(normalizePoints(points, frame_.center, frame_.scale)),
        search_(search ? search : makeFlannSearch(points_)),
        geometry_(localGeometry(points_, *search_, kNumSupportNeighbours, options.num_threads)),
        surface_{points_, geometry_.normals, *search_, options.num_threads},
        sigma_(edt.sigma() / frame_.scale) {
    std::vector<float> spacing = geometry_.spacing;
    std::nth_element(spacing.begin(), spacing.begin() + spacing.size() / 2, spacing.end());
    final_sigma_ = std::min(sigma_, std::max(1e-6, kFinalSigmaInSpacings * spacing[spacing.size() / 2]));
  }

  std::vector<Candidate> gather(const SymmetryMap& map) const {
    return gatherCandidates(map, points_, frame_, options_);
  }

  /// Few samples and wide weights: most candidates end in a basin that another one found, or leave their cell.
  void refineCoarsely(const SymmetryMap& map, std::vector<Candidate>& candidates) const {
    const std::vector<ReflectionPlane> starts = planesOf(candidates);
    run(candidates, options_.num_coarse_samples, sigma_, std::clamp(final_sigma_, 0.5 * sigma_, sigma_),
        std::min(kCoarseIterations, options_.max_iterations));
    const double reach = 0.5 + options_.max_drift;
    const double angle = M_SQRT2 * reach * std::max(map.grid.thetaStep(), map.grid.phiStep());
    const double offset = reach * map.grid.radiusStep() / frame_.scale;
    std::vector<Candidate> kept;
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (!candidates[i].from_map || samePlane(starts[i], candidates[i].plane, angle, offset))
        kept.push_back(candidates[i]);
    candidates = distinct(std::move(kept), kCoarseSlack);
  }

  /// Weights as narrow as the spacing of the points allows, still on a part of them.
  void refineClosely(std::vector<Candidate>& candidates) const {
    run(candidates, std::min(4 * options_.num_coarse_samples, options_.num_refine_samples),
        std::clamp(final_sigma_, 0.5 * sigma_, sigma_), final_sigma_,
        std::min(kCloseIterations, options_.max_iterations));
    candidates = distinct(std::move(candidates), kCloseSlack);
    // Some of them still run into others: twice as many as asked for are enough.
    const std::size_t enough = static_cast<std::size_t>(std::max(2 * options_.max_planes, kFewestKept));
    if (candidates.size() > enough) candidates.erase(candidates.begin() + enough, candidates.end());
  }

  /// All samples; the precision of the planes is decided here.
  std::vector<SymmetryPlane> finish(std::vector<Candidate>& candidates) const {
    run(candidates, options_.num_refine_samples, final_sigma_, final_sigma_, options_.max_iterations);
    std::vector<int> all(points_.cols());
    std::iota(all.begin(), all.end(), 0);
    std::vector<SymmetryPlane> planes(candidates.size());
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      const Candidate& candidate = candidates[i];
      const bool seen_all = static_cast<Eigen::Index>(candidate.last.last.closest.size()) == points_.cols();
      const IspStep step =
          seen_all ? candidate.last.last
                   : iterateSymmetricPoints(surface_, all, candidate.plane, final_sigma_, IspUpdate::PointToPoint);
      SymmetryPlane& plane = planes[i];
      static_cast<ReflectionPlane&>(plane) = frame_.toInput(candidate.plane).canonical();
      plane.point_support = pointSupport(step.closest, step.sq_distances, geometry_.spacing);
      plane.support = mean(plane.point_support);
      plane.score = correlation(edt_, plane);
      plane.iterations = candidate.iterations;
      plane.converged = candidate.last.converged;
      plane.residual = step.residual * frame_.scale;
      plane.approximate = plane.support < options_.min_support || plane.score < options_.min_score;
    });
    return planes;
  }

  /// The reflection of one plane of symmetry in another is a plane of symmetry: those that the map did not show.
  std::vector<Candidate> closure(const std::vector<SymmetryPlane>& planes) const {
    std::vector<ReflectionPlane> known;
    for (const SymmetryPlane& plane : planes)
      if (!plane.approximate) known.push_back(frame_.toNormalized(plane));
    std::vector<Candidate> found;
    const std::size_t size = known.size();
    for (std::size_t i = 0; i < size && size <= kMaxClosed; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        const Eigen::Vector3d normal =
            known[i].normal() - 2.0 * known[i].normal().dot(known[j].normal()) * known[j].normal();
        const ReflectionPlane image(normal, normal.dot(known[j].reflect(known[i].offset() * known[i].normal())));
        const bool is_known =
            std::any_of(known.begin(), known.end(), [&](const ReflectionPlane& other) { return same(other, image); });
        if (is_known) continue;
        known.push_back(image);
        found.push_back({image, false});
      }
    }
    return found;
  }

  /// Best first, each once, as the options ask.
  std::vector<SymmetryPlane> report(std::vector<SymmetryPlane> planes) const {
    std::stable_sort(planes.begin(), planes.end(), [](const SymmetryPlane& a, const SymmetryPlane& b) {
      return a.support > b.support || (a.support == b.support && a.score > b.score);
    });
    std::vector<SymmetryPlane> reported;
    for (SymmetryPlane& plane : planes) {
      if (static_cast<int>(reported.size()) >= options_.max_planes) break;
      if (plane.approximate && !options_.approximate) continue;
      const bool known = std::any_of(reported.begin(), reported.end(), [&](const SymmetryPlane& other) {
        return same(frame_.toNormalized(other), frame_.toNormalized(plane)) || onSlopeOf(other, plane);
      });
      if (!known) reported.push_back(std::move(plane));
    }
    return reported;
  }

private:
  static std::vector<ReflectionPlane> planesOf(const std::vector<Candidate>& candidates) {
    std::vector<ReflectionPlane> planes;
    for (const Candidate& candidate : candidates) planes.push_back(candidate.plane);
    return planes;
  }

  bool same(const ReflectionPlane& a, const ReflectionPlane& b) const {
    return samePlane(a, b, options_.merge_angle, options_.merge_offset);
  }

  /// Refinement can come to rest on the way to a maximum, where few points say how to go on (on flat pieces, say): a
  /// plane is a maximum of its own only if D falls on the way to a better one nearby.
  bool onSlopeOf(const SymmetryPlane& better, const SymmetryPlane& plane) const {
    const ReflectionPlane a = frame_.toNormalized(better), b = frame_.toNormalized(plane);
    if (!samePlane(a, b, kSlopeAngle, kSlopeOffset)) return false;
    const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d normal = a.normal() + sign * b.normal();
    const ReflectionPlane between(normal, 0.5 * normal.norm() * (a.offset() + sign * b.offset()));
    return correlation(edt_, frame_.toInput(between)) > plane.score - kSlopeDip;
  }

  void run(std::vector<Candidate>& candidates, int num_samples, double sigma, double final_sigma,
           int max_iterations) const {
    const int size = static_cast<int>(points_.cols());
    const std::vector<int> samples = drawSamples(size, num_samples, options_.seed);
    // Matches of an approximate symmetry never settle: a fifth of the samples places it as well as it can be placed.
    const std::vector<int> fewer =
        drawSamples(size, std::min(num_samples, options_.num_refine_samples / 5), options_.seed);
    IspOptions isp;
    isp.update = options_.update;
    isp.sigma = sigma;
    isp.final_sigma = final_sigma;
    isp.max_iterations = max_iterations;
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      Candidate& candidate = candidates[i];
      const bool settles = candidate.iterations == 0 || candidate.support >= options_.min_support - kCloseSlack;
      const std::vector<int>& used = settles ? samples : fewer;
      IspOptions own = isp;
      if (settles && options_.update == IspUpdate::PointToPlane) own.error_share = kSettledErrorShare;
      candidate.last = refineSymmetricPoints(surface_, used, candidate.plane, own);
      candidate.plane = candidate.last.plane;
      candidate.iterations += candidate.last.iterations;
      candidate.support =
          mean(pointSupport(candidate.last.last.closest, candidate.last.last.sq_distances, geometry_.spacing));
    });
  }

  /// The best of each group of like planes, best first, without those that cannot reach the support asked for.
  std::vector<Candidate> distinct(std::vector<Candidate> candidates, double slack) const {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.support > b.support; });
    std::vector<Candidate> kept;
    for (Candidate& candidate : candidates) {
      if (!options_.approximate && candidate.support < options_.min_support - slack) break;
      const bool known = std::any_of(kept.begin(), kept.end(),
                                     [&](const Candidate& other) { return same(other.plane, candidate.plane); });
      if (!known) kept.push_back(std::move(candidate));
    }
    return kept;
  }

  const GaussianEdt& edt_;
  const DetectionOptions& options_;
  NormalizedFrame frame_;
  Points points_;
  ClosestPointSearch::Ptr search_;
  LocalGeometry geometry_;
  IspSurface surface_;
  double sigma_;
  double final_sigma_;
};

}  // namespace

Detection refineMaxima(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                       const DetectionOptions& options, ClosestPointSearch::Ptr search) {
  options.validate();
  Stopwatch watch;
  Detection detection;
  const auto timed = [&](const char* stage) { detection.timing_ms.emplace_back(stage, watch.lap()); };
  const Refinement refinement(points, edt, options, std::move(search));
  timed("surface");
  std::vector<Candidate> candidates = refinement.gather(map);
  timed("maxima");
  refinement.refineCoarsely(map, candidates);
  timed("coarse_refinement");
  refinement.refineClosely(candidates);
  timed("close_refinement");
  std::vector<SymmetryPlane> planes = refinement.finish(candidates);
  timed("full_refinement");
  while (!(candidates = refinement.closure(planes)).empty()) {
    refinement.refineClosely(candidates);
    std::vector<SymmetryPlane> found = refinement.finish(candidates);
    if (found.empty()) break;
    std::move(found.begin(), found.end(), std::back_inserter(planes));
  }
  detection.planes = refinement.report(std::move(planes));
  timed("closure");
  return detection;
}

}  // namespace pcl_symmetry
