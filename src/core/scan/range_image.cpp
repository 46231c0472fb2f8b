#include "core/scan/range_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/base/statistics.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/scan/scan_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

namespace {

/// A step from pixel to pixel along a line of the image.
struct PixelStep {
  int du, dv;

  float length() const { return std::hypot(static_cast<float>(du), static_cast<float>(dv)); }
};

/// Calls visit(from, to, count) for each two successive filled pixels of a line, \p count steps apart.
template <typename Visit>
void visitLine(const RangeImage& image, int u, int v, const PixelStep& step, const Visit& visit) {
  std::ptrdiff_t last = -1;
  int count = 0;
  for (; u >= 0 && v >= 0 && u < image.grid.width && v < image.grid.height; u += step.du, v += step.dv, ++count) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(v) * image.grid.width + u;
    if (image.depths[at] == Visibility::kBackground) continue;
    if (last >= 0) visit(last, at, count);
    last = at;
    count = 0;
  }
}

/// The same for all lines along a step.
template <typename Visit>
void visitLines(const RangeImage& image, const PixelStep& step, const Visit& visit) {
  const int side = step.du < 0 ? image.grid.width - 1 : 0;
  if (step.du != 0)
    for (int v = 0; v < image.grid.height; ++v) visitLine(image, side, v, step, visit);
  if (step.dv != 0)
    for (int u = 0; u < image.grid.width; ++u)
      if (step.du == 0 || u != side) visitLine(image, u, 0, step, visit);
}

/// For each filled pixel, the distance to the next one along a step or against it.
std::vector<float> distancesAlong(const RangeImage& image, const PixelStep& step) {
  std::vector<float> distances(image.depths.size(), std::numeric_limits<float>::infinity());
  visitLines(image, step, [&](std::ptrdiff_t from, std::ptrdiff_t to, int count) {
    for (const std::ptrdiff_t at : {from, to}) distances[at] = std::min(distances[at], static_cast<float>(count));
  });
  return distances;
}

/// The distance between rays in the direction in which they are sparse: rings of a LiDAR are many pixels apart, while
/// rays within a ring are neighbors.
/// \return median over the pixels with a depth of the distance to the next such pixel in the row or the column,
/// whichever is larger, pixels; 0 if no pixel has neighbors in both.
double typicalGap(const RangeImage& image) {
  const std::vector<float> in_row = distancesAlong(image, {1, 0}), in_column = distancesAlong(image, {0, 1});
  std::vector<double> gaps;
  for (std::size_t i = 0; i < in_row.size(); ++i)
    if (in_row[i] < std::numeric_limits<float>::infinity() && in_column[i] < std::numeric_limits<float>::infinity())
      gaps.push_back(std::max(in_row[i], in_column[i]));
  return gaps.empty() ? 0.0 : median(std::move(gaps));
}

/// Closes the gaps between neighboring rays. An empty pixel between two filled ones, on the shortest of the four lines
/// through it along rows, columns and diagonals, gets the nearer of their depths: space between two rays counts as free
/// as far as both of them show it to be free.
/// \param longest longest gap that is closed, pixels.
void bridgeGaps(RangeImage& image, double longest) {
  std::vector<float> filled = image.depths, shortest(filled.size(), std::numeric_limits<float>::infinity());
  for (const PixelStep& step : {PixelStep{1, 0}, PixelStep{0, 1}, PixelStep{1, 1}, PixelStep{-1, 1}}) {
    visitLines(image, step, [&](std::ptrdiff_t from, std::ptrdiff_t to, int count) {
      const float gap = step.length() * static_cast<float>(count);
      if (gap > static_cast<float>(longest)) return;
      const float nearer = std::min(image.depths[from], image.depths[to]);
      const std::ptrdiff_t stride = (to - from) / count;
      for (std::ptrdiff_t at = from + stride; at != to; at += stride) {
        if (gap > shortest[at]) continue;
        filled[at] = gap < shortest[at] ? nearer : std::min(filled[at], nearer);
        shortest[at] = gap;
      }
    });
  }
  image.depths = std::move(filled);
}

// Cosine of the greatest angle of a ray to the middle of an image, 75 degrees: at more, the image would be stretched by
// 1 / cos^2.
const double kLeastCosine = std::cos(75.0 * kDegree);

/// A grid whose filled pixels have \p points_per_pixel points on average.
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

/// Calls visit(index) for the pixels around (u, v), and that pixel itself, that lie in the image.
template <typename Visit>
void visitAround(int u, int v, const PixelGrid& grid, const Visit& visit) {
  for (int y = std::max(0, v - 1); y <= std::min(grid.height - 1, v + 1); ++y)
    for (int x = std::max(0, u - 1); x <= std::min(grid.width - 1, u + 1); ++x)
      visit(static_cast<std::size_t>(y) * grid.width + x);
}

