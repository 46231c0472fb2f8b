/// Subsets of a cloud: samples, and the points that an analysis can use, which are distinct and not stray, if there are
/// enough of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/lists.h"
#include "core/base/random.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// \throws std::invalid_argument without a point, and for a coordinate that is not finite.
void checkPoints(const PointsRef& points);

/// \return the ball around points, in whose radii squares of points neither overflow nor underflow.
/// \throws std::invalid_argument as checkPoints() does, and for points without extent.
BoundingBall checkedBall(const PointsRef& points);

/// \return at most \p max_count of 0, 1, ..., size - 1 in random order.
inline std::vector<int> shuffled(Eigen::Index size, std::uint64_t seed,
                                 Eigen::Index max_count = std::numeric_limits<Eigen::Index>::max()) {
  std::vector<int> order = allOf(size);
  RandomStream random(seed);
  max_count = std::min(max_count, size);
  for (Eigen::Index i = 0; i < max_count; ++i)
    std::swap(order[i], order[i + random.below(static_cast<std::uint64_t>(size - i))]);
  order.resize(max_count);
  return order;
}

/// \return 0, stride, 2 stride, ... below size.
inline std::vector<int> everyNth(Eigen::Index size, Eigen::Index stride) {
  std::vector<int> samples;
  for (Eigen::Index i = 0; i < size; i += stride) samples.push_back(static_cast<int>(i));
  return samples;
}

/// Draws points without replacement.
/// \param size number of points of the cloud.
/// \return num_samples different indices in random order; all indices in order if size <= num_samples.
inline std::vector<int> drawSamples(Eigen::Index size, int num_samples, std::uint64_t seed) {
  return num_samples >= size ? allOf(size) : shuffled(size, seed, num_samples);
}

/// Draws one element of each of \p num_drawn equal runs of a sequence.
/// \param size length of the sequence, more than \p num_drawn.
/// \return num_drawn positions in the sequence, ascending.
inline std::vector<std::size_t> oneOfEachRun(std::size_t size, std::size_t num_drawn, std::uint64_t seed) {
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

/// \return 3 x samples.size(), the points with these indices.
inline Points pointsAt(const PointsRef& points, const std::vector<int>& samples) {
  Points chosen(3, samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) chosen.col(i) = points.col(samples[i]);
  return chosen;
}

/// The position of a cell along Morton's curve: the interleaved bits of its coordinates.
/// \param x,y,z in [0, 1024).
inline std::uint32_t mortonCode(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t code = 0;
  for (int bit = 0; bit < 10; ++bit)
    code |= ((x >> bit & 1u) | (y >> bit & 1u) << 1 | (z >> bit & 1u) << 2) << (3 * bit);
  return code;
}

/// Indices of points along Morton's curve through the cells of a grid, so that successive points are near each other.
/// \param points 3 x N, finite.
inline std::vector<int> curveOrder(const PointsRef& points) {
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

/// A subset with the density of the cloud: one point from each of equal runs along a curve through cells of a grid.
/// \param points 3 x N, finite.
/// \param size size of the subset, < N.
/// \return different indices in the order of the curve, so that successive points are near each other.
inline std::vector<int> spreadSubset(const PointsRef& points, std::size_t size, std::uint64_t seed) {
  const std::vector<int> order = curveOrder(points);
  std::vector<int> kept;
  for (const std::size_t position : oneOfEachRun(order.size(), size, seed)) kept.push_back(order[position]);
  return kept;
}

/// \return 3 x N, the points reflected in a plane, in their order.
inline Points reflectedPoints(const PointsRef& points, const ReflectionPlane& plane) {
  Points reflected(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    reflected.col(i) = plane.reflect(points.col(i).cast<double>()).cast<float>();
  return reflected;
}

/// \return 3 x N, the normals of points after the points were reflected in a plane.
inline Points reflectedNormals(const PointsRef& normals, const ReflectionPlane& plane) {
  const Eigen::Vector3f n = plane.normal().cast<float>();
  Points reflected(3, normals.cols());
  for (Eigen::Index i = 0; i < normals.cols(); ++i)
    reflected.col(i) = normals.col(i) - 2.0f * n.dot(normals.col(i)) * n;
  return reflected;
}

/// \return for each point the index of the first one at the same position; NaN equals nothing.
inline std::vector<int> firstCopies(const PointsRef& points) {
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

/// The points without repetitions. Copies of a point are uninformative about the surface, and make samples look closer
/// than they are.
struct DistinctPoints {
  Points points;              ///< 3 x M, each position once, in the order of the first copies
  std::vector<int> index_of;  ///< N, the column of points that holds each original point
  std::vector<int> first_of;  ///< M, the first copy of each distinct point

  /// \param all 3 x N, finite.
  explicit DistinctPoints(const PointsRef& all) : points(3, all.cols()), index_of(firstCopies(all)) {
    for (int i = 0; i < static_cast<int>(index_of.size()); ++i) {
      const int first = index_of[i], size = static_cast<int>(first_of.size());
      index_of[i] = first == i ? size : index_of[first];
      if (first != i) continue;
      points.col(size) = all.col(i);
      first_of.push_back(i);
    }
    points.conservativeResize(3, first_of.size());
  }
};

/// Finds the points far from all others, alone or in tiny groups: flying pixels of cameras, outliers of photogrammetry,
/// positions that a driver set to zero. They would inflate the diameter and with it the tolerance.
///
/// Nine tenths of the points lie within some distance of the middle of the cloud; twice that distance is its size.
/// Points beyond that distance by more than a gap are stray if no chain of points with shorter gaps leads back. The gap
/// is two fifths of the size or ten spacings of a surface, so that tails, antennas and sparse samples belong to the
/// cloud. Where more than one point in twenty would be stray, none is.
/// \param points 3 x N; if a point is not finite, none is stray.
/// \return indices of the stray points, ascending.
std::vector<int> strayPoints(const PointsRef& points);

/// \param stray indices, ascending.
/// \return the indices of the other points, ascending.
std::vector<int> allBut(const std::vector<int>& stray, Eigen::Index size);

/// \return 3 x M, the points that are not stray.
Points withoutStrayPoints(const PointsRef& points);

/// Least number of distinct points: with fewer, a symmetry cannot be distinguished from chance.
constexpr int kMinDistinctPoints = 20;

/// Why points cannot be analyzed: too few distinct ones, all at one position, or all on one line (a line is symmetric
/// in every plane that contains it, whatever it was sampled from).
///
/// Positions are compared up to the rounding of the coordinates; a line may be 1e-6 of its length thick.
/// \param points 3 x N, N >= 0, finite.
/// \return one sentence such as "12 distinct points, at least 20 are needed"; empty where the points can be analyzed.
/// \throws std::invalid_argument where a coordinate is not finite.
std::string whyUnanswerable(const PointsRef& points);

}  // namespace pcl_symmetry
