#include "core/detection/plane_search.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

/// The edge of a flat disc of n samples, divided by sqrt(n); an edge is the sum over samples of the share of their
/// neighbors beyond it. The k neighbors of a sample lie within rho = sqrt(k / pi) spacings. Beyond a straight edge lies
/// a share of the neighbors that adds up to 2 rho / (3 pi) per spacing of edge, and a disc has an edge of 2 sqrt(pi n)
/// spacings.
double edgeOfDisc() {
  const double reach = std::sqrt((kDetection.parts.num_smoothing + 1) / kPi);
  return 2.0 * reach / (3.0 * kPi) * 2.0 * std::sqrt(kPi);
}

/// A connected piece of the surface that a plane maps onto itself.
struct MatchedRegion {
  std::vector<int> points;  ///< indices of points of the cloud, among the samples of MatchedRegions, ascending
  double share = 0.0;       ///< share of all samples, in [0, 1]
  double support = 0.0;     ///< mean support of its samples, relative to what sampling and noise allow, in [0, 1]
  /// Length of its edge, beyond which the surface continues unmatched, divided by the edge of a flat disc of equal
  /// area.
  double edge = 0.0;
  std::vector<int> closest;  ///< closest point to the reflection of each sample, as in IspStep
};

/// Finds the regions that planes map onto themselves, which Figure 8 shows in white. Not in the paper.
///
/// Every plane matches some part of a surface. A part that is symmetric by itself is matched completely: its region
/// ends with a short edge where the part joins others, or has no edge at all. A chance match, such as a smooth cap
/// about a point of the plane, ends in the middle of the surface, with an edge as long as the edge of a disc.
class MatchedRegions {
public:
  /// \param cloud,fit must outlive this object.
  MatchedRegions(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options)
      : cloud_(cloud),
        fit_(fit),
        samples_(drawSamples(cloud.points.cols(), kDetection.parts.num_region_samples, options.seed)) {
    std::sort(samples_.begin(), samples_.end());
    const Points positions = pointsAt(cloud.points, samples_);
    const ClosestPointSearch::Ptr search = makeFlannSearch(positions);
    std::vector<float> sq_distances;
    const int num_neighbors = std::min<int>(kDetection.parts.num_smoothing + 1, static_cast<int>(samples_.size()));
    search->search(positions, num_neighbors, neighbors_, sq_distances);
    closest_sample_ = closestPoints(*search, cloud.points, options.num_threads).index;
  }

  /// \param plane normalized frame.
  /// \param guesses MatchedRegion::closest of a plane nearby, which makes the search faster; null = not known.
  /// \param walks finds closest points by walking along neighbor lists, which may miss some.
  /// \return the largest region; empty if nothing matches.
  MatchedRegion largest(const ReflectionPlane& plane, const std::vector<int>* guesses = nullptr,
                        bool walks = false) const {
    const IspSurface& surface = walks && !cloud_.isScan() ? cloud_.quick_surface : cloud_.surface;
    IspStep step = matchSymmetricPoints(surface, samples_, plane, cloud_.final_sigma, guesses);
    const std::vector<float> support = fit_.shares(plane, samples_, step).points.support;
    const std::size_t size = samples_.size(), num_neighbors = neighbors_.size() / size;
    std::vector<char> matched(size);
    for (std::size_t i = 0; i < size; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < num_neighbors; ++k) sum += support[neighbors_[i * num_neighbors + k]];
      matched[i] = sum >= kDetection.parts.matched_support * static_cast<double>(num_neighbors);
    }
    const std::vector<char> inside = inLargest(matched, step, support);
    MatchedRegion region;
    region.closest = std::move(step.closest);
    for (std::size_t i = 0; i < size; ++i) {
      if (!inside[i]) continue;
      region.points.push_back(samples_[i]);
      region.support += support[i];
    }
    if (region.points.empty()) return region;
    const auto count = static_cast<double>(region.points.size());
    region.share = count / static_cast<double>(size);
    region.support = std::min(1.0, region.support / (count * cloud_.baseline));
    region.edge = edgeOf(inside, count);
    return region;
  }