/// Fills empty pixels that most neighbors surround, with the depth nearest to the viewer: space counts as free only if
/// a point lies behind it.
void closeHoles(RangeImage& image) {
  const std::vector<float> before = image.depths;
  const int width = image.grid.width;
  for (int v = 1; v + 1 < image.grid.height; ++v) {
    for (int u = 1; u + 1 < width; ++u) {
      const std::size_t at = static_cast<std::size_t>(v) * width + u;
      if (before[at] != Visibility::kBackground) continue;
      int num_filled = 0;
      float nearest = Visibility::kBackground;
      visitAround(u, v, image.grid, [&](std::size_t near) {
        num_filled += before[near] != Visibility::kBackground ? 1 : 0;
        nearest = std::min(nearest, before[near]);
      });
      if (num_filled >= kScan.closing_neighbors) image.depths[at] = nearest;
    }
  }
}

/// Closes small holes completely, with the depth of their nearest border. A gap between sparse points does not show
/// that the scanner looked through it.
/// \param largest_hole size of the largest hole that is closed, pixels, whatever the size of the image.
void closeGaps(RangeImage& image, std::size_t largest_hole) {
  std::vector<float>& depths = image.depths;
  const std::size_t width = image.grid.width;
  const auto isEmpty = [&](std::size_t at) { return depths[at] == Visibility::kBackground; };
  const auto num_empty = std::count(depths.begin(), depths.end(), Visibility::kBackground);
  const double largest =
      std::min(static_cast<double>(largest_hole),
               kScan.small_hole * static_cast<double>(depths.size() - static_cast<std::size_t>(num_empty)));
  std::vector<char> visited(depths.size(), 0);
  std::vector<std::size_t> region;
  for (std::size_t start = 0; start < depths.size(); ++start) {
    if (visited[start] || !isEmpty(start)) continue;
    region.assign(1, start);
    visited[start] = 1;
    float nearest = Visibility::kBackground;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const int u = static_cast<int>(region[next] % width), v = static_cast<int>(region[next] / width);
      visitAround(u, v, image.grid, [&](std::size_t to) {
        if (!isEmpty(to)) nearest = std::min(nearest, depths[to]);
        if (visited[to] || !isEmpty(to)) return;
        visited[to] = 1;
        region.push_back(to);
      });
    }
    if (static_cast<double>(region.size()) <= largest)
      for (const std::size_t at : region) depths[at] = nearest;
  }
}

RangeImage nearestInPixels(const SeenPositions& seen, std::size_t max_pixels, double points_per_pixel) {
  RangeImage image{fitPixels(seen.positions, max_pixels, points_per_pixel), {}};
  image.depths.assign(image.grid.numPixels(), Visibility::kBackground);
  for (std::size_t i = 0; i < seen.positions.size(); ++i) {
    float& depth = image.depths[image.grid.at(seen.positions[i])];
    depth = std::min(depth, seen.depths[i]);
  }
  return image;
}

/// Closes the gaps between the points of one surface.
void closeSurfaces(RangeImage& image, std::size_t largest_hole) {
  for (int pass = 0; pass < kScan.closing_passes; ++pass) closeHoles(image);
  closeGaps(image, largest_hole);
}

