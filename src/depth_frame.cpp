#include <pcl/common/point_tests.h>
#include <pcl/common/projection_matrix.h>
#include <pcl/point_types.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/statistics.h"
#include "core/scan/depth_filter.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();  // the depth of a pixel without a point
constexpr int kFilterRadius = 2;  // half the side of the filter's window, pixels; 1 leaves a third of the noise

/// Angle between the rays of neighboring pixels; 0 where there are none.
double pixelAngle(const Cloud& frame, const Eigen::Vector3d& viewpoint) {
  std::vector<double> angles;
  const auto ray = [&](std::size_t i) -> Eigen::Vector3d {
    return (frame[i].getVector3fMap().cast<double>() - viewpoint).normalized();
  };
  for (std::size_t i = 0; i + 1 < frame.size(); ++i) {
    if ((i + 1) % frame.width == 0 || !pcl::isXYZFinite(frame[i]) || !pcl::isXYZFinite(frame[i + 1])) continue;
    angles.push_back(ray(i).cross(ray(i + 1)).norm());
  }
  return angles.empty() ? 0.0 : median(std::move(angles));
}

}  // namespace

Cloud::ConstPtr withoutDepthErrors(const Cloud::ConstPtr& frame, const SeenSpace& seen, int num_threads) {
  const Visibility* visibility = seen.visibility();
  if (!frame || seen.source() != ViewpointSource::Rays || visibility->width() != static_cast<int>(frame->width) ||
      visibility->height() != static_cast<int>(frame->height))
    return frame;
  const Eigen::Vector3d viewpoint = visibility->viewpoint();
  DepthImage image{visibility->width(), visibility->height(), std::vector<float>(frame->size(), kNoDepth),
                   pixelAngle(*frame, viewpoint)};
  for (std::size_t i = 0; i < frame->size(); ++i)
    if (pcl::isXYZFinite((*frame)[i]))
      image.depths[i] = visibility->depth(static_cast<int>(i % frame->width), static_cast<int>(i / frame->width));
  const FilteredDepths filtered = filterDepths(image, kFilterRadius, num_threads);
  if (!(filtered.inverse_error > 0.0)) return frame;
  auto result = pcl::make_shared<Cloud>(*frame);
  for (std::size_t i = 0; i < result->size(); ++i) {
    const double factor = static_cast<double>(filtered.depths[i]) / image.depths[i];
    const Eigen::Vector3d point = viewpoint + factor * ((*frame)[i].getVector3fMap().cast<double>() - viewpoint);
    (*result)[i].getVector3fMap() = point.cast<float>();
  }
  result->is_dense = false;
  return result;
}

namespace detail {

namespace {

// Greatest root mean square error, pixels; with more, rows and columns are not those of an image.
constexpr double kLargestError = 0.7;
constexpr double kLargestSkew =
    0.05;  // share of the focal length, also between the two: cameras that fit a flat cloud have no square pixels
// Least number of points; fewer leave the 11 parameters of a projection to noise.
constexpr std::size_t kFewestPoints = 50;
constexpr std::size_t kMaxPoints = 20'000;  // greatest number of points that determine the 11 parameters
// Share of the image; smaller regions without points are missing measurements, not background.
constexpr double kSmallHole = 0.01;

/// Fills the pixels without a point: large regions and regions at the border become background, small regions are
/// missing measurements.
void fillEmptyPixels(int width, int height, std::vector<float>& depths) {
  const std::size_t size = depths.size();
  std::vector<char> visited(size, 0);
  std::vector<std::size_t> region;
  for (std::size_t start = 0; start < size; ++start) {
    if (visited[start] || !std::isnan(depths[start])) continue;
    region.assign(1, start);
    visited[start] = 1;
    bool at_border = false;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const std::size_t at = region[next];
      const int u = static_cast<int>(at % width), v = static_cast<int>(at / width);
      at_border |= u == 0 || v == 0 || u + 1 == width || v + 1 == height;
      const auto visit = [&](bool inside, std::size_t to) {
        if (!inside || visited[to] || !std::isnan(depths[to])) return;
        visited[to] = 1;
        region.push_back(to);
      };
      visit(u > 0, at - 1);
      visit(u + 1 < width, at + 1);
      visit(v > 0, at - width);
      visit(v + 1 < height, at + width);
    }
    const bool background = at_border || static_cast<double>(region.size()) > kSmallHole * static_cast<double>(size);
    for (const std::size_t at : region) depths[at] = background ? Visibility::kBackground : Visibility::kNoRay;
  }
}

/// The camera at the origin that looks along z, as for depth cameras: the points of one plane determine no other.
/// \param normalized the points used, (x - ball.center) / ball.radius.
/// \return projection of the normalized points; nothing if one lies behind the camera.
std::optional<Visibility::Projection> cameraAtOrigin(const Points& normalized, const BoundingBall& ball,
                                                     const std::vector<Eigen::Vector2d>& pixels) {
  Eigen::Matrix2d squares[2] = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  Eigen::Vector2d sums[2] = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  const Eigen::Vector3d center = ball.center / ball.radius;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector3d x = normalized.col(i).cast<double>() + center;
    if (!(x.z() > 0.0)) return std::nullopt;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d row(x[k] / x.z(), 1.0);
      squares[k] += row * row.transpose();
      sums[k] += pixels[i][k] * row;
    }
  }
  Visibility::Projection projection = Visibility::Projection::Identity();
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d line = squares[k].ldlt().solve(sums[k]);
    projection(k, k) = line[0];
    projection(k, 2) = line[1];
  }
  projection.col(3) = projection.leftCols<3>() * center;
  return projection;
}