private:
  /// Neighbors that match are in one region, and so are samples and their counterparts: two hands are one region of the
  /// plane between them.
  std::vector<char> inLargest(const std::vector<char>& matched, const IspStep& step,
                              const std::vector<float>& support) const {
    const std::size_t size = samples_.size(), num_neighbors = neighbors_.size() / size;
    std::vector<int> rank(size, 0), parent = allIndices(static_cast<Eigen::Index>(size));
    boost::disjoint_sets<int*, int*> sets(rank.data(), parent.data());
    const std::size_t num_connecting = std::min<std::size_t>(kDetection.parts.num_connecting + 1, num_neighbors);
    for (std::size_t i = 0; i < size; ++i) {
      if (!matched[i]) continue;
      for (std::size_t k = 0; k < num_connecting; ++k) {
        const int j = neighbors_[i * num_neighbors + k];
        if (matched[j]) sets.union_set(static_cast<int>(i), j);
      }
      if (step.closest[i] < 0 || support[i] < kDetection.parts.counterpart) continue;
      const int j = closest_sample_[step.closest[i]];
      if (matched[j]) sets.union_set(static_cast<int>(i), j);
    }
    std::vector<int> count(size, 0);
    for (std::size_t i = 0; i < size; ++i)
      if (matched[i]) ++count[sets.find_set(static_cast<int>(i))];
    const auto largest = static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
    std::vector<char> inside(size, 0);
    for (std::size_t i = 0; i < size; ++i) inside[i] = matched[i] && sets.find_set(static_cast<int>(i)) == largest;
    return inside;
  }

  double edgeOf(const std::vector<char>& inside, double count) const {
    const std::size_t size = samples_.size(), num_neighbors = neighbors_.size() / size;
    std::size_t num_beyond = 0;
    for (std::size_t i = 0; i < size; ++i) {
      if (!inside[i]) continue;
      for (std::size_t k = 0; k < num_neighbors; ++k) num_beyond += inside[neighbors_[i * num_neighbors + k]] ? 0 : 1;
    }
    const double share = static_cast<double>(num_beyond) / static_cast<double>(num_neighbors);
    return share / (std::sqrt(count) * edgeOfDisc());
  }

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  std::vector<int> samples_;         ///< indices of points of the cloud, ascending
  std::vector<int> neighbors_;       ///< neighbors of each sample, as indices of samples, nearest first
  std::vector<int> closest_sample_;  ///< closest sample to each point of the cloud, as an index of a sample
};

/// A part of a surface, and a plane of symmetry of that part.
struct SymmetricPart {
  ReflectionPlane plane;     ///< normalized frame
  std::vector<int> points;   ///< some points of the part, spread over it, as ascending indices
  double share = 0.0;        ///< share of the cloud, in [0, 1]
  double support = 0.0;      ///< mean support of these points, in [0, 1]
  int iterations = 0;        ///< iterations of Iterative Symmetric Points
  double longer_edge = 0.0;  ///< excess of its edge over that of a typical part of its size, in edges of a disc
};

// Limits within which planes of parts count as one, radians and radii of the points: half the angle between the planes
// of a prism of 24 sides.
constexpr MergeTolerance kSamePlaneOfPart{2.0 * kSamePlane.angle, 2.0 * kSamePlane.offset};

/// Farthest-point sampling: each seed is the point farthest from those before.
std::vector<Eigen::Vector3f> spreadSeeds(const Points& points) {
  std::vector<Eigen::Vector3f> seeds;
  Eigen::VectorXf sq_distances = Eigen::VectorXf::Constant(points.cols(), std::numeric_limits<float>::infinity());
  for (int next = 0, k = 0; k < kDetection.parts.num_seeds; ++k) {
    seeds.push_back(points.col(next));
    sq_distances = sq_distances.cwiseMin((points.colwise() - seeds.back()).colwise().squaredNorm().transpose());
    sq_distances.maxCoeff(&next);
  }
  return seeds;
}

