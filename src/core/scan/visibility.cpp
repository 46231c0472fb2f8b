#include "pcl_symmetry/core/scan/visibility.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/parallel.h"
#include "core/geometry/viewing_frame.h"

namespace pcl_symmetry {

namespace {

const double kLeastCosine = std::cos(75.0 * M_PI / 180.0);
constexpr double kPointsPerPixel = 4.0;  // where a surface faces the viewer half as many: one pixel in seven is empty
constexpr int kLargestSide = 1024;
constexpr int kClosingNeighbours = 5;  // of eight
constexpr int kClosingPasses = 3;
constexpr double kSmallHole = 0.01;  // of the pixels with points

struct Bounds {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
};

/// Fills empty pixels that most neighbours surround, with the depth nearest to the viewer: no claim of free space is
/// made that a point does not bear out.
void closeHoles(std::vector<float>& depths, int width, int height) {
  const std::vector<float> before = depths;
  for (int v = 1; v + 1 < height; ++v) {
    for (int u = 1; u + 1 < width; ++u) {
      const std::size_t at = static_cast<std::size_t>(v) * width + u;
      if (before[at] != Visibility::kBackground) continue;
      int num_filled = 0;
      float nearest = Visibility::kBackground;
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          const float depth = before[at + dv * width + du];
          num_filled += depth != Visibility::kBackground ? 1 : 0;
          nearest = std::min(nearest, depth);
        }
      }
      if (num_filled >= kClosingNeighbours) depths[at] = nearest;
    }
  }
}

/// Gaps between points that are sparse as seen from here do not show that the scanner looked through: small holes are
/// closed whole, with the depth of their nearest border.
void closeGaps(std::vector<float>& depths, int width, int height) {
  const auto is_empty = [&](std::size_t at) { return depths[at] == Visibility::kBackground; };
  const auto num_empty = std::count(depths.begin(), depths.end(), Visibility::kBackground);
  const double largest = kSmallHole * static_cast<double>(depths.size() - static_cast<std::size_t>(num_empty));
  std::vector<char> visited(depths.size(), 0);
  std::vector<std::size_t> region;
  for (std::size_t start = 0; start < depths.size(); ++start) {
    if (visited[start] || !is_empty(start)) continue;
    region.assign(1, start);
    visited[start] = 1;
    float nearest = Visibility::kBackground;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const int u = static_cast<int>(region[next] % width), v = static_cast<int>(region[next] / width);
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          if (u + du < 0 || v + dv < 0 || u + du >= width || v + dv >= height) continue;
          const std::size_t to = static_cast<std::size_t>(v + dv) * width + (u + du);
          if (!is_empty(to)) nearest = std::min(nearest, depths[to]);
          if (visited[to] || !is_empty(to)) continue;
          visited[to] = 1;
          region.push_back(to);
        }
      }
    }
    if (static_cast<double>(region.size()) <= largest)
      for (const std::size_t at : region) depths[at] = nearest;
  }
}

}  // namespace

Visibility::Visibility(const Projection& projection, int width, int height, std::vector<float> depths, float outside)
    : projection_(projection), width_(width), height_(height), depths_(std::move(depths)), outside_(outside) {
  if (width < 1 || height < 1 || depths_.size() != static_cast<std::size_t>(width) * height)
    throw std::invalid_argument("depths: size " + std::to_string(depths_.size()) + ", must be width * height > 0");
}

