#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Measures how much of one half of a cloud lies on the surface that the other half describes.
///
/// Where noise exceeds the spacing, a point and the surface fitted to it are not independent, and no correction is
/// valid. The reflection of one half by a true plane is a new sample of the same noisy surface as the other half and
/// lies on it exactly as often as the half itself.
class SplitSurface {
public:
  /// \param points 3 x N, finite, N >= 4.
  /// \param seed seed of the random halves.
  SplitSurface(const Points& points, std::uint64_t seed, int num_threads);

  /// \return distances of the first half from the surface of the second, units of the points, >= 0.
  std::vector<float> ownDistances() const { return distances(first_); }
  /// \return distances of the reflections of the first half from the surface of the second, units of the points, >= 0.
  std::vector<float> reflectedDistances(const ReflectionPlane& plane) const;

  /// D of Equation 2 for a true plane under this sampling and noise: f of all points and f of their reflections differ
  /// by noise alone. Halves of the points also differ by noise, but are half as dense, and quarters a quarter as dense:
  /// the loss of D falls by the same factor with each doubling of the points.
  /// \param num_cells,sigma of the distance transform that D is computed from; sigma in units of the points.
  /// \param ball ball that the distance transform covers, frame of the points.
  /// \return in [0.5, 1].
  double ownScore(int num_cells, double sigma, const BoundingBall& ball, int num_threads) const;

private:
  std::vector<float> distances(const Points& points) const;

  std::uint64_t seed_;
  Points first_, second_;
  ClosestPointSearch::Ptr search_;  ///< closest points of the second half
  SurfaceSamples samples_;          ///< the second half
};

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