/// Indices of the points in a ball.
std::vector<int> within(const Points& points, const Eigen::Vector3f& center, double radius) {
  std::vector<int> found;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if ((points.col(i) - center).squaredNorm() <= radius * radius) found.push_back(static_cast<int>(i));
  return found;
}

bool isBall(std::size_t count, const Points& points) {
  const auto part = static_cast<double>(count), whole = static_cast<double>(points.cols());
  return part >= kDetection.parts.min_ball * whole && part <= kDetection.parts.largest_ball * whole;
}

/// Evenly chosen samples, at most \p max_count and at least half as many if there are enough.
std::vector<int> thin(const std::vector<int>& samples, std::size_t max_count) {
  std::vector<int> some;
  const std::size_t stride = 1 + samples.size() / max_count;
  for (std::size_t i = 0; i < samples.size(); i += stride) some.push_back(samples[i]);
  return some;
}

/// Planes through the middle of a ball: perpendicular to the principal axes of its points, and in directions all
/// around.
std::vector<ReflectionPlane> startingPlanes(const Points& ball, const Eigen::Vector3d& middle) {
  std::vector<ReflectionPlane> planes = principalPlanes(principalAxes(ball));
  for (int k = 0; k < kDetection.parts.num_directions; ++k) {
    const Eigen::Vector3d n = spiralDirection(k, kDetection.parts.num_directions, 2.0 * kPi * kGoldenSection * k);
    planes.emplace_back(n, n.dot(middle));
  }
  return planes;
}

/// The search in one ball, the same for all.
struct BallSearch {
  const NormalizedCloud& cloud;
  const PlaneFit& fit;
  /// Planes of balls are matched by walks, because the planes that are kept are refined again on their regions.
  const IspSurface surface;
  IspOptions isp;

  BallSearch(const NormalizedCloud& the_cloud, const PlaneFit& the_fit)
      : cloud(the_cloud),
        fit(the_fit),
        surface{cloud.points,
                cloud.geometry.normals,
                cloud.quick_surface.search,
                cloud.surface.at_border,
                cloud.walk ? nullptr : cloud.surface.far,
                1} {
    isp.sigma = cloud.sigma;
    isp.final_sigma = cloud.final_sigma;
    isp.max_iterations = kDetection.parts.iterations;
  }

  /// Refines a plane on the points of a ball, moves the ball to the plane, and refines the plane again.
  /// \return nothing if the ball has too few or too many points, the plane leaves the ball, or too little matches.
  std::optional<SymmetricPart> refinePart(const ReflectionPlane& start, const std::vector<int>& ball,
                                          const Eigen::Vector3d& middle, double radius) const {
    IspResult result = refineSymmetricPoints(surface, thin(ball, kDetection.parts.ball_samples), start, isp);
    // A plane through its center cuts a ball into equal halves.
    const Eigen::Vector3d center = middle - result.plane.signedDistance(middle) * result.plane.normal();
    const std::vector<int> moved = within(cloud.points, center.cast<float>(), radius);
    if (!isBall(moved.size(), cloud.points)) return std::nullopt;
    const std::vector<int> samples = thin(moved, kDetection.parts.ball_samples);
    IspOptions fine = isp;
    fine.sigma = fine.final_sigma;
    const int num_before = result.iterations;
    result = refineSymmetricPoints(surface, samples, result.plane, fine);
    if (std::abs(result.plane.signedDistance(middle)) > kDetection.parts.farthest_plane * radius) return std::nullopt;
    SymmetricPart part{result.plane, {}, 0.0, 0.0, num_before + result.iterations, 0.0};
    const IspStep step = matchSymmetricPoints(surface, samples, part.plane, cloud.final_sigma, &result.last.closest);
    part.support = fit.relativeSupport(fit.shares(part.plane, samples, step));
    part.share = static_cast<double>(moved.size()) / static_cast<double>(cloud.points.cols());
    if (part.support < kDetection.parts.min_support) return std::nullopt;
    return part;
  }

