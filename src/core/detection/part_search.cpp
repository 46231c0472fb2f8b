#include "core/detection/part_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/detection/candidates.h"
#include "core/detection/matched_region.h"
#include "core/detection/plane_fit.h"
#include "core/geometry/directions.h"
#include "core/geometry/flann_search.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/principal_axes.h"

namespace pcl_symmetry {

namespace {

// Balls of each radius. chosen: balls of half a radius then cover the unit sphere one and a half times; fewer miss
// small parts, more take longer and find the same parts again.
constexpr int kNumSeeds = 24;
// Starting directions beside the principal axes of a ball. chosen: fewer leave planes out of reach of refinement, more
// take longer and end at the same planes.
constexpr int kNumDirections = 8;
// Radii of the balls, radii of the points. chosen: limbs to halves of a shape; smaller balls hold too few samples.
constexpr double kRadii[] = {0.25, 0.35, 0.5};
// Share of the points of a ball. chosen: less is too few to refine a plane, more is nearly the whole shape.
constexpr double kLeastBall = 0.04, kLargestBall = 0.6;
// Share of the points of a ball that match. chosen: higher values lose planes of parts that share their balls with
// others, lower ones measure more regions in vain.
constexpr double kLeastSupport = 0.7;
// Radii of the ball, from its middle. chosen: beyond half a radius most of the ball lies on one side of the plane.
constexpr double kFarthestPlane = 0.5;
// Planes that are one: radians, and radii of the points. chosen: half of what is between the planes of a prism of 24
// sides.
constexpr PlaneTolerance kSamePlane{0.07, 0.04};
// Share of the points. chosen: a part of less is a detail. derived: a plane that maps 90 % is an approximate symmetry
// of the whole (evidence/README.md).
constexpr double kLeastPart = 0.04, kLargestPart = 0.9;
// Greatest edge of a part, edges of a disc: that of a small part, and by how much more a part of the whole cloud may
// have, as chance matches little of a surface. measured: `shapes.py composites`, 40 clouds of the
// tuning half: 262 of 288 planes and 0.10 wrong ones a cloud; with 0.45 for a small part 269 and 0.22.
constexpr double kLeastEdge = 0.4, kEdgePerShare = 0.5;
// By how much longer the edge may be of a part whose points no better one holds, and share of its points that better
// ones may hold. chosen: the head of the bull (Figure 8) needs 0.10, a disc has at least 0.1 more; half, as a limb has
// many like regions.
constexpr double kLongerEdge = 0.15, kSharedPart = 0.5;
// How much planes of one part have in common of their regions, and how many of them there are at most: those of a cube.
// chosen: parts of more are round or a clutter that every plane maps onto itself, and one plane stands for them; half
// of the region, as regions of planes of one part differ by what matches by chance.
constexpr double kSamePart = 0.5;
constexpr std::size_t kMostPlanesOfPart = 9;
// By how much the edge may be longer than that of a part before each of the two rounds on the region of a plane, edges
// of a disc. measured: of 488 planes of 35 clouds that end as parts, 461 and 476 have no longer edge, of the others 51
// and 27 %. Higher values take longer.
constexpr double kLongestEdgesBefore[] = {1.0, 0.6};
// Iterations of a plane of a part. chosen: as many as of a candidate in its second stage.
constexpr int kIterations = 6;
// Points that refinement reflects, of a ball and of a region. measured: with 400 of a ball as many planes of composites
// are found, in half as much time again; chosen: half of a region makes its planes noisy.
constexpr std::size_t kBallSamples = 200, kRegionSamples = 400;

/// Farthest-point sampling: each seed is the point farthest from those before.
std::vector<Eigen::Vector3f> spreadSeeds(const Points& points) {
  std::vector<Eigen::Vector3f> seeds;
  Eigen::VectorXf sq_distances = Eigen::VectorXf::Constant(points.cols(), std::numeric_limits<float>::infinity());
  for (int next = 0, k = 0; k < kNumSeeds; ++k) {
    seeds.push_back(points.col(next));
    sq_distances = sq_distances.cwiseMin((points.colwise() - seeds.back()).colwise().squaredNorm().transpose());
    sq_distances.maxCoeff(&next);
  }
  return seeds;
}

/// Tells of each point whether it is in a ball.
PCL_SYMMETRY_MULTIVERSION
void markWithin(const float* points, int size, const float* center, double sq_radius, char* inside) {
  const float x = center[0], y = center[1], z = center[2];
  for (int i = 0; i < size; ++i) {
    const float dx = points[3 * i] - x, dy = points[3 * i + 1] - y, dz = points[3 * i + 2] - z;
    inside[i] = dx * dx + (dy * dy + dz * dz) <= sq_radius;
  }
}

/// Indices of the points in a ball.
std::vector<int> within(const Points& points, const Eigen::Vector3f& center, double radius) {
  constexpr int kBlock = 512;  // points. chosen: marks of a block stay in the first cache
  char inside[kBlock];
  std::vector<int> found(static_cast<std::size_t>(points.cols()));
  std::size_t count = 0;
  for (Eigen::Index begin = 0; begin < points.cols(); begin += kBlock) {
    const int size = static_cast<int>(std::min<Eigen::Index>(kBlock, points.cols() - begin));
    markWithin(points.col(begin).data(), size, center.data(), radius * radius, inside);
    for (int i = 0; i < size; ++i) {
      found[count] = static_cast<int>(begin) + i;
      count += inside[i];
    }
  }
  found.resize(count);
  return found;
}

bool isBall(std::size_t count, const Points& points) {
  const auto part = static_cast<double>(count), whole = static_cast<double>(points.cols());
  return part >= kLeastBall * whole && part <= kLargestBall * whole;
}

/// Evenly chosen samples, at most \p most and at least half as many where there are enough.
std::vector<int> thinned(const std::vector<int>& samples, std::size_t most) {
  std::vector<int> some;
  const std::size_t stride = 1 + samples.size() / most;
  for (std::size_t i = 0; i < samples.size(); i += stride) some.push_back(samples[i]);
  return some;
}

/// Planes through the middle of a ball: across the principal axes of its points, and in directions all around.
std::vector<ReflectionPlane> startingPlanes(const Points& ball, const Eigen::Vector3d& middle) {
  std::vector<ReflectionPlane> planes = principalPlanes(principalAxes(ball));
  for (int k = 0; k < kNumDirections; ++k) {
    const Eigen::Vector3d n = spiralDirection(k, kNumDirections, 2.0 * kPi * kGoldenSection * k);
    planes.emplace_back(n, n.dot(middle));
  }
  return planes;
}

/// The search in one ball, the same for all.
struct BallSearch {
  const NormalizedCloud& cloud;
  const PlaneFit& fit;
  const std::unique_ptr<NeighborWalk> walk;  ///< null: the cloud has no lists of neighbors
  /// Planes of balls are matched by walks, as those that are kept are refined again on their regions.
  const IspSurface surface;
  IspOptions isp;

