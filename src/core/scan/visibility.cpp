#include "pcl_symmetry/core/scan/visibility.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/constants.h"
#include "core/geometry/viewing_frame.h"

namespace pcl_symmetry {

namespace {

using Places = std::vector<Eigen::Array2d>;  // coordinates of points in the picture plane at depth one

// Rays at more than 75 degrees to the middle make no picture. chosen: a wider cone stretches the picture at its rim by
// 1 / cos^2, a narrower one refuses viewpoints close to the object.
const double kLeastCosine = std::cos(75.0 * kPi / 180.0);
// chosen: a surface that faces the viewer has half the average density, which leaves exp(-2), one pixel in seven, empty
// and can be closed. Half as many leave holes in surfaces, twice as many blur the silhouette.
constexpr double kPointsPerPixel = 4.0;
// pixels; chosen: bounds a picture to 4 MB. Half of it blurs clouds of more than a million points, twice needs 16 MB.
constexpr int kLargestSide = 1024;
// of the squared longest side; chosen: gives the pixels of a line of points an area. Any tiny value will do.
constexpr double kLeastArea = 1e-6;
// chosen: the size settles in two or three rounds. Fewer leave it off by more than 5 %, more change nothing.
constexpr int kPixelSizeRounds = 4;
// of the size; chosen: half takes a round more, twice leaves the points in a pixel off by 20 %
constexpr double kPixelSizeAccuracy = 0.05;
// of eight; chosen: fewer widen the silhouette, more leave holes open
constexpr int kClosingNeighbours = 5;
// chosen: each pass narrows holes by a pixel on each side. Fewer leave holes, more fill true notches.
constexpr int kClosingPasses = 3;
// share of the filled pixels; chosen: less leaves gaps between sparse points, more closes true openings such as handles
constexpr double kSmallHole = 0.01;

/// The pixels of a picture. Pixel (u, v) contains the places about its integer coordinates; one empty pixel at least
/// surrounds the filled ones.
struct PixelGrid {
  Eigen::Array2d low;  ///< least coordinates of the places
  double size;         ///< of a pixel, at depth one
  int width = 1, height = 1;

  int column(const Eigen::Array2d& p) const { return static_cast<int>((p.x() - low.x()) / size) + 1; }
  int row(const Eigen::Array2d& p) const { return static_cast<int>((p.y() - low.y()) / size) + 1; }
  std::size_t at(const Eigen::Array2d& p) const { return static_cast<std::size_t>(row(p)) * width + column(p); }
  std::size_t numPixels() const { return static_cast<std::size_t>(width) * height; }

  /// Takes places at depth one to pixels.
  Eigen::Matrix3d toPixels() const {
    Eigen::Matrix3d to_pixels = Eigen::Matrix3d::Identity();
    to_pixels(0, 0) = to_pixels(1, 1) = 1.0 / size;
    to_pixels(0, 2) = 0.5 - low.x() / size;
    to_pixels(1, 2) = 0.5 - low.y() / size;
    return to_pixels;
  }
};

/// \return the points as seen by the camera; nothing where one lies outside its cone.
std::optional<Places> placesSeen(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                 const Eigen::Matrix3d& R_camera_input) {
  Places places(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = R_camera_input * (points.col(i).cast<double>() - viewpoint);
    if (!(ray.z() > kLeastCosine * ray.norm())) return std::nullopt;
    places[i] = ray.head<2>().array() / ray.z();
  }
  return places;
}

/// Pixels of such a size that the filled ones have kPointsPerPixel points on average.
PixelGrid fitPixels(const Places& places) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Array2d& place : places) {
    low = low.min(place);
    high = high.max(place);
  }
  const Eigen::Array2d extent = high - low;
  const double longest = extent.maxCoeff(), num_points = static_cast<double>(places.size());
  PixelGrid grid{low, std::sqrt(std::max(extent.prod(), kLeastArea * longest * longest) / num_points)};
  for (int round = 1;; ++round) {
    grid.size = std::max(grid.size, longest / (kLargestSide - 4));
    if (!(grid.size > 0.0)) grid.size = 1.0;
    grid.width = grid.column(high) + 2;
    grid.height = grid.row(high) + 2;
    std::vector<char> filled(grid.numPixels(), 0);
    for (const Eigen::Array2d& place : places) filled[grid.at(place)] = 1;
    const auto num_filled = std::count(filled.begin(), filled.end(), 1);
    const double wanted = std::sqrt(kPointsPerPixel * static_cast<double>(num_filled) / num_points);
    const bool settled = wanted > 1.0 - kPixelSizeAccuracy && wanted < 1.0 + kPixelSizeAccuracy;
    if (round == kPixelSizeRounds || settled) return grid;
    grid.size *= wanted;
  }
}

/// Calls visit(index) for the pixels around (u, v) and itself that lie in the picture.
template <typename Visit>
void visitAround(int u, int v, int width, int height, const Visit& visit) {
  for (int y = std::max(0, v - 1); y <= std::min(height - 1, v + 1); ++y)
    for (int x = std::max(0, u - 1); x <= std::min(width - 1, u + 1); ++x)
      visit(static_cast<std::size_t>(y) * width + x);
}

/// Fills empty pixels that most neighbours surround, with the depth nearest to the viewer: space counts as free only if
/// a point lies behind it.
void closeHoles(std::vector<float>& depths, int width, int height) {
  const std::vector<float> before = depths;
  for (int v = 1; v + 1 < height; ++v) {
    for (int u = 1; u + 1 < width; ++u) {
      const std::size_t at = static_cast<std::size_t>(v) * width + u;
      if (before[at] != Visibility::kBackground) continue;
      int num_filled = 0;
      float nearest = Visibility::kBackground;
      visitAround(u, v, width, height, [&](std::size_t near) {
        num_filled += before[near] != Visibility::kBackground ? 1 : 0;
        nearest = std::min(nearest, before[near]);
      });
      if (num_filled >= kClosingNeighbours) depths[at] = nearest;
    }
  }
}

/// Closes small holes whole, with the depth of their nearest border. A gap between sparse points does not show that the
/// scanner looked through.
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
      visitAround(u, v, width, height, [&](std::size_t to) {
        if (!is_empty(to)) nearest = std::min(nearest, depths[to]);
        if (visited[to] || !is_empty(to)) return;
        visited[to] = 1;
        region.push_back(to);
      });
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
  if (points.cols() == 0) return std::nullopt;
  const Eigen::Vector3d forward = (boundingBall(points).center - viewpoint).normalized();
  if (!forward.allFinite() || forward.norm() < 0.5) return std::nullopt;
  const Eigen::Matrix3d R_camera_input = viewingFrame(forward);
  const std::optional<Places> places = placesSeen(points, viewpoint, R_camera_input);
  if (!places) return std::nullopt;

  const PixelGrid grid = fitPixels(*places);
  std::vector<float> depths(grid.numPixels(), kBackground);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    float& depth = depths[grid.at((*places)[i])];
    depth = std::min(depth, static_cast<float>(forward.dot(points.col(i).cast<double>() - viewpoint)));
  }
  for (int pass = 0; pass < kClosingPasses; ++pass) closeHoles(depths, grid.width, grid.height);
  closeGaps(depths, grid.width, grid.height);

  Projection projection;
  projection.leftCols<3>() = R_camera_input;
  projection.col(3) = -R_camera_input * viewpoint;
  // Rays beside the object met nothing either: their space is free.
  return Visibility(grid.toPixels() * projection, grid.width, grid.height, std::move(depths), kBackground);
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
