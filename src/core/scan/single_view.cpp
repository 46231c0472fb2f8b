#include "core/scan/single_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/neighbours/surface_normals.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

constexpr double kHiddenMargin = 0.1;  // radii: more than the depth of a pixel of a slanting surface
constexpr double kMostHidden = 0.18;   // a pixel of a sphere's rim is deep: 0.1; from elsewhere it is 0.3 and more
// Calibrated on 100 models of the training half of the Princeton Shape Benchmark: accepts 200 of 200 scans of 10 000
// and of 1000 points, 99 % with noise of 0.5 % of the diagonal, and 6 % of whole clouds.
constexpr double kMostLayered = 0.25;
constexpr double kSteepest = 4.0;     // of one surface, depth over width: it slants by 76 degrees
constexpr double kRoughnesses = 6.0;  // two points of one rough surface are hardly farther apart
constexpr Eigen::Index kLargestSample = 2000;

/// The picture as seen from the viewpoint: unit vectors to the points less the one to their middle, in \p widths.
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

}  // namespace

double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  if (points.cols() < 2) return 0.0;
  const BoundingBall ball = boundingBall(points);
  const double distance = (ball.center - viewpoint).norm();
  if (!(ball.radius > 0.0) || !(distance > 0.0)) return 0.0;
  const Eigen::Index stride = 1 + (points.cols() - 1) / kLargestSample;
  const Points surface = normalizePoints(points, ball.center, ball.radius);
  std::vector<float> roughness = localRoughness(surface, *makeFlannSearch(surface), everyNth(surface, stride));
  std::nth_element(roughness.begin(), roughness.begin() + static_cast<std::ptrdiff_t>(roughness.size() / 2),
                   roughness.end());
  const double least_gap = kRoughnesses * roughness[roughness.size() / 2];

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

std::optional<Visibility> recognizeViewpoint(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  const BoundingBall ball = boundingBall(points);
  if (!((viewpoint - ball.center).norm() > ball.radius)) return std::nullopt;
  std::optional<Visibility> visibility = Visibility::fromPoints(points, viewpoint);
  if (!visibility) return std::nullopt;
  if (visibility->hiddenShare(points, kHiddenMargin * ball.radius) > kMostHidden) return std::nullopt;
  if (layeredShare(points, viewpoint) > kMostLayered) return std::nullopt;
  return visibility;
}

}  // namespace pcl_symmetry
