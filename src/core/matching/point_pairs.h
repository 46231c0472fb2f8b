#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// What tells pairs of points with their normals apart (Drost et al. 2010; not in the paper).

// Step of the logarithm of a distance. chosen: 16 %, as the points of a shape are apart; half misses pairs, twice finds
// twice as many that do not fit.
constexpr double kPairDistanceStep = 0.15;
// Angles between the first normal and the line of a pair, of any sign, and of the second normal and between both
// normals, without sign. chosen: 15 degrees a step, see kPairDistanceStep.
constexpr int kPairAngles = 12, kPairOtherAngles = 6;

/// Two points with their normals.
struct PointPair {
  double log_distance;       ///< in steps
  double angle;              ///< between the first normal and the line, in steps
  int other_angle, between;  ///< steps
  std::uint8_t turn;         ///< of the second point about the first normal, in 1/256
};

/// A point with its normal as a frame: the normal, and two directions across it.
Eigen::Matrix3d frameOf(const Eigen::Vector3d& normal);

/// \param frame of the first point.
/// \param second another place than \p first.
PointPair pairOf(const Eigen::Matrix3d& frame, const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                 const Eigen::Vector3d& second_normal);

/// Pairs of one point with all points of its surface.
struct PairRow {
  std::vector<float> distance;                                           ///< radii
  std::vector<int> distance_step, angle_step, other_step, between_step;  ///< valid where distance > 0
  std::vector<int> turn;                                                 ///< 1/256
};

/// Points whose pairs are all told apart: what pairOf() finds for each, many at once.
class PairedSurface {
public:
  /// \param normals unit.
  /// \param radius unit of the distances, > 0.
  PairedSurface(const PointsRef& points, const PointsRef& normals, double radius);

  /// Pairs of point \p i, the first of each pair.
  void fillRow(int i, PairRow& row) const;

private:
  /// Coordinates, one behind the other.
  struct Columns {
    std::vector<float> x, y, z;
  };

  Columns points_, normals_;
  int first_step_;                   // of distances, below the shortest one
  std::vector<float> sq_distances_;  // where each further step begins
};

}  // namespace pcl_symmetry
