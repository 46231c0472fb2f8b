#pragma once

#include <functional>
#include <vector>

#include "core/refinement/landing.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// How Iterative Symmetric Points moves the plane.
enum class IspUpdate {
  PointToPoint,  ///< the paper's: minimizes the weighted squared distances of the pairs, in closed form
  PointToPlane   ///< minimizes distances across the surface by a Gauss-Newton step; converges in far fewer iterations
};

/// Options of Iterative Symmetric Points (Section 4.4).
struct IspOptions {
  IspUpdate update = IspUpdate::PointToPlane;  ///< what a step minimizes
  double sigma = 0.0;        ///< width of the Gaussian weights exp(-dist^2 / sigma^2) at the start, input units, > 0
  double final_sigma = 0.0;  ///< width at the end, input units, in (0, sigma]; halved whenever the plane comes to rest
  int max_iterations = 30;   ///< limit of the iterations, >= 1
  /// Standard errors of the plane, residual / sqrt(number of samples), below which a step ends the iteration, >= 0; a
  /// plane that does not move has converged, too. After that, changing matches keep the plane of a sampled surface in
  /// motion without improving it.
  double settled_errors = 0.5;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Input and result of one iteration: everything needed to draw it (Figure 7).
struct IspStep {
  ReflectionPlane plane;            ///< the plane after the step
  double residual = 0.0;            ///< weighted root mean square distance of the pairs before the step, input units
  double weight = 0.0;              ///< mean weight of the pairs, in [0, 1]
  std::vector<int> closest;         ///< index of the closest point to each sample's reflection; -1: none within 3 sigma
  std::vector<float> sq_distances;  ///< squared distances to the closest points; infinite where there is none
};

/// A refined plane.
struct IspResult {
  ReflectionPlane plane;   ///< where the steps ended, input frame
  int iterations = 0;      ///< number of steps
  bool converged = false;  ///< whether the last step was shorter than the tolerance
  IspStep last;            ///< the last iteration; its distances were measured before its step
};

/// The plane that minimizes sum w |x' - y|^2 over pairs (x, y) of a sample and the closest point to its reflection x'.
///
/// sum w |x' - y|^2 = const + 4 sum w (n.x - r)(n.y - r). Hence r = n.m with m the weighted mean of (x + y) / 2, and n
/// is the eigenvector of the smallest eigenvalue of sum w [(x - m)(y - m)^T + (y - m)(x - m)^T] / 2.
/// \param x,y 3 x M.
/// \param weights M values >= 0.
/// \return \p fallback where all weights are 0.
ReflectionPlane fitReflectionPlane(const PointsRef& x, const PointsRef& y, const std::vector<double>& weights,
                                   const ReflectionPlane& fallback);

/// One iteration of Iterative Symmetric Points (Section 4.4): reflect, match, weight, move the plane.
/// \param samples indices of the points of the surface to reflect.
/// \param plane,sigma in the units of the surface.
/// \param guesses IspStep::closest of a plane nearby, which makes the search faster; null = not known.
IspStep iterateSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                               double sigma, IspUpdate update, const std::vector<int>* guesses = nullptr);

/// The first half of an iteration: reflect, match, weight. The plane of the result is \p plane.
/// \param samples,plane,sigma,guesses as in iterateSymmetricPoints().
IspStep matchSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                             double sigma, const std::vector<int>* guesses = nullptr);

/// Iterates until the plane stands still (Section 4.4).
/// \param samples indices of the points of the surface to reflect.
/// \param plane where iteration starts.
/// \param stays whether to continue from a plane; iteration ends at the first plane for which it is false. Null: always
/// true.
/// \throws std::invalid_argument for bad options.
IspResult refineSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples,
                                const ReflectionPlane& plane, const IspOptions& options,
                                const std::function<bool(const ReflectionPlane&)>& stays = nullptr);

}  // namespace pcl_symmetry
