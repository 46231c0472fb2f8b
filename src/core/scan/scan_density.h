#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// How densely points cover their surface, and which viewpoints explain it. Not in the paper.
///
/// A scanner sends its rays evenly over all directions. A surface at distance d whose normal makes an angle a with the
/// ray gets
///     density = c cos(a) / d^2
/// points per area. No viewpoint explains the density of an object that is known from all sides, or was put
/// together from several views.
class ScanDensity {
public:
  /// \param points 3 x N, finite. Large clouds are sampled.
  explicit ScanDensity(const PointsRef& points);

  /// \return variance of log(density d^2 / cos(a)) over the samples between the smallest and the largest tenth;
  /// infinite where the cloud shows no surface. Small if the points were measured from there.
  /// \param viewpoint frame of the points.
  double unexplained(const Eigen::Vector3d& viewpoint) const;

  /// \return variance of the means of log(density d^2 / cos(a)) over 64 patches of the surface, less the variance of
  /// random points. A remainder shows that the points are not one view from there.
  double unexplainedByPatches(const Eigen::Vector3d& viewpoint) const;

  /// \return whether the surface bulges toward a viewer: normals oriented toward the viewer point away from the middle
  /// of the surface.
  /// \param viewpoint frame of the points.
  bool bulgesToward(const Eigen::Vector3d& viewpoint) const;

  /// \return the variance of log(density), which a viewpoint has to explain.
  double variance() const { return varianceOf(samples_.cols()); }

  /// \return the variance of log(density) of random points, which no viewpoint explains.
  double varianceAtRandom() const { return 1.0 / num_neighbors_; }

  /// \return the viewpoint that explains most, up to 30 radii away, frame of the points; nothing if no direction comes
  /// close to explaining the density.
  std::optional<Eigen::Vector3d> bestViewpoint() const;

  /// \return viewpoints at minima of the unexplained variance that leave at most \p max_unexplained, the most likely
  /// direction first. Two flat pieces are as dense from several positions.
  std::vector<Eigen::Vector3d> viewpoints(double max_unexplained) const;

  /// \return a ball around the points.
  const BoundingBall& ball() const { return ball_; }

private:
  template <typename Value>
  double trimmedVariance(Eigen::Index num_samples, const Value& value) const;
  float residual(Eigen::Index i, const Eigen::Vector3f& eye) const;
  double varianceOf(Eigen::Index num_samples) const;
  double unexplainedFrom(const Eigen::Vector3d& eye, Eigen::Index num_samples) const;
  struct Candidate;
  std::vector<Candidate> coarseMinima(std::size_t max_count) const;
  Candidate refine(Candidate start, double first_step, double last_step, Eigen::Index num_samples) const;

  BoundingBall ball_;
  Eigen::Index num_points_ = 0;  // number of points used
  int num_neighbors_ = 1;        // neighbors for each density
  Points samples_;               // points on the surface, in radii about the center, in random order
  Points normals_;               // unit, of arbitrary sign
  std::vector<float> log_density_;
};

}  // namespace pcl_symmetry
