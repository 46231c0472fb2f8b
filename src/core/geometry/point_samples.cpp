#include "core/geometry/point_samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/random.h"
#include "core/base/statistics.h"
#include "core/geometry/geometry_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// Indices of points along Morton's curve through the cells of a grid, so that successive points are near each other.
/// \param points 3 x N, finite.
std::vector<int> curveOrder(const PointsRef& points) {
  constexpr int num_cells = 64;  // along each side
  const Eigen::Vector3f low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  const float extent = (high - low).maxCoeff();
  const float scale = extent > 0.0f ? static_cast<float>(num_cells) / extent : 0.0f;
  std::vector<std::pair<std::uint32_t, int>> cells;
  for (int i = 0; i < static_cast<int>(points.cols()); ++i) {
    const Eigen::Array3i cell = ((points.col(i) - low).array() * scale).cast<int>().min(num_cells - 1);
    cells.emplace_back(mortonCode(cell.x(), cell.y(), cell.z()), i);
  }
  std::sort(cells.begin(), cells.end());
  std::vector<int> order;
  for (const auto& [cell, i] : cells) order.push_back(i);
  return order;
}

/// Distances of points from the middle of most of the points.
std::vector<float> distancesFromMiddle(const PointsRef& points) {
  Eigen::Vector3f middle;
  std::vector<float> values(points.cols());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = points(axis, static_cast<Eigen::Index>(i));
    middle[axis] = quantile(values, 0.5);
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = (points.col(i) - middle).norm();
  return values;
}

/// The outer points of a cloud that gaps separate from its bulk, alone or in tiny groups.
/// \param points distinct.
/// \param outer indices of the points beyond the bulk, ascending.
/// \return indices, ascending.
std::vector<int> isolatedPoints(const Points& points, const std::vector<int>& outer, float gap) {
  const std::size_t bulk = outer.size();
  const int num_neighbors = std::min<int>(kGeometry.max_stray_group + 1, static_cast<int>(points.cols()));
  std::vector<int> neighbors;
  std::vector<float> sq_distances;
  makeFlannSearch(points)->search(pointsAt(points, outer), num_neighbors, neighbors, sq_distances);
  // Trees of points with short gaps between them; the last entry stands for the bulk.
  std::vector<std::size_t> parent(bulk + 1);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto rootOf = [&](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  for (std::size_t i = 0; i < neighbors.size(); ++i) {
    if (sq_distances[i] > gap * gap) continue;
    const auto at = std::lower_bound(outer.begin(), outer.end(), neighbors[i]);
    const bool is_outer = at != outer.end() && *at == neighbors[i];
    parent[rootOf(i / num_neighbors)] = rootOf(is_outer ? static_cast<std::size_t>(at - outer.begin()) : bulk);
  }
  std::vector<int> sizes(bulk + 1, 0), isolated;
  for (std::size_t k = 0; k < bulk; ++k) ++sizes[rootOf(k)];
  for (std::size_t k = 0; k < bulk; ++k)
    if (rootOf(k) != rootOf(bulk) && sizes[rootOf(k)] <= kGeometry.max_stray_group) isolated.push_back(outer[k]);
  return isolated;
}

/// \return the number of distinct points, counted up to \p max_count.
int countDistinct(const PointsRef& points, int max_count) {
  std::vector<Eigen::Vector3f> distinct;
  for (Eigen::Index i = 0; i < points.cols() && static_cast<int>(distinct.size()) < max_count; ++i) {
    const Eigen::Vector3f point = points.col(i);
    if (std::find(distinct.begin(), distinct.end(), point) == distinct.end()) distinct.push_back(point);
  }
  return static_cast<int>(distinct.size());
}

Eigen::Vector3d farthestFrom(const Eigen::Vector3d& position, const PointsRef& points) {
  Eigen::Index farthest = 0;
  (points.cast<double>().colwise() - position).colwise().squaredNorm().maxCoeff(&farthest);
  return points.col(farthest).cast<double>();
}

/// Why distinct points cannot be analyzed: they lie at one position or on one line, up to rounding.
std::string whyTooThin(const PointsRef& points) {
  // The ends of a line: the point farthest from any point, and the one farthest from that.
  const Eigen::Vector3d first = farthestFrom(points.col(0).cast<double>(), points);
  const Eigen::Vector3d last = farthestFrom(first, points);
  const double length = (last - first).norm();
  // Rounding moves a point by sqrt(3) 2^-24 of its distance from the origin, and the line through two other points by
  // as much.
  const double rounding =
      2.0 * std::numeric_limits<float>::epsilon() * farthestFrom(Eigen::Vector3d::Zero(), points).norm();
  if (length <= rounding) return "all points are at one position, up to the rounding of their coordinates";
  const Eigen::Vector3d direction = (last - first) / length;
  const double thickness = std::max(kGeometry.line_thickness * length, rounding);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d offset = points.col(i).cast<double>() - first;
    if ((offset - direction.dot(offset) * direction).norm() > thickness) return {};
  }
  return "all points lie on one line";
}

}  // namespace

std::vector<int> shuffled(Eigen::Index size, std::uint64_t seed, Eigen::Index max_count) {
  std::vector<int> order = allIndices(size);
  RandomStream random(seed);
  max_count = std::min(max_count, size);
  for (Eigen::Index i = 0; i < max_count; ++i)
    std::swap(order[i], order[i + random.below(static_cast<std::uint64_t>(size - i))]);
  order.resize(max_count);
  return order;
}

