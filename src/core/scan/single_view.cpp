#include "core/scan/single_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/constants.h"
#include "core/base/statistics.h"
#include "core/geometry/surface_normals.h"
#include "core/scan/scan_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

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

/// Median distance of neighbors from the tangent planes at every \p stride-th point.
double typicalRoughness(const Points& surface, Eigen::Index stride) {
  return median(localGeometryAt(surface, *makeFlannSearch(surface), everyNth(surface, stride)).roughness);
}

}  // namespace

double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  if (points.cols() < 2) return 0.0;
  const BoundingBall ball = boundingBall(points);
  const double distance = (ball.center - viewpoint).norm();
  if (!(ball.radius > 0.0) || !(distance > 0.0)) return 0.0;
  const Eigen::Index stride = 1 + (points.cols() - 1) / kScan.max_layer_samples;
  const double min_gap =
      kScan.roughnesses * typicalRoughness(normalizePoints(points, ball.center, ball.radius), stride);

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
    num_layered += along > std::max(kScan.steepest * across, min_gap) ? 1 : 0;
  }
  return static_cast<double>(num_layered) / static_cast<double>(num_samples);
}

std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        const SingleViewLimits& limits) {
  const BoundingBall ball = boundingBall(points);
  if (!((viewpoint - ball.center).norm() > ball.radius)) return std::nullopt;
  std::optional<Visibility> visibility = Visibility::fromPoints(points, viewpoint);
  if (!visibility) return std::nullopt;
  // The surface slants by as much as in layeredShare(), over half of a pixel.
  const double pixel = 2.0 / std::max(visibility->width(), visibility->height());
  const double margin = std::max(kScan.hidden_margin, 0.5 * kScan.steepest * pixel) * ball.radius;
  if (visibility->hiddenShare(points, margin) > limits.max_hidden) return std::nullopt;
  if (layeredShare(points, viewpoint) > limits.max_layered) return std::nullopt;
  return visibility;
}

std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  return spaceSeenFrom(points, viewpoint, SingleViewLimits{kScan.max_hidden, kScan.max_layered});
}

std::optional<Visibility> sceneSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        std::size_t max_pixels) {
  const double radius = boundingBall(points).radius;
  if (!(radius > 0.0)) return std::nullopt;
  std::optional<Visibility> visibility = Visibility::ofScene(points, viewpoint, max_pixels);
  if (!visibility || visibility->hiddenShare(points, kScan.hidden_margin * radius) > kScan.max_hidden)
    return std::nullopt;
  if (layeredShare(points, viewpoint) > kScan.max_layered) return std::nullopt;
  return visibility;
}

double cutShare(const PointsRef& points, const Visibility& seen, double margin) {
  const Eigen::Vector3d viewpoint = seen.viewpoint();
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) forward += (points.col(i).cast<double>() - viewpoint).normalized();
  forward.normalize();
  const Eigen::Vector3d u = forward.unitOrthogonal(), v = forward.cross(u);
  std::array<Eigen::Vector3d, 72> outermost;  // every 5 degrees; displacements in the picture
  outermost.fill(Eigen::Vector3d::Zero());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = points.col(i).cast<double>() - viewpoint, aside = ray / ray.dot(forward) - forward;
    const double turned = std::atan2(v.dot(aside), u.dot(aside)) / (2.0 * kPi) + 0.5;
    Eigen::Vector3d& most = outermost[static_cast<std::size_t>(turned * 72.0) % 72];
    if (aside.squaredNorm() > most.squaredNorm()) most = aside;
  }
  double count = 0.0, num_cut = 0.0;
  for (const Eigen::Vector3d& aside : outermost) {
    if (aside.isZero()) continue;
    const Eigen::Vector3d beside = viewpoint + forward + (1.0 + margin) * aside;
    count += 1.0;
    num_cut += seen.isInPicture(beside) ? 0.0 : 1.0;
  }
  return num_cut / std::max(1.0, count);
}

bool isSeenEmpty(const Visibility& seen, const Eigen::Vector3d& x, double margin, double rim) {
  const auto isEmpty = [&](const Eigen::Vector3d& at) { return seen.depthBehind(at) < -margin; };
  if (!isEmpty(x)) return false;
  if (rim <= 0.0) return true;
  const Eigen::Vector3d ray = (x - seen.viewpoint()).normalized(), u = ray.unitOrthogonal(), v = ray.cross(u);
  return isEmpty(x + rim * u) && isEmpty(x + rim * v) && isEmpty(x - rim * u) && isEmpty(x - rim * v);
}

}  // namespace pcl_symmetry