std::optional<Visibility> Visibility::fromPoints(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  const BoundingBall ball = boundingBall(points);
  const Eigen::Vector3d forward = (ball.center - viewpoint).normalized();
  if (!forward.allFinite() || forward.norm() < 0.5) return std::nullopt;
  const Eigen::Matrix3d R_camera_input = viewingFrame(forward);

  // Coordinates on the plane at depth one.
  std::vector<Eigen::Array2d> places(points.cols());
  Bounds bounds;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = R_camera_input * (points.col(i).cast<double>() - viewpoint);
    if (!(ray.z() > kLeastCosine * ray.norm())) return std::nullopt;
    places[i] = ray.head<2>().array() / ray.z();
    bounds.low = bounds.low.min(places[i]);
    bounds.high = bounds.high.max(places[i]);
  }
  const Eigen::Array2d extent = bounds.high - bounds.low;
  const double longest = extent.maxCoeff();
  double pixel = std::sqrt(std::max(extent.prod(), 1e-6 * longest * longest) / static_cast<double>(points.cols()));
  if (!(pixel > 0.0)) pixel = 1.0;
  int width = 1, height = 1;
  const auto column = [&](const Eigen::Array2d& p) { return static_cast<int>((p.x() - bounds.low.x()) / pixel) + 1; };
  const auto row = [&](const Eigen::Array2d& p) { return static_cast<int>((p.y() - bounds.low.y()) / pixel) + 1; };
  for (int round = 0; round < 4; ++round) {
    pixel = std::max(pixel, longest / (kLargestSide - 4));
    if (!(pixel > 0.0)) pixel = 1.0;
    width = column(bounds.high) + 2;
    height = row(bounds.high) + 2;
    std::vector<char> filled(static_cast<std::size_t>(width) * height, 0);
    for (const Eigen::Array2d& p : places) filled[static_cast<std::size_t>(row(p)) * width + column(p)] = 1;
    const auto num_filled = std::count(filled.begin(), filled.end(), 1);
    const double wanted =
        std::sqrt(kPointsPerPixel * static_cast<double>(num_filled) / static_cast<double>(points.cols()));
    if (round == 3 || (wanted > 0.95 && wanted < 1.05)) break;
    pixel *= wanted;
  }

  std::vector<float> depths(static_cast<std::size_t>(width) * height, kBackground);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    float& depth = depths[static_cast<std::size_t>(row(places[i])) * width + column(places[i])];
    depth = std::min(depth, static_cast<float>(forward.dot(points.col(i).cast<double>() - viewpoint)));
  }
  for (int pass = 0; pass < kClosingPasses; ++pass) closeHoles(depths, width, height);
  closeGaps(depths, width, height);

  Projection projection;
  projection.leftCols<3>() = R_camera_input;
  projection.col(3) = -R_camera_input * viewpoint;
  // Pixel (u, v) holds the places about its integer coordinates.
  Eigen::Matrix3d to_pixels = Eigen::Matrix3d::Identity();
  to_pixels(0, 0) = to_pixels(1, 1) = 1.0 / pixel;
  to_pixels(0, 2) = 0.5 - bounds.low.x() / pixel;
  to_pixels(1, 2) = 0.5 - bounds.low.y() / pixel;
  // Around the picture of an object nothing was met either.
  return Visibility(to_pixels * projection, width, height, std::move(depths), kBackground);
}

double Visibility::depthBehind(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d image = projection_.leftCols<3>() * x + projection_.col(3);
  if (!(image.z() > 0.0)) return std::numeric_limits<double>::infinity();
  const double u = image.x() / image.z() + 0.5, v = image.y() / image.z() + 0.5;
  const bool inside = u >= 0.0 && v >= 0.0 && u < width_ && v < height_;
  return image.z() - static_cast<double>(inside ? depth(static_cast<int>(u), static_cast<int>(v)) : outside_);
}

Eigen::Vector3d Visibility::viewpoint() const {
  return -projection_.leftCols<3>().inverse() * projection_.col(3);
}

double Visibility::hiddenShare(const PointsRef& points, double margin) const {
  std::size_t num_hidden = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    num_hidden += depthBehind(points.col(i).cast<double>()) > margin ? 1 : 0;
  return static_cast<double>(num_hidden) / static_cast<double>(points.cols());
}

Visibility Visibility::normalized(const Eigen::Vector3d& center, double scale) const {
  Visibility result = *this;
  result.projection_.col(3) = (projection_.leftCols<3>() * center + projection_.col(3)) / scale;
  for (float& depth : result.depths_) depth = static_cast<float>(depth / scale);
  return result;
}

}  // namespace pcl_symmetry
