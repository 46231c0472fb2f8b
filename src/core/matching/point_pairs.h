#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// What distinguishes pairs of points with their normals (Drost et al. 2010; not in the paper).

// Step of the logarithm of a distance: 16 %, the spacing of the points of a shape.
constexpr double kPairDistanceStep = 0.15;
// Steps of 15 degrees of the angle between the first normal and the line, and of the angles of the second normal with
// the line and the first normal, which have no sign.
constexpr int kPairAngles = 12, kPairOtherAngles = 6;

/// Two points with their normals.
struct PointPair {
  double log_distance;       ///< in steps
  double angle;              ///< between the first normal and the line, in steps
  int other_angle, between;  ///< steps
  std::uint8_t rotation;     ///< of the second point about the first normal, in 1/256 of a full one
};

/// A point with its normal as a frame: the normal, and two directions perpendicular to it.
Eigen::Matrix3d frameOf(const Eigen::Vector3d& normal);

/// \param frame of the first point.
/// \param second another point than \p first.
PointPair pairOf(const Eigen::Matrix3d& frame, const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                 const Eigen::Vector3d& second_normal);

/// Pairs of one point with all points of its surface.
struct PairRow {
  Eigen::ArrayXf distance;                                             ///< radii
  Eigen::ArrayXi distance_step, angle_step, other_step, between_step;  ///< valid where distance > 0
  Eigen::ArrayXi rotation;                                             ///< 1/256
};

/// What pairOf() finds for all pairs of points of a surface, many at once.
class PairedSurface {
public:
  /// \param normals unit.
  /// \param radius unit of the distances, > 0.
  PairedSurface(const PointsRef& points, const PointsRef& normals, double radius);

  /// Pairs of point \p i, the first of each pair.
  PairRow row(int i) const;

private:
  Eigen::ArrayX3f points_, normals_;  // one a row
  int first_step_;                    // of distances, below the shortest one
  std::vector<float> sq_distances_;   // where each further step begins
};

}  // namespace pcl_symmetry