std::vector<std::size_t> oneOfEachRun(std::size_t size, std::size_t num_drawn, std::uint64_t seed) {
  std::vector<std::size_t> drawn(num_drawn);
  RandomStream random(seed);
  const double run = static_cast<double>(size) / static_cast<double>(num_drawn);
  std::size_t next = 0;
  for (std::size_t i = 0; i < num_drawn; ++i) {
    const double position = (static_cast<double>(i) + random.uniform()) * run;
    drawn[i] = std::max(next, std::min(size - 1, static_cast<std::size_t>(position)));
    next = drawn[i] + 1;
  }
  return drawn;
}

std::vector<int> spreadSubset(const PointsRef& points, std::size_t size, std::uint64_t seed) {
  const std::vector<int> order = curveOrder(points);
  std::vector<int> kept;
  for (const std::size_t position : oneOfEachRun(order.size(), size, seed)) kept.push_back(order[position]);
  return kept;
}

Points reflectedNormals(const PointsRef& normals, const ReflectionPlane& plane) {
  const Eigen::Vector3f n = plane.normal().cast<float>();
  Points reflected(3, normals.cols());
  for (Eigen::Index i = 0; i < normals.cols(); ++i)
    reflected.col(i) = normals.col(i) - 2.0f * n.dot(normals.col(i)) * n;
  return reflected;
}

std::vector<int> firstCopies(const PointsRef& points) {
  const auto hash = [](const Eigen::Vector3f& point) {
    constexpr std::uint64_t factor = 0x9E3779B97F4A7C15u;  // 2^64 divided by the golden ratio, made odd
    std::uint64_t result = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float coordinate = point[axis] + 0.0f;  // 0 and -0 are equal
      std::uint32_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof bits);
      result = (result ^ bits) * factor;
      result ^= result >> 32;
    }
    return result;
  };
  std::vector<int> first(points.cols());
  std::size_t num_slots = 1;
  while (num_slots < 2 * first.size()) num_slots *= 2;
  std::vector<int> first_of_slot(num_slots, -1);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Eigen::Vector3f point = points.col(i);
    std::size_t slot = hash(point) & (num_slots - 1);
    while (first_of_slot[slot] >= 0 && points.col(first_of_slot[slot]) != point) slot = (slot + 1) & (num_slots - 1);
    if (first_of_slot[slot] < 0) first_of_slot[slot] = static_cast<int>(i);
    first[i] = first_of_slot[slot];
  }
  return first;
}

std::vector<int> strayPoints(const PointsRef& points) {
  const auto size = static_cast<double>(points.cols());
  const double max_count = kGeometry.max_stray * size;
  if (max_count < 1.0 || !points.allFinite()) return {};
  const std::vector<float> distances = distancesFromMiddle(points);
  const float bulk = quantile(distances, kGeometry.bulk);
  const float gap = 2.0f * bulk *
                    std::clamp(kGeometry.stray_spacings * std::sqrt(3.0f / static_cast<float>(size)),
                               kGeometry.min_stray_gap, kGeometry.max_stray_gap);
  if (std::none_of(distances.begin(), distances.end(), [&](float distance) { return distance > bulk + gap; }))
    return {};
  // Copies of one position are one point.
  const DistinctPoints distinct(points);
  std::vector<int> outer, stray;
  for (int k = 0; k < static_cast<int>(distinct.first_of.size()); ++k)
    if (distances[distinct.first_of[k]] > bulk) outer.push_back(k);
  const std::vector<int> alone = isolatedPoints(distinct.points, outer, gap);
  for (int i = 0; i < static_cast<int>(points.cols()); ++i)
    if (std::binary_search(alone.begin(), alone.end(), distinct.index_of[i])) stray.push_back(i);
  if (static_cast<double>(stray.size()) > max_count) stray.clear();
  return stray;
}

std::vector<int> complementOf(const std::vector<int>& stray, Eigen::Index size) {
  std::vector<int> others;
  auto next = stray.begin();
  for (int i = 0; i < static_cast<int>(size); ++i) {
    if (next != stray.end() && *next == i)
      ++next;
    else
      others.push_back(i);
  }
  return others;
}

Points withoutStrayPoints(const PointsRef& points) {
  const std::vector<int> stray = strayPoints(points);
  return stray.empty() ? Points(points) : pointsAt(points, complementOf(stray, points.cols()));
}

void checkPoints(const PointsRef& points) {
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
}

BoundingBall checkedBall(const PointsRef& points) {
  checkPoints(points);
  const BoundingBall ball = boundingBall(points);
  check(ball.radius > 0.0, "radius of the points", ball.radius, "> 0");
  return ball;
}

std::string whyUnanswerable(const PointsRef& points) {
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
  if (points.cols() == 0) return "no finite point";
  const int num_distinct = countDistinct(points, kMinDistinctPoints);
  if (num_distinct < kMinDistinctPoints)
    return std::to_string(num_distinct) +
           (num_distinct == 1 ? " distinct point, at least " : " distinct points, at least ") +
           std::to_string(kMinDistinctPoints) + " are needed";
  // With a sufficiently distant stray point, all others look like a line.
  std::string reason = whyTooThin(points);
  return reason.empty() ? reason : whyTooThin(withoutStrayPoints(points));
}

}  // namespace pcl_symmetry
