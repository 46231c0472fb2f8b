/// Subsets of a cloud: samples, and the points that an analysis can use, which are distinct and not stray, if there are
/// enough of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/lists.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// \throws std::invalid_argument without a point, and for a coordinate that is not finite.
void checkPoints(const PointsRef& points);

/// \return the ball around points, in whose radii squares of points neither overflow nor underflow.
/// \throws std::invalid_argument as checkPoints() does, and for points without extent.
BoundingBall checkedBall(const PointsRef& points);

/// \return at most \p max_count of 0, 1, ..., size - 1 in random order.
std::vector<int> shuffled(Eigen::Index size, std::uint64_t seed,
                          Eigen::Index max_count = std::numeric_limits<Eigen::Index>::max());

/// \return 0, stride, 2 stride, ... below size.
inline std::vector<int> everyNth(Eigen::Index size, Eigen::Index stride) {
  std::vector<int> samples;
  for (Eigen::Index i = 0; i < size; i += stride) samples.push_back(static_cast<int>(i));
  return samples;
}

/// \return at most \p max_count of 0, 1, ..., size - 1, at equal steps.
inline std::vector<int> equalSteps(Eigen::Index size, Eigen::Index max_count) {
  std::vector<int> chosen = allIndices(std::min(size, max_count));
  for (int& i : chosen) i = static_cast<int>(i * size / static_cast<Eigen::Index>(chosen.size()));
  return chosen;
}

/// Draws points without replacement.
/// \param size number of points of the cloud.
/// \return num_samples different indices in random order; all indices in order if size <= num_samples.
inline std::vector<int> drawSamples(Eigen::Index size, int num_samples, std::uint64_t seed) {
  return num_samples >= size ? allIndices(size) : shuffled(size, seed, num_samples);
}

/// Draws one element of each of \p num_drawn equal runs of a sequence.
/// \param size length of the sequence, more than \p num_drawn.
/// \return num_drawn positions in the sequence, ascending.
std::vector<std::size_t> oneOfEachRun(std::size_t size, std::size_t num_drawn, std::uint64_t seed);

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

/// A subset with the density of the cloud: one point from each of equal runs along a curve through cells of a grid.
/// \param points 3 x N, finite.
/// \param size size of the subset, < N.
/// \return different indices in the order of the curve, so that successive points are near each other.
std::vector<int> spreadSubset(const PointsRef& points, std::size_t size, std::uint64_t seed);

/// \return 3 x N, the points reflected in a plane, in their order.
inline Points reflectedPoints(const PointsRef& points, const ReflectionPlane& plane) {
  Points reflected(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    reflected.col(i) = plane.reflect(points.col(i).cast<double>()).cast<float>();
  return reflected;
}

/// \return 3 x N, the normals of points after the points were reflected in a plane.
Points reflectedNormals(const PointsRef& normals, const ReflectionPlane& plane);

/// \return for each point the index of the first one at the same position; NaN equals nothing.
std::vector<int> firstCopies(const PointsRef& points);

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
/// Where others lie beyond that distance by more than a gap, those beyond it are stray if no chain of points with
/// shorter gaps leads back. The gap is ten spacings of a surface, and at least a tenth of the size, so that tails,
/// antennas and sparse samples belong to the cloud. Where more than one point in twenty would be stray, none is.
/// \param points 3 x N; if a point is not finite, none is stray.
/// \return indices of the stray points, ascending.
std::vector<int> strayPoints(const PointsRef& points);

/// \param stray indices, ascending.
/// \return the indices of the other points, ascending.
std::vector<int> complementOf(const std::vector<int>& stray, Eigen::Index size);

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
