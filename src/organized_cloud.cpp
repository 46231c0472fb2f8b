#include <pcl/common/projection_matrix.h>
#include <pcl/point_types.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "pcl_symmetry/impl/seen_space.hpp"

namespace pcl_symmetry {

namespace {

constexpr double kLargestError = 0.7;        // pixels, root mean square
constexpr double kLargestSkew = 0.05;        // of the focal length; and difference of the two focal lengths
constexpr std::size_t kFewestPoints = 50;    // that a projection is estimated from
constexpr std::size_t kMostPoints = 20'000;  // more make it no better
constexpr double kSmallHole = 0.01;          // of the picture: a larger one shows that there is nothing

/// Depths without a point: large regions and those at the border are background, small ones are missing measurements.
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

}  // namespace

std::optional<Visibility> seenByOrganizedCloud(const Points& pixels, int width, int height) {
  pcl::Indices finite;
  for (Eigen::Index i = 0; i < pixels.cols(); ++i)
    if (pixels.col(i).allFinite()) finite.push_back(static_cast<pcl::index_t>(i));
  if (finite.size() < kFewestPoints) return std::nullopt;
  const std::size_t stride = 1 + finite.size() / kMostPoints;
  pcl::Indices used;
  for (std::size_t i = 0; i < finite.size(); i += stride) used.push_back(finite[i]);
  Points points(3, static_cast<Eigen::Index>(used.size()));
  for (std::size_t i = 0; i < used.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = pixels.col(used[i]);
  const BoundingBall ball = boundingBall(points);
  if (!(ball.radius > 0.0)) return std::nullopt;

  // The estimate is a matter of the units: it is made of coordinates of about one.
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(width, height);
  const Points normalized = normalizePoints(points, ball.center, ball.radius);
  for (std::size_t i = 0; i < used.size(); ++i)
    (*cloud)[used[i]].getVector3fMap() = normalized.col(static_cast<Eigen::Index>(i));
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> estimate;
  // What it returns is a residual that may be a little below 0: the error in pixels below decides.
  pcl::estimateProjectionMatrix<pcl::PointXYZ>(cloud, estimate, used);
  if (!estimate.allFinite()) return std::nullopt;
  Visibility::Projection projection = estimate.cast<double>();
  const double length = projection.block<1, 3>(2, 0).norm();
  if (!(length > 0.0)) return std::nullopt;
  const Eigen::Vector4d first = normalized.col(0).cast<double>().homogeneous();
  projection *= (projection.row(2).dot(first) < 0.0 ? -1.0 : 1.0) / length;

  double sq_error = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Eigen::Vector3d image =
        projection * Eigen::Vector4d(normalized.col(static_cast<Eigen::Index>(i)).cast<double>().homogeneous());
    if (!(image.z() > 0.0)) return std::nullopt;
    const Eigen::Vector2d pixel(used[i] % width, used[i] / width);
    sq_error += (image.head<2>() / image.z() - pixel).squaredNorm();
  }
  if (!(sq_error <= kLargestError * kLargestError * static_cast<double>(used.size()))) return std::nullopt;
  // A flat cloud fits cameras that do not exist: ours has square pixels.
  const Eigen::Vector3d across = projection.block<1, 3>(0, 0), down = projection.block<1, 3>(1, 0),
                        forward = projection.block<1, 3>(2, 0);
  const Eigen::Vector3d x = across - across.dot(forward) * forward, y = down - down.dot(forward) * forward;
  const double focal = std::max(x.norm(), y.norm());
  if (!(std::abs(x.norm() - y.norm()) <= kLargestSkew * focal && std::abs(x.dot(y)) <= kLargestSkew * focal * focal))
    return std::nullopt;

  // Back to the input frame, depths in its units.
  projection.col(3) = projection.col(3) * ball.radius - projection.leftCols<3>() * ball.center;
  std::vector<float> depths(pixels.cols(), std::numeric_limits<float>::quiet_NaN());
  for (const pcl::index_t i : finite)
    depths[i] = static_cast<float>(projection.row(2).dot(Eigen::Vector4d(pixels.col(i).cast<double>().homogeneous())));
  fillEmptyPixels(width, height, depths);
  return Visibility(projection, width, height, std::move(depths));
}

}  // namespace pcl_symmetry