/// Sets empty pixels beyond the measured part of the image, with filled pixels in fewer than kScan.inside_sides of the
/// four directions along rows and columns, to Visibility::kNoRay.
void forgetOutside(RangeImage& image) {
  const int width = image.grid.width, height = image.grid.height;
  // For each pixel, the number of the four directions in which a filled pixel lies.
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

/// Directions to points in an image: unit vectors from the viewpoint to them minus the one to their middle, in units of
/// \p width.
Points imageDirections(const PointsRef& points, const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& middle,
                       double width) {
  const Eigen::Vector3d forward = (middle - viewpoint).normalized();
  Points directions(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    directions.col(i) = (((points.col(i).cast<double>() - viewpoint).normalized() - forward) / width).cast<float>();
  return directions;
}

using Positions = std::vector<Eigen::Array2d>;

/// The direction of the rows of positions, one of four at right angles, and the distance of neighbors.
struct PixelRows {
  double angle;
  double pitch;
};

std::optional<PixelRows> rowsOf(const Positions& positions) {
  Points flat = Points::Zero(3, static_cast<Eigen::Index>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) flat.col(i).head<2>() = positions[i].matrix().cast<float>();
  const auto stride = static_cast<Eigen::Index>(1 + (positions.size() - 1) / kScan.grid_samples);
  const Points samples = pointsAt(flat, everyNth(flat.cols(), stride));
  std::vector<int> closest;
  std::vector<float> sq_distances, distances;
  makeFlannSearch(flat)->search(samples, kScan.grid_neighbors + 1, closest, sq_distances);
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < closest.size(); ++k) {
    const auto sample = static_cast<Eigen::Index>(k) / (kScan.grid_neighbors + 1);
    const Eigen::Vector3f d = flat.col(closest[k]) - samples.col(sample);
    if (!(sq_distances[k] > 0.0f)) continue;
    sum += std::polar(1.0, 4.0 * std::atan2(d.y(), d.x()));
    distances.push_back(std::sqrt(sq_distances[k]));
  }
  if (distances.empty() || std::abs(sum) < kScan.min_grid * static_cast<double>(distances.size())) return std::nullopt;
  return PixelRows{std::arg(sum) / 4.0, median(distances)};
}

/// The line that all positions lie behind, and the numbers of positions in the three rows next to it.
struct LastRows {
  FrameSide side;
  std::array<int, 3> counts{};

  bool areCut() const {
    return counts[0] >= kScan.min_row && counts[0] >= kScan.min_row_ratio * 0.5 * (counts[1] + counts[2]);
  }
};

LastRows lastRows(const Positions& positions, double angle, double pitch) {
  LastRows rows{{{std::cos(angle), std::sin(angle)}, -std::numeric_limits<double>::infinity()}, {}};
  for (const Eigen::Array2d& position : positions)
    rows.side.offset = std::max(rows.side.offset, rows.side.normal.dot(position.matrix()));
  for (const Eigen::Array2d& position : positions) {
    const double row = (rows.side.offset - rows.side.normal.dot(position.matrix())) / pitch;
    if (row < static_cast<double>(rows.counts.size())) ++rows.counts[static_cast<std::size_t>(row)];
  }
  return rows;
}

/// The positions that may be in the last rows at any angle of the side.
Positions nearSide(const Positions& positions, double angle, double pitch) {
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  Eigen::Array2d low = positions.front(), high = positions.front();
  double offset = -std::numeric_limits<double>::infinity();
  for (const Eigen::Array2d& position : positions) {
    low = low.min(position);
    high = high.max(position);
    offset = std::max(offset, normal.dot(position.matrix()));
  }
  const double depth = kScan.max_side_angle * (high - low).matrix().norm() + 4.0 * pitch;
  Positions near;
  for (const Eigen::Array2d& position : positions)
    if (normal.dot(position.matrix()) > offset - depth) near.push_back(position);
  return near;
}

}  // namespace

SeenPositions positionsSeen(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                            const Eigen::Matrix3d& R_camera_input, FieldOfView field) {
  SeenPositions seen;
  seen.positions.reserve(points.cols());
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

RangeImage rangeImage(const SeenPositions& seen, std::size_t max_pixels) {
  RangeImage image = nearestInPixels(seen, max_pixels, kScan.points_per_pixel);
  closeSurfaces(image, std::numeric_limits<std::size_t>::max());
  return image;
}

RangeImage sceneRangeImage(const SeenPositions& seen, std::size_t max_pixels) {
  RangeImage image = nearestInPixels(seen, max_pixels, kScan.points_per_ring_pixel);
  const double gap = typicalGap(image);
  if (gap < kScan.gap_of_rings) {
    image = nearestInPixels(seen, max_pixels, kScan.points_per_pixel);
    closeSurfaces(image, static_cast<std::size_t>(kScan.largest_scene_hole / kScan.points_per_pixel));
  } else {
    bridgeGaps(image, kScan.longest_bridge * gap);
    closeGaps(image, static_cast<std::size_t>(kScan.largest_scene_hole / kScan.points_per_ring_pixel));
  }
  forgetOutside(image);
  return image;
}

std::vector<FrameSide> frameSides(const Positions& positions) {
  std::vector<FrameSide> sides;
  if (positions.size() <= static_cast<std::size_t>(kScan.grid_neighbors)) return sides;
  const std::optional<PixelRows> rows = rowsOf(positions);
  if (!rows) return sides;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double ahead = rows->angle + 0.5 * kPi * quarter;
    const Positions near = nearSide(positions, ahead, rows->pitch);
    std::optional<LastRows> best;
    const int num_steps = static_cast<int>(std::lround(kScan.max_side_angle / kScan.side_angle_step));
    for (int step = -num_steps; step <= num_steps; ++step) {
      LastRows last = lastRows(near, ahead + kScan.side_angle_step * step, rows->pitch);
      if (!best || last.counts[0] > best->counts[0]) best = last;
    }
    if (!best->areCut()) continue;
    best->side.offset += 0.5 * rows->pitch;
    sides.push_back(best->side);
  }
  return sides;
}

