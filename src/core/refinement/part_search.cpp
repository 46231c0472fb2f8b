#include "core/refinement/part_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/geometry/directions.h"
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
// Share of the points. chosen: less is too few to judge, more is nearly the whole shape.
constexpr double kLeastPart = 0.04, kLargestPart = 0.6;
// Share of the points of a part. chosen: lower values report parts that only resemble their reflection.
constexpr double kLeastSupport = 0.8;
// Radii of the ball, from its middle. chosen: beyond half a radius most of the ball lies on one side of the plane.
constexpr double kFarthestPlane = 0.5;
// Share of a part that better parts may hold. chosen: a limb has many like balls; smaller values lose neighbouring
// parts, larger ones report a part twice.
constexpr double kSharedPart = 0.5;
// Points of a ball that refinement reflects. chosen: at half, planes of small parts are noisy; at twice, as good as now
// and slower.
constexpr std::size_t kNumSamples = 400;

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

/// Indices of the points in a ball.
std::vector<int> within(const Points& points, const Eigen::Vector3f& center, double radius) {
  std::vector<int> inside;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if ((points.col(i) - center).squaredNorm() <= radius * radius) inside.push_back(static_cast<int>(i));
  return inside;
}

bool isPart(std::size_t count, const Points& points) {
  const auto part = static_cast<double>(count), whole = static_cast<double>(points.cols());
  return part >= kLeastPart * whole && part <= kLargestPart * whole;
}

/// Evenly chosen samples, at most kNumSamples and at least half as many where there are enough.
std::vector<int> thinned(const std::vector<int>& samples) {
  std::vector<int> some;
  const std::size_t stride = 1 + samples.size() / kNumSamples;
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
  const IspSurface& surface;
  const IspOptions& refinement;
  const SupportOfSamples& support;

  /// Refines a plane on the points of a ball, moves the ball to the plane, and refines the plane again.
  /// \return nothing where the ball holds no part, or the plane leaves the ball.
  std::optional<SymmetricPart> refined(const ReflectionPlane& start, const std::vector<int>& ball,
                                       const Eigen::Vector3d& middle, double radius) const {
    IspResult result = refineSymmetricPoints(surface, thinned(ball), start, refinement);
    // A ball about a point of the plane is cut into equal halves.
    const Eigen::Vector3d center = middle - result.plane.signedDistance(middle) * result.plane.normal();
    std::vector<int> moved = within(surface.points, center.cast<float>(), radius);
    if (!isPart(moved.size(), surface.points)) return std::nullopt;
    const std::vector<int> samples = thinned(moved);
    IspOptions fine = refinement;
    fine.sigma = fine.final_sigma;
    result = refineSymmetricPoints(surface, samples, result.plane, fine);
    if (std::abs(result.plane.signedDistance(middle)) > kFarthestPlane * radius) return std::nullopt;
    return SymmetricPart{result.plane, std::move(moved), support(result.plane, samples), result.iterations};
  }

  /// The best part about a seed.
  std::optional<SymmetricPart> bestOf(const Eigen::Vector3f& seed, double radius) const {
    const Points& points = surface.points;
    const Eigen::Vector3d middle = centerOfMass(pointsAt(points, within(points, seed, radius)));
    const std::vector<int> ball = within(points, middle.cast<float>(), radius);
    std::optional<SymmetricPart> best;
    if (!isPart(ball.size(), points)) return best;
    for (const ReflectionPlane& start : startingPlanes(pointsAt(points, ball), middle)) {
      std::optional<SymmetricPart> part = refined(start, ball, middle, radius);
      if (part && part->support >= kLeastSupport && (!best || part->support > best->support)) best = std::move(part);
    }
    return best;
  }
};

/// The parts that share little with better ones, best first.
std::vector<SymmetricPart> withoutOverlap(std::vector<SymmetricPart> parts, Eigen::Index num_points) {
  std::stable_sort(parts.begin(), parts.end(), [](const SymmetricPart& a, const SymmetricPart& b) {
    return a.support * static_cast<double>(a.points.size()) > b.support * static_cast<double>(b.points.size());
  });
  std::vector<char> taken(static_cast<std::size_t>(num_points), 0);
  std::vector<SymmetricPart> kept;
  for (SymmetricPart& part : parts) {
    const auto num_taken = std::count_if(part.points.begin(), part.points.end(), [&](int i) { return taken[i] != 0; });
    if (static_cast<double>(num_taken) > kSharedPart * static_cast<double>(part.points.size())) continue;
    for (const int i : part.points) taken[i] = 1;
    kept.push_back(std::move(part));
  }
  return kept;
}

}  // namespace

std::vector<SymmetricPart> findSymmetricParts(const IspSurface& surface, const IspOptions& refinement,
                                              const SupportOfSamples& support) {
  const BallSearch search{surface, refinement, support};
  const std::vector<Eigen::Vector3f> seeds = spreadSeeds(surface.points);
  std::vector<std::optional<SymmetricPart>> found(seeds.size() * std::size(kRadii));
  parallelBlocks(found.size(), surface.num_threads, [&](std::size_t i) {
    found[i] = search.bestOf(seeds[i / std::size(kRadii)], kRadii[i % std::size(kRadii)]);
  });
  std::vector<SymmetricPart> parts;
  for (std::optional<SymmetricPart>& part : found)
    if (part) parts.push_back(std::move(*part));
  return withoutOverlap(std::move(parts), surface.points.cols());
}

}  // namespace pcl_symmetry