  BallSearch(const NormalizedCloud& the_cloud, const PlaneFit& the_fit, IspUpdate update)
      : cloud(the_cloud),
        fit(the_fit),
        walk(cloud.flann && cloud.flann->lists() ? std::make_unique<NeighborWalk>(*cloud.flann->lists(), *cloud.search)
                                                 : nullptr),
        surface{cloud.points,
                cloud.geometry.normals,
                walk ? *walk : *cloud.search,
                cloud.surface.at_border,
                walk ? nullptr : cloud.surface.far,
                1} {
    isp.update = update;
    isp.sigma = cloud.sigma;
    isp.final_sigma = cloud.final_sigma;
    isp.max_iterations = kIterations;
  }

  /// Refines a plane on the points of a ball, moves the ball to the plane, and refines the plane again.
  /// \return nothing where the ball has too few or too many points, the plane leaves the ball, or little matches.
  std::optional<SymmetricPart> refined(const ReflectionPlane& start, const std::vector<int>& ball,
                                       const Eigen::Vector3d& middle, double radius) const {
    IspResult result = refineSymmetricPoints(surface, thinned(ball, kBallSamples), start, isp);
    // A ball about a point of the plane is cut into equal halves.
    const Eigen::Vector3d center = middle - result.plane.signedDistance(middle) * result.plane.normal();
    const std::vector<int> moved = within(cloud.points, center.cast<float>(), radius);
    if (!isBall(moved.size(), cloud.points)) return std::nullopt;
    const std::vector<int> samples = thinned(moved, kBallSamples);
    IspOptions fine = isp;
    fine.sigma = fine.final_sigma;
    const int num_before = result.iterations;
    result = refineSymmetricPoints(surface, samples, result.plane, fine);
    if (std::abs(result.plane.signedDistance(middle)) > kFarthestPlane * radius) return std::nullopt;
    SymmetricPart part{result.plane, {}, 0.0, 0.0, num_before + result.iterations, 0.0};
    const IspStep step = matchReflectionsOnly(surface, samples, part.plane, cloud.final_sigma, &result.last.closest);
    part.support = fit.relativeSupport(fit.shares(part.plane, samples, step));
    part.share = static_cast<double>(moved.size()) / static_cast<double>(cloud.points.cols());
    if (part.support < kLeastSupport) return std::nullopt;
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
      if (std::optional<SymmetricPart> part = refined(start, ball, middle, radius)) found.push_back(std::move(*part));
    return found;
  }
};

/// The planes that differ from better ones, best first.
std::vector<SymmetricPart> distinct(std::vector<SymmetricPart> parts) {
  std::stable_sort(parts.begin(), parts.end(), [](const SymmetricPart& a, const SymmetricPart& b) {
    return a.support * a.share > b.support * b.share;
  });
  std::vector<SymmetricPart> kept;
  for (SymmetricPart& part : parts)
    if (!kSamePlane.anySame(kept, part.plane, [](const SymmetricPart& other) { return other.plane; }))
      kept.push_back(std::move(part));
  return kept;
}

/// Where refined planes map parts onto themselves.
struct RegionSearch {
  const BallSearch& balls;
  const MatchedRegions regions;