  /// Planes of the ball about a seed.
  std::vector<SymmetricPart> planes(const Eigen::Vector3f& seed, double radius) const {
    const Points& points = cloud.points;
    const Eigen::Vector3d middle = centerOfMass(pointsAt(points, within(points, seed, radius)));
    const std::vector<int> ball = within(points, middle.cast<float>(), radius);
    std::vector<SymmetricPart> found;
    if (!isBall(ball.size(), points)) return found;
    for (const ReflectionPlane& start : startingPlanes(pointsAt(points, ball), middle))
      if (std::optional<SymmetricPart> part = refinePart(start, ball, middle, radius))
        found.push_back(std::move(*part));
    return found;
  }
};

/// The planes that differ from better ones, best first.
std::vector<SymmetricPart> distinct(std::vector<SymmetricPart> parts) {
  sortDescending(parts, [](const SymmetricPart& part) { return part.support * part.share; });
  return kSamePlaneOfPart.distinct(std::move(parts), &SymmetricPart::plane);
}

/// Where refined planes map parts onto themselves.
struct RegionSearch {
  const BallSearch& balls;
  const MatchedRegions regions;

  RegionSearch(const BallSearch& of_balls, const DetectionOptions& options)
      : balls(of_balls), regions(balls.cloud, balls.fit, options) {}

  /// Excess of the edge of a region over that of a typical part of its size, in edges of a disc.
  static double longerEdge(const MatchedRegion& region) {
    return region.edge - kDetection.parts.min_edge - kDetection.parts.edge_per_share * region.share;
  }

  /// Moves the plane to the best one on a region.
  void refine(SymmetricPart& part, const MatchedRegion& region, double sigma) const {
    IspOptions isp = balls.isp;
    isp.sigma = sigma;
    const IspResult result = refineSymmetricPoints(
        balls.cloud.surface, thin(region.points, kDetection.parts.region_samples), part.plane, isp);
    part.plane = result.plane;
    part.iterations += result.iterations;
  }

  /// The plane on the region that it maps onto itself. The first round uses wide weights, because planes of balls are
  /// some degrees off, the second one narrow weights. Most planes are rejected on the way.
  /// \return nothing if the region is not a part.
  std::optional<SymmetricPart> onItsRegion(SymmetricPart part) const {
    MatchedRegion region = regions.largest(part.plane, nullptr, true);
    int round = 0;
    for (const double sigma : {balls.isp.sigma, balls.isp.final_sigma}) {
      if (region.share < kDetection.parts.min_part ||
          longerEdge(region) > kDetection.parts.longest_edges_before[round++])
        return std::nullopt;
      refine(part, region, sigma);
      region = regions.largest(part.plane, &region.closest, round == 1);  // the last region is found exactly
    }
    if (region.share < kDetection.parts.min_part || region.share > kDetection.parts.largest_part) return std::nullopt;
    part.longer_edge = longerEdge(region);
    if (part.longer_edge > kDetection.parts.longer_edge) return std::nullopt;
    part.points = std::move(region.points);
    part.share = region.share;
    part.support = region.support;
    return part;
  }
};

/// Removes parts with a long edge whose points belong to better parts.
std::vector<SymmetricPart> withoutRemains(std::vector<SymmetricPart> parts, Eigen::Index num_points) {
  sortAscending(parts, [](const SymmetricPart& part) { return std::max(0.0, part.longer_edge); });
  std::vector<char> taken(num_points, 0);
  std::vector<SymmetricPart> kept;
  for (SymmetricPart& part : parts) {
    const auto num_taken = std::count_if(part.points.begin(), part.points.end(), [&](int i) { return taken[i] != 0; });
    if (part.longer_edge > 0.0 &&
        static_cast<double>(num_taken) > kDetection.parts.shared_part * static_cast<double>(part.points.size()))
      continue;
    for (const int i : part.points) taken[i] = 1;
    kept.push_back(std::move(part));
  }
  return kept;
}

