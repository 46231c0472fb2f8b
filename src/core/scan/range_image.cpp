#include "core/scan/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/constants.h"
#include "core/scan/ray_gaps.h"
#include "core/scan/scan_rules.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

namespace {

// Rays at more than 75 degrees to the middle make no picture: it would be stretched by 1 / cos^2 there.
const double kLeastCosine = std::cos(75.0 * kPi / 180.0);

/// Pixels of such a size that the filled ones have \p points_per_pixel points on average.
PixelGrid fitPixels(const std::vector<Eigen::Array2d>& positions, std::size_t max_pixels, double points_per_pixel) {
  const double largest_side = std::floor(std::sqrt(static_cast<double>(max_pixels)));
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Array2d& position : positions) {
    low = low.min(position);
    high = high.max(position);
  }
  const Eigen::Array2d extent = high - low;
  const double longest = extent.maxCoeff(), num_points = static_cast<double>(positions.size());
  PixelGrid grid{low, std::sqrt(std::max(extent.prod(), 1e-6 * longest * longest) / num_points)};
  for (int round = 1;; ++round) {
    grid.size = std::max(grid.size, longest / std::max(1.0, largest_side - 4.0));
    if (!(grid.size > 0.0)) grid.size = 1.0;
    grid.width = grid.column(high) + 2;
    grid.height = grid.row(high) + 2;
    std::vector<char> filled(grid.numPixels(), 0);
    for (const Eigen::Array2d& position : positions) filled[grid.at(position)] = 1;
    const auto num_filled = std::count(filled.begin(), filled.end(), 1);
    const double wanted = std::sqrt(points_per_pixel * static_cast<double>(num_filled) / num_points);
    const bool settled = wanted > 1.0 - kScan.pixel_size_accuracy && wanted < 1.0 + kScan.pixel_size_accuracy;
    if (round == 4 || settled) return grid;
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

/// Fills empty pixels that most neighbors surround, with the depth nearest to the viewer: space counts as free only if
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
      if (num_filled >= kScan.closing_neighbors) depths[at] = nearest;
    }
  }
}

/// Closes small holes whole, with the depth of their nearest border. A gap between sparse points does not show that the
/// scanner looked through.
/// \param largest_hole pixels, whatever the size of the picture.
void closeGaps(std::vector<float>& depths, int width, int height, std::size_t largest_hole) {
  const auto is_empty = [&](std::size_t at) { return depths[at] == Visibility::kBackground; };
  const auto num_empty = std::count(depths.begin(), depths.end(), Visibility::kBackground);
  const double largest =
      std::min(static_cast<double>(largest_hole),
               kScan.small_hole * static_cast<double>(depths.size() - static_cast<std::size_t>(num_empty)));
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

RangeImage nearestInPixels(const SeenPlaces& seen, std::size_t max_pixels, double points_per_pixel) {
  RangeImage image{fitPixels(seen.positions, max_pixels, points_per_pixel), {}};
  image.depths.assign(image.grid.numPixels(), Visibility::kBackground);
  for (std::size_t i = 0; i < seen.positions.size(); ++i) {
    float& depth = image.depths[image.grid.at(seen.positions[i])];
    depth = std::min(depth, seen.depths[i]);
  }
  return image;
}

/// Closes what is empty between the points of one surface.
void closeSurfaces(RangeImage& image, std::size_t largest_hole) {
  for (int pass = 0; pass < kScan.closing_passes; ++pass) closeHoles(image.depths, image.grid.width, image.grid.height);
  closeGaps(image.depths, image.grid.width, image.grid.height, largest_hole);
}

/// Turns empty pixels beyond the measured part of the picture to Visibility::kNoRay: those that have filled pixels in
/// fewer than kScan.inside_sides of the four directions along rows and columns.
void forgetOutside(RangeImage& image) {
  const int width = image.grid.width, height = image.grid.height;
  // Of each pixel, the number of the four directions in which a filled pixel lies.
  std::vector<char> num_sides(image.depths.size(), 0);
  const auto walk = [&](std::size_t start, std::ptrdiff_t step, int count) {
    bool met = false;
    for (int k = 0; k < count; ++k) {
      const std::size_t at = start + static_cast<std::size_t>(k * step);
      met = met || image.depths[at] != Visibility::kBackground;
      num_sides[at] = static_cast<char>(num_sides[at] + (met ? 1 : 0));
    }
  };
  for (int v = 0; v < height; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * width;
    walk(row, 1, width);
    walk(row + width - 1, -1, width);
  }
  for (int u = 0; u < width; ++u) {
    walk(static_cast<std::size_t>(u), width, height);
    walk(static_cast<std::size_t>(height - 1) * width + u, -width, height);
  }
  for (std::size_t i = 0; i < image.depths.size(); ++i)
    if (num_sides[i] < kScan.inside_sides) image.depths[i] = Visibility::kNoRay;
}

}  // namespace

SeenPlaces placesSeen(const PointsRef& points, const Eigen::Vector3d& viewpoint, const Eigen::Matrix3d& R_camera_input,
                      FieldOfView field) {
  SeenPlaces seen;
  seen.positions.reserve(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = R_camera_input * (points.col(i).cast<double>() - viewpoint);
    const bool inside = field == FieldOfView::Cone ? ray.z() > kLeastCosine * ray.norm()
                                                   : ray.z() > 0.0 && ray.head<2>().cwiseAbs().maxCoeff() <= ray.z();
    if (!inside) continue;
    seen.positions.push_back(ray.head<2>().array() / ray.z());
    seen.depths.push_back(static_cast<float>(ray.z()));
  }
  return seen;
}

RangeImage rangeImage(const SeenPlaces& seen, std::size_t max_pixels) {
  RangeImage image = nearestInPixels(seen, max_pixels, kScan.points_per_pixel);
  closeSurfaces(image, std::numeric_limits<std::size_t>::max());
  return image;
}

RangeImage sceneRangeImage(const SeenPlaces& seen, std::size_t max_pixels) {
  RangeImage image = nearestInPixels(seen, max_pixels, kScan.points_per_ring_pixel);
  const PartialImage partial{image.grid.width, image.grid.height, image.depths};
  const double gap = typicalGap(partial);
  if (gap < kScan.gap_of_rings) {
    image = nearestInPixels(seen, max_pixels, kScan.points_per_pixel);
    closeSurfaces(image, static_cast<std::size_t>(kScan.largest_scene_hole / kScan.points_per_pixel));
  } else {
    bridgeGaps(partial, kScan.longest_bridge * gap);
    closeGaps(image.depths, partial.width, partial.height,
              static_cast<std::size_t>(kScan.largest_scene_hole / kScan.points_per_ring_pixel));
  }
  forgetOutside(image);
  return image;
}

}  // namespace pcl_symmetry