  RegionSearch(const BallSearch& of_balls, const PartSearchOptions& options)
      : balls(of_balls), regions(balls.cloud, balls.fit, options.seed, options.num_threads) {}

  /// By how much the edge of a region is longer than that of a part of its size, edges of a disc.
  static double longerEdge(const MatchedRegion& region) {
    return region.edge - kLeastEdge - kEdgePerShare * region.share;
  }

  /// Moves the plane to the best one on a region.
  void refine(SymmetricPart& part, const MatchedRegion& region, double sigma) const {
    IspOptions isp = balls.isp;
    isp.sigma = sigma;
    const IspResult result =
        refineSymmetricPoints(balls.cloud.surface, thinned(region.points, kRegionSamples), part.plane, isp);
    part.plane = result.plane;
    part.iterations += result.iterations;
  }

  /// The plane on the region that it maps onto itself. The first round moves it by wide weights, as planes of balls lie
  /// some degrees off, the second one by narrow weights. Most planes are refused on the way.
  /// \return nothing where that is no part.
  std::optional<SymmetricPart> onItsRegion(SymmetricPart part) const {
    MatchedRegion region = regions.largest(part.plane);
    int round = 0;
    for (const double sigma : {balls.isp.sigma, balls.isp.final_sigma}) {
      if (region.share < kLeastPart || longerEdge(region) > kLongestEdgesBefore[round++]) return std::nullopt;
      refine(part, region, sigma);
      region = regions.largest(part.plane, &region.closest);
    }
    if (region.share < kLeastPart || region.share > kLargestPart) return std::nullopt;
    part.longer_edge = longerEdge(region);
    if (part.longer_edge > kLongerEdge) return std::nullopt;
    part.points = std::move(region.points);
    part.share = region.share;
    part.support = region.support;
    return part;
  }
};

/// Leaves out parts of long edge where better ones hold their points.
std::vector<SymmetricPart> withoutRemains(std::vector<SymmetricPart> parts, Eigen::Index num_points) {
  std::stable_sort(parts.begin(), parts.end(), [](const SymmetricPart& a, const SymmetricPart& b) {
    return std::max(0.0, a.longer_edge) < std::max(0.0, b.longer_edge);
  });
  std::vector<char> taken(static_cast<std::size_t>(num_points), 0);
  std::vector<SymmetricPart> kept;
  for (SymmetricPart& part : parts) {
    const auto num_taken = std::count_if(part.points.begin(), part.points.end(), [&](int i) { return taken[i] != 0; });
    if (part.longer_edge > 0.0 &&
        static_cast<double>(num_taken) > kSharedPart * static_cast<double>(part.points.size()))
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
  return static_cast<double>(both.size()) > kSamePart * either;
}

/// Leaves one plane of each part that has more planes than a part without axis has.
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
    if (group.size() > kMostPlanesOfPart) group.resize(1);
    std::move(group.begin(), group.end(), std::back_inserter(kept));
  }
  return kept;
}

}  // namespace

