#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The convex outline of points that are seen along an axis: how people may have turned the shape about that axis.
/// Not in the paper. Where no second plane is a symmetry, people level what the shape stands on.
class Outline {
public:
  /// \param points 3 x N, N >= 1.
  /// \param along unit, the axis that the points are seen along.
  Outline(const PointsRef& points, const Eigen::Vector3f& along);

  /// \return the unit vector across the axis at an angle, radians.
  Eigen::Vector3f direction(double angle) const;
  /// \return the angle of the part of a vector across the axis.
  double angleOf(const Eigen::Vector3f& vector) const;

  /// The box around the outline with sides at an angle and a quarter turn ahead.
  struct Box {
    double area = 0.0;     ///< input units squared
    double contact = 0.0;  ///< longest stretch of a side that the shape touches, as a share of the longer side
  };
  Box boxAt(double angle) const;

private:
  Eigen::Vector3f u_, v_;
  std::vector<Eigen::Vector2f> corners_;  // of the outline, in order
};

}  // namespace pcl_symmetry