/// \pre ascending points.
bool isSamePart(const SymmetricPart& a, const SymmetricPart& b) {
  std::vector<int> both;
  std::set_intersection(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), std::back_inserter(both));
  const auto either = static_cast<double>(a.points.size() + b.points.size() - both.size());
  return static_cast<double>(both.size()) > kDetection.parts.same_part * either;
}

/// Keeps one plane of each part that has more planes than a part without an axis can have.
std::vector<SymmetricPart> withoutFamilies(std::vector<SymmetricPart> parts) {
  std::vector<std::vector<SymmetricPart>> groups;
  for (SymmetricPart& part : parts) {
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return isSamePart(group.front(), part); });
    if (same == groups.end())
      groups.push_back({std::move(part)});
    else
      same->push_back(std::move(part));
  }
  std::vector<SymmetricPart> kept;
  for (std::vector<SymmetricPart>& group : groups) {
    if (group.size() > kDetection.parts.max_planes_of_part) group.resize(1);
    append(kept, std::move(group));
  }
  return kept;
}

/// \return large and well supported parts first; no two with the same plane.
std::vector<SymmetricPart> findSymmetricParts(const NormalizedCloud& cloud, const PlaneFit& fit,
                                              const DetectionOptions& options) {
  const BallSearch search(cloud, fit);
  const std::vector<Eigen::Vector3f> seeds = spreadSeeds(cloud.points);
  std::vector<std::vector<SymmetricPart>> of_balls(seeds.size() * kDetection.parts.radii.size());
  parallelBlocks(of_balls.size(), options.num_threads, [&](std::size_t i) {
    of_balls[i] = search.planes(seeds[i / kDetection.parts.radii.size()],
                                kDetection.parts.radii[i % kDetection.parts.radii.size()]);
  });
  std::vector<SymmetricPart> planes;
  for (std::vector<SymmetricPart>& found : of_balls) append(planes, std::move(found));
  planes = distinct(std::move(planes));

  const RegionSearch regions(search, options);
  std::vector<std::optional<SymmetricPart>> on_regions(planes.size());
  parallelBlocks(planes.size(), options.num_threads,
                 [&](std::size_t i) { on_regions[i] = regions.onItsRegion(planes[i]); });
  std::vector<SymmetricPart> parts;
  for (std::optional<SymmetricPart>& part : on_regions)
    if (part) parts.push_back(std::move(*part));
  return withoutFamilies(distinct(withoutRemains(std::move(parts), cloud.points.cols())));
}

}  // namespace

void findPlanesOfParts(const PlaneSearch& search, DetectionState& state) {
  const NormalizedCloud& cloud = search.cloud;
  if (!search.options.approximate) return;
  const std::vector<ReflectionPlane> decided =
      planesOf(state.answer.planes, {PlaneKind::Symmetry, PlaneKind::Possible}, cloud);
  const std::vector<SymmetricPart> parts = findSymmetricParts(cloud, search.fit, search.options);
  const std::vector<int> all = allIndices(cloud.points.cols());
  std::vector<std::optional<SymmetryPlane>> of_parts(parts.size());
  parallelBlocks(parts.size(), search.options.num_threads, [&](std::size_t i) {
    if (kSameMaximum.anySame(decided, parts[i].plane)) return;
    SymmetryPlane plane = search.judge(parts[i].plane, all).plane;
    if (plane.kind == PlaneKind::Symmetry) return;  // a plane of a family, which is reported as an axis or a center
    plane.kind = PlaneKind::Local;
    plane.iterations = parts[i].iterations;
    of_parts[i] = std::move(plane);
  });
  for (std::optional<SymmetryPlane>& plane : of_parts)
    if (plane) state.answer.planes.push_back(std::move(*plane));
}

}  // namespace pcl_symmetry
