#pragma once

#include <cstdint>
#include <vector>

#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/closest_point_search.h"

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

}  // namespace pcl_symmetry
