/// How wide the Gaussian of the distance transform is (Section 4.1), in space and in the plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/base/statistics.h"
#include "core/geometry/usable_points.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

// Width of the Gaussian in cells, unless the points are sparse. The paper: "according to the maximal frequency of the
// grid in order to avoid aliasing". At one cell look-ups alias, at four the peaks of D are twice as wide.
constexpr double kSigmaInCells = 2.0;
// Empty margin around the ball: f = exp(-2^2) = 0.018 at most outside the grid
constexpr double kMarginInSigmas = 2.0;
// Distance beyond which f is 0: f = exp(-2.6^2) = 1.16e-3 there, less than 3e-4 of its integral lies beyond
constexpr double kReachInSigmas = 2.6;
// Greatest width for sparse points, of the radius: a surface of a dozen points has no gaps, and the shape is no ball.
constexpr double kMostSpacing = 0.25;

/// The ball that a grid of cells covers.
/// \param given taken where its radius is > 0; otherwise the ball around the points is, without stray ones.
/// \throws std::invalid_argument without a point, for a value that is not finite, and for a ball without extent.
inline BoundingBall coveredBall(const PointsRef& points, const BoundingBall& given) {
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
  const BoundingBall ball = given.radius > 0.0 ? given : boundingBall(withoutStrayPoints(points));
  if (!(ball.radius > std::numeric_limits<float>::epsilon() * ball.center.norm()))
    throw std::invalid_argument("points: all at one place, must have an extent");
  return ball;
}

/// Typical distance between neighboring samples: twice the median distance to the nearest other point, over a fixed
/// number of probes. For random samples this is 0.94 / sqrt(density) on a surface, and the median gap on a curve.
/// \param points 2 x N or 3 x N, finite.
/// \return input units; 0 if all points coincide.
template <typename PointMatrix>
double sampleSpacing(const PointMatrix& points) {
  // A standard error of 13 % for random samples of a surface; 18 % for half as many, 9 % for twice as many
  constexpr Eigen::Index kNumProbes = 32;
  const Eigen::Index size = points.cols(), num_probes = std::min(kNumProbes, size);
  std::vector<double> nearest;
  for (Eigen::Index k = 0; k < num_probes; ++k) {
    float sq_nearest = std::numeric_limits<float>::max();
    for (Eigen::Index i = 0; i < size; ++i) {
      const float sq_distance = (points.col(i) - points.col(k * size / num_probes)).squaredNorm();
      if (sq_distance > 0.0f) sq_nearest = std::min(sq_nearest, sq_distance);
    }
    if (sq_nearest < std::numeric_limits<float>::max()) nearest.push_back(std::sqrt(static_cast<double>(sq_nearest)));
  }
  return nearest.empty() ? 0.0 : 2.0 * median(std::move(nearest));
}

}  // namespace pcl_symmetry