/// Any camera, with 11 parameters.
std::optional<Visibility::Projection> anyCamera(const Points& normalized, const Cloud& frame,
                                                const pcl::Indices& used) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(frame.width, frame.height);
  for (std::size_t i = 0; i < used.size(); ++i) (*cloud)[used[i]].getVector3fMap() = normalized.col(i);
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> estimate;
  // The residual that it returns may be slightly negative; the error in pixels decides.
  pcl::estimateProjectionMatrix<pcl::PointXYZ>(cloud, estimate, used);
  const double length = estimate.block<1, 3>(2, 0).cast<double>().norm();
  if (!estimate.allFinite() || !(length > 0.0)) return std::nullopt;
  Visibility::Projection projection = estimate.cast<double>();
  const Eigen::Vector4d first = normalized.col(0).cast<double>().homogeneous();
  projection *= (projection.row(2).dot(first) < 0.0 ? -1.0 : 1.0) / length;
  return projection;
}

/// \return the focal length in pixels of a camera with square pixels that maps the points to their pixels; 0 for any
/// other camera, which a flat cloud may fit.
double focalLength(const Visibility::Projection& projection, const Points& normalized,
                   const std::vector<Eigen::Vector2d>& pixels) {
  double sq_error = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector3d image = projection * Eigen::Vector4d(normalized.col(i).cast<double>().homogeneous());
    if (!(image.z() > 0.0)) return 0.0;
    sq_error += (image.head<2>() / image.z() - pixels[i]).squaredNorm();
  }
  if (!(sq_error <= kLargestError * kLargestError * static_cast<double>(pixels.size()))) return 0.0;
  const Eigen::Vector3d across = projection.block<1, 3>(0, 0), down = projection.block<1, 3>(1, 0),
                        forward = projection.block<1, 3>(2, 0);
  const Eigen::Vector3d x = across - across.dot(forward) * forward, y = down - down.dot(forward) * forward;
  const double focal = std::max(x.norm(), y.norm());
  const bool is_square =
      std::abs(x.norm() - y.norm()) <= kLargestSkew * focal && std::abs(x.dot(y)) <= kLargestSkew * focal * focal;
  return is_square ? focal : 0.0;
}

}  // namespace

std::optional<Visibility> seenByOrganizedCloud(const Cloud& frame) {
  const auto width = static_cast<int>(frame.width), height = static_cast<int>(frame.height);
  const pcl::Indices finite = selectPoints(frame, nullptr, frame.size(), 0).indices;
  if (finite.size() < kFewestPoints) return std::nullopt;
  const std::size_t stride = 1 + finite.size() / kMaxPoints;
  pcl::Indices used;
  std::vector<Eigen::Vector2d> pixels;
  for (std::size_t i = 0; i < finite.size(); i += stride) {
    used.push_back(finite[i]);
    pixels.emplace_back(finite[i] % width, finite[i] / width);
  }
  const Points points = selectPoints(frame, &used, used.size(), 0).points;
  const BoundingBall ball = boundingBall(points);
  if (!(ball.radius > 0.0)) return std::nullopt;

  // The estimate depends on the units: it is computed from coordinates near 1.
  const Points normalized = normalizePoints(points, ball.center, ball.radius);
  std::optional<Visibility::Projection> camera = anyCamera(normalized, frame, used);
  double focal = camera ? focalLength(*camera, normalized, pixels) : 0.0;
  if (focal == 0.0) {
    camera = cameraAtOrigin(normalized, ball, pixels);
    focal = camera ? focalLength(*camera, normalized, pixels) : 0.0;
  }
  if (focal == 0.0) return std::nullopt;
  Visibility::Projection projection = *camera;

  // Back to the input frame; depths are in input units.
  projection.col(3) = projection.col(3) * ball.radius - projection.leftCols<3>() * ball.center;
  std::vector<float> depths(frame.size(), kNoDepth);
  for (const pcl::index_t i : finite)
    depths[i] = static_cast<float>(
        projection.row(2).dot(Eigen::Vector4d(frame[i].getVector3fMap().cast<double>().homogeneous())));
  const DepthImage image{width, height, depths, 1.0 / focal};
  fillEmptyPixels(width, height, depths);
  return Visibility(projection, width, height, std::move(depths)).withDepthErrors(sensorError(image));
}

DepthFrame depthFrame(const Cloud::ConstPtr& cloud, int num_threads) {
  std::optional<Visibility> seen = seenByOrganizedCloud(*cloud);
  if (!seen) return {};
  DepthFrame frame{nullptr, {std::move(*seen), ViewpointSource::Rays}};
  const Cloud::ConstPtr filtered = withoutDepthErrors(cloud, frame.seen, num_threads);
  if (filtered != cloud) frame = {filtered, SeenSpace(*filtered)};
  return frame;
}

}  // namespace detail

}  // namespace pcl_symmetry