double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  if (points.cols() < 2) return 0.0;
  const BoundingBall ball = boundingBall(points);
  const double distance = (ball.center - viewpoint).norm();
  if (!(ball.radius > 0.0) || !(distance > 0.0)) return 0.0;
  const Eigen::Index stride = 1 + (points.cols() - 1) / kScan.max_layer_samples;
  const Points surface = normalizePoints(points, ball.center, ball.radius);
  const std::vector<int> samples = everyNth(points.cols(), stride);
  const double min_gap =
      kScan.roughnesses *
      median(localGeometryAt(surface, *makeFlannSearch(surface), pointsAt(surface, samples)).roughness);

  // The nearest other point of each sample in the image.
  const double width = ball.radius / distance;
  const Points directions = imageDirections(points, viewpoint, ball.center, width);
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeFlannSearch(directions)->search(pointsAt(directions, samples), 2, closest, sq_distances);

  const auto depth = [&](Eigen::Index i) { return (points.col(i).cast<double>() - viewpoint).norm() / ball.radius; };
  std::size_t num_layered = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const int i = samples[s];
    const std::size_t other = closest[2 * s] == i ? 2 * s + 1 : 2 * s;
    const double across = std::sqrt(sq_distances[other]) * width * depth(i);
    const double along = std::abs(depth(i) - depth(closest[other]));
    num_layered += along > std::max(kScan.steepest * across, min_gap) ? 1 : 0;
  }
  return static_cast<double>(num_layered) / static_cast<double>(samples.size());
}

std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        const SingleViewLimits& limits) {
  const BoundingBall ball = boundingBall(points);
  if (!((viewpoint - ball.center).norm() > ball.radius)) return std::nullopt;
  std::optional<Visibility> visibility = Visibility::fromPoints(points, viewpoint);
  if (!visibility) return std::nullopt;
  // The surface may slant as much as in layeredShare(), over half a pixel.
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

std::string whyNotSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  const std::optional<Visibility> visibility = Visibility::ofScene(points, viewpoint);
  if (!visibility) return "";
  const double hidden = visibility->hiddenShare(points, kScan.hidden_margin * boundingBall(points).radius);
  if (hidden <= kScan.max_hidden) return "";
  return std::to_string(std::lround(100.0 * hidden)) +
         " % of the points lie behind others as seen from the viewpoint given; a cloud from all sides has no viewpoint";
}

double cutShare(const PointsRef& points, const Visibility& seen) {
  const Eigen::Vector3d viewpoint = seen.viewpoint();
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) forward += (points.col(i).cast<double>() - viewpoint).normalized();
  forward.normalize();
  const Eigen::Vector3d u = forward.unitOrthogonal(), v = forward.cross(u);
  std::array<Eigen::Vector3d, 72> outermost;  // every 5 degrees; displacements in the image
  outermost.fill(Eigen::Vector3d::Zero());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = points.col(i).cast<double>() - viewpoint, aside = ray / ray.dot(forward) - forward;
    const double direction = std::atan2(v.dot(aside), u.dot(aside)) / (2.0 * kPi) + 0.5;
    Eigen::Vector3d& farthest = outermost[static_cast<std::size_t>(direction * outermost.size()) % outermost.size()];
    if (aside.squaredNorm() > farthest.squaredNorm()) farthest = aside;
  }
  double count = 0.0, num_cut = 0.0;
  for (const Eigen::Vector3d& aside : outermost) {
    if (aside.isZero()) continue;
    const Eigen::Vector3d beside = viewpoint + forward + (1.0 + kScan.beside_outline) * aside;
    count += 1.0;
    num_cut += seen.isInPicture(beside) ? 0.0 : 1.0;
  }
  return num_cut / std::max(1.0, count);
}

bool isFreeSpace(const Visibility& seen, const Eigen::Vector3d& x, double margin, double rim) {
  const auto isEmpty = [&](const Eigen::Vector3d& at) { return seen.depthBehind(at) < -margin; };
  if (!isEmpty(x)) return false;
  if (rim <= 0.0) return true;
  const Eigen::Vector3d ray = (x - seen.viewpoint()).normalized(), u = ray.unitOrthogonal(), v = ray.cross(u);
  return isEmpty(x + rim * u) && isEmpty(x + rim * v) && isEmpty(x - rim * u) && isEmpty(x - rim * v);
}

}  // namespace pcl_symmetry
