#pragma once

#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"

namespace pcl_symmetry {

/// Density of points that do not resolve a surface: noise beyond their spacing, or too few of them.
///
/// Where every point has neighbours on all sides, closest points and normals mean nothing. The points are then a sample
/// of a density, and a plane is judged by how well the density meets its own reflection.
class PointDensity {
public:
  /// \param points 3 x N. \param bandwidth standard deviation of the Gaussian around each point, same units, > 0.
  PointDensity(const PointsRef& points, double bandwidth, int num_threads);

  /// Mean over samples of the density at their reflections, divided by that at the samples themselves without their own
  /// part: about 1 for a symmetry whatever the noise and the number of points, as a reflected sample is then a new
  /// sample of the same density.
  double overlap(const PointsRef& samples, const ReflectionPlane& plane) const;

  /// Newton steps to the nearest maximum of overlap(). \param iterations filled with the steps taken.
  ReflectionPlane refine(const PointsRef& samples, const ReflectionPlane& plane, int max_iterations,
                         int& iterations) const;

private:
  float at(const Eigen::Vector3f& x) const;

  double bandwidth_;
  Eigen::Vector3f origin_;
  float cell_size_;
  Eigen::Array3i size_;
  std::vector<float> values_;
  double own_part_;  // of a sample in the density at its place
  double mean_;      // over the points, without their own parts
  Eigen::Vector3d middle_;
  double extent_;
};

}  // namespace pcl_symmetry
