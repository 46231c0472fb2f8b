#include "core/scan/single_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/median.h"
#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

// radii; chosen: more than the depth within a pixel of a slanting surface. Half counts such points as hidden, twice
// misses thicker objects.
constexpr double kHiddenMargin = 0.1;
// share of the points; chosen: between 0.1 for scans (the rim of a sphere) and 0.3 or more for whole objects
constexpr double kMostHidden = 0.18;
// share of the points; chosen: a scan has one layer but at its silhouettes, which a quarter of the points leave room
// for. Of 100 models of the training half of the Princeton Shape Benchmark, 200 of 200 scans of 10 000 and of 1000
// points have less, 99 % of those with noise of 0.5 % of the diagonal, and 6 % of the whole clouds.
constexpr double kMostLayered = 0.25;
// depth over width of one surface; chosen: it slants by up to 76 degrees. Half takes steep surfaces for layers, twice
// misses layers that lie close behind each other.
constexpr double kSteepest = 4.0;
// chosen: two points of one rough surface are hardly farther apart. Half takes noise for layers, twice misses thin
// objects.
constexpr double kRoughnesses = 6.0;
// points; chosen: half makes the share less certain (0.011 at 2000), twice takes twice the time
constexpr Eigen::Index kLargestSample = 2000;

/// Points in the picture seen from a viewpoint: unit vectors to them, less the one to their middle, in units of \p
/// width.
Points picture(const PointsRef& points, const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& middle, double width) {
  const Eigen::Vector3d forward = (middle - viewpoint).normalized();
  Points directions(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    directions.col(i) = (((points.col(i).cast<double>() - viewpoint).normalized() - forward) / width).cast<float>();
  return directions;
}

Points everyNth(const Points& points, Eigen::Index stride) {
  Points chosen(3, (points.cols() + stride - 1) / stride);
  for (Eigen::Index i = 0; i < chosen.cols(); ++i) chosen.col(i) = points.col(i * stride);
  return chosen;
}

/// Median distance of neighbours from the tangent planes at every \p stride-th point.
double typicalRoughness(const Points& surface, Eigen::Index stride) {
  return median(localGeometryAt(surface, *makeFlannSearch(surface), everyNth(surface, stride)).roughness);
}

}  // namespace

double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  if (points.cols() < 2) return 0.0;
  const BoundingBall ball = boundingBall(points);
  const double distance = (ball.center - viewpoint).norm();
  if (!(ball.radius > 0.0) || !(distance > 0.0)) return 0.0;
  const Eigen::Index stride = 1 + (points.cols() - 1) / kLargestSample;
  const double least_gap = kRoughnesses * typicalRoughness(normalizePoints(points, ball.center, ball.radius), stride);

  // The next point of each sample in the picture.
  const double width = ball.radius / distance;
  const Points directions = picture(points, viewpoint, ball.center, width);
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeFlannSearch(directions)->search(everyNth(directions, stride), 2, closest, sq_distances);

  const auto depth = [&](Eigen::Index i) { return (points.col(i).cast<double>() - viewpoint).norm() / ball.radius; };
  std::size_t num_layered = 0;
  const std::size_t num_samples = closest.size() / 2;
  for (std::size_t s = 0; s < num_samples; ++s) {
    const auto i = static_cast<Eigen::Index>(s) * stride;
    const std::size_t other = closest[2 * s] == i ? 2 * s + 1 : 2 * s;
    const double across = std::sqrt(sq_distances[other]) * width * depth(i);
    const double along = std::abs(depth(i) - depth(closest[other]));
    num_layered += along > std::max(kSteepest * across, least_gap) ? 1 : 0;
  }
  return static_cast<double>(num_layered) / static_cast<double>(num_samples);
}

std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        const SingleViewLimits& limits) {
  const BoundingBall ball = boundingBall(points);
  if (!((viewpoint - ball.center).norm() > ball.radius)) return std::nullopt;
  std::optional<Visibility> visibility = Visibility::fromPoints(points, viewpoint);
  if (!visibility) return std::nullopt;
  if (visibility->hiddenShare(points, kHiddenMargin * ball.radius) > limits.most_hidden) return std::nullopt;
  if (layeredShare(points, viewpoint) > limits.most_layered) return std::nullopt;
  return visibility;
}

std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  return spaceSeenFrom(points, viewpoint, SingleViewLimits{kMostHidden, kMostLayered});
}

std::optional<Visibility> sceneSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        std::size_t max_pixels) {
  const double radius = boundingBall(points).radius;
  if (!(radius > 0.0)) return std::nullopt;
  std::optional<Visibility> visibility = Visibility::ofScene(points, viewpoint, max_pixels);
  if (!visibility || visibility->hiddenShare(points, kHiddenMargin * radius) > kMostHidden) return std::nullopt;
  if (layeredShare(points, viewpoint) > kMostLayered) return std::nullopt;
  return visibility;
}

}  // namespace pcl_symmetry
