/// Points that an analysis can use: each position once, none far from all others, and enough of them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// \return for each point the index of the first one at the same position; NaN are equal to nothing.
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
  std::vector<int> first(static_cast<std::size_t>(points.cols()));
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

/// The points without repetitions. Copies of a point are uninformative about the surface, and they hide the distance
/// between its samples.
struct DistinctPoints {
  Points points;              ///< 3 x M, each position once, in the order of the first copies
  std::vector<int> index_of;  ///< N, the column of points that holds each original point

  /// \param all 3 x N, finite.
  explicit DistinctPoints(const PointsRef& all) : points(3, all.cols()), index_of(firstCopies(all)) {
    int size = 0;
    for (int i = 0; i < static_cast<int>(index_of.size()); ++i) {
      const bool is_first = index_of[i] == i;
      if (is_first) points.col(size) = all.col(i);
      index_of[i] = is_first ? size++ : index_of[index_of[i]];
    }
    points.conservativeResize(3, size);
  }
};

/// The points that lie far from all others, alone or in tiny groups: flying pixels of cameras, outliers of
/// photogrammetry, positions that a driver set to zero. They would stretch the diameter that a tolerance is a share of.
///
/// Nine tenths of the points lie within some distance of the middle of the cloud; twice that distance is its size.
/// Points that are farther out than that distance by a gap, and from which no chain of points with shorter gaps leads
/// back, are stray. The gap is two fifths of the size or ten spacings of a surface, so that tails, antennas and sparse
/// samples belong to the cloud. Where more than one point in twenty would be stray, none is.
/// \param points 3 x N; none is stray where one is not finite.
/// \return their indices, rising; mostly none, which a few passes over the points tell.
std::vector<int> strayPoints(const PointsRef& points);

/// \param stray indices, rising.
/// \return the indices of the other points, rising.
std::vector<int> allBut(const std::vector<int>& stray, Eigen::Index size);

/// \return 3 x M, the points without those that are stray.
Points withoutStrayPoints(const PointsRef& points);

/// Fewer distinct points hold no symmetry that could be told from chance.
constexpr int kMinDistinctPoints = 20;

/// Why points hold no answer: too few distinct ones, all at one position, or all on one line (a line is symmetric in
/// every plane that contains it, whatever it was sampled from).
///
/// Positions are compared up to the rounding of the coordinates; a line may be 1e-6 of its length thick.
/// \param points 3 x N, N >= 0, finite.
/// \return one sentence such as "12 distinct points, at least 20 are needed"; empty where the points can be analyzed.
/// \throws std::invalid_argument where a coordinate is not finite.
std::string whyUnanswerable(const PointsRef& points);

}  // namespace pcl_symmetry