std::vector<SymmetricPart> findSymmetricParts(const NormalizedCloud& cloud, const PlaneFit& fit,
                                              const PartSearchOptions& options) {
  const BallSearch search(cloud, fit, options.update);
  const std::vector<Eigen::Vector3f> seeds = spreadSeeds(cloud.points);
  std::vector<std::vector<SymmetricPart>> of_balls(seeds.size() * std::size(kRadii));
  parallelBlocks(of_balls.size(), options.num_threads, [&](std::size_t i) {
    of_balls[i] = search.planes(seeds[i / std::size(kRadii)], kRadii[i % std::size(kRadii)]);
  });
  std::vector<SymmetricPart> planes;
  for (std::vector<SymmetricPart>& found : of_balls) std::move(found.begin(), found.end(), std::back_inserter(planes));
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

std::vector<SymmetryPlane> localPlanes(const std::vector<SymmetryPlane>& known, const NormalizedCloud& cloud,
                                       const PlaneFit& fit, const PlaneJudge& judge, const DetectionOptions& options) {
  std::vector<SymmetryPlane> decided;
  std::copy_if(known.begin(), known.end(), std::back_inserter(decided), isDecided);
  const std::vector<SymmetricPart> parts =
      findSymmetricParts(cloud, fit, {options.expert.update, options.seed, options.num_threads});
  const std::vector<int> all = allOf(cloud.points.cols());
  std::vector<std::optional<SymmetryPlane>> of_parts(parts.size());
  parallelBlocks(parts.size(), options.num_threads, [&](std::size_t i) {
    const auto normalized = [&](const SymmetryPlane& plane) { return cloud.toNormalized(plane); };
    if (basinTolerance().anySame(decided, parts[i].plane, normalized)) return;
    SymmetryPlane plane = judge.decision.decide(judge.measure.of(parts[i].plane, all));
    if (plane.kind == PlaneKind::Symmetry) return;  // one of a family, which is known as its axis or center
    plane.kind = PlaneKind::Local;
    plane.iterations = parts[i].iterations;
    of_parts[i] = std::move(plane);
  });
  std::vector<SymmetryPlane> planes;
  for (std::optional<SymmetryPlane>& plane : of_parts)
    if (plane) planes.push_back(std::move(*plane));
  return planes;
}

}  // namespace pcl_symmetry
