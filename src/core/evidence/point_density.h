#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Density of points that do not resolve a surface: noise beyond their spacing, or too few of them.
///
/// Where every point has neighbors on all sides, closest points and normals are meaningless. The points are then a
/// sample of a density, and a plane is judged by how well the density agrees with its own reflection.
class PointDensity {
public:
  /// \param points 3 x N, finite, N >= 1.
  /// \param bandwidth standard deviation of the Gaussian around each point, units of the points, > 0.
  PointDensity(const PointsRef& points, double bandwidth, int num_threads);

  /// Mean density at the reflections of samples, divided by the mean density at the points that other points
  /// contribute.
  ///
  /// A reflected sample of a symmetric density is a new sample of the same density, whatever the noise and the number
  /// of points: the overlap is then about 1.
  /// \param samples 3 x M, M >= 1, some of the points.
  /// \return >= 0.
  double overlap(const PointsRef& samples, const ReflectionPlane& plane) const;

  struct Refined {
    ReflectionPlane plane;
    int iterations;  ///< Newton steps taken
  };

  /// Newton steps to the nearest maximum of overlap().
  /// \param samples as in overlap().
  /// \param max_iterations >= 1; fewer are made if the plane converges.
  Refined refine(const PointsRef& samples, const ReflectionPlane& plane, int max_iterations) const;

private:
  void spread(const PointsRef& points);
  double blur(double bandwidth, int num_threads);
  float at(const Eigen::Vector3f& x) const;

  double bandwidth_;
  Eigen::Vector3f origin_;  ///< center of the first cell
  float cell_size_;
  Eigen::Array3i size_;  ///< cells along each axis
  std::vector<float> values_;
  double mean_;  ///< mean density at the points, without their own contributions
  Eigen::Vector3d middle_;
  double extent_;  ///< root mean square distance of the points from the middle
};

}  // namespace pcl_symmetry
