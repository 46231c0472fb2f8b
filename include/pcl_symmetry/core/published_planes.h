#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of publishedPlanes(); the defaults are the paper's.
struct PublishedOptions {
  LocalMaximaOptions maxima;  ///< thresholds of radius and Laplacian
  int num_points = 10'000;    ///< points reflected for each maximum, >= 10; drawn once, so that the iteration converges
  int max_iterations = 500;   ///< limit of the iterations, >= 1; maxima that have not converged by then are dropped
  int max_maxima = 0;         ///< strongest maxima that are refined, >= 0; 0 = all
  bool discard_unstable = true;  ///< drops maxima whose refinement runs to another one; false keeps all where they end
  std::uint64_t seed = 1;        ///< seed of the points drawn
  int num_threads = 0;           ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Finds planes exactly as in Section 4.4; detectPlanes(), the default, adds further steps. Each local maximum of the
/// map is refined by Iterative Symmetric Points with the closed form for pairs of points, weights of constant width
/// sigma and closest points by FLANN, until it converges. The paper discards a plane that leaves its cell, which
/// protects against a refinement that runs to another maximum: here a plane is discarded once its bin is neither a
/// neighbor of its maximum nor led to it by steepest ascent, and of planes that end in the same bin only the first is
/// kept. Nothing is added or decided: kind is PlaneKind::Approximate, confidence 0, and the share, its limits and the
/// deviation, which only the decision measures, are NaN.
///
/// Departure from the paper: for a map made by voting, maxima are searched in averages over neighboring bins, because
/// single bins have few votes.
/// \param points 3 x N, finite, input units.
/// \param edt,map distance transform and map of these points, by any estimator; the paper's map has 64 x 64 x 64 bins.
/// \return planes by decreasing D; `support` is the mean weight of the pairs, `residual` is defined as in
/// SymmetryPlane.
/// \throws std::invalid_argument for bad options.
std::vector<SymmetryPlane> publishedPlanes(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                                           const PublishedOptions& options = {});

/// The map that the paper's applications begin with: 64 x 64 x 64 bins in the ball of the EDT.
/// \param method exact (Section 4.2), sampled, or voting (Section 4.3) with two million pairs, close ones drawn plane
/// first.
SymmetryMap publishedMap(const PointsRef& points, const GaussianEdt& edt,
                         TransformMethod method = TransformMethod::Convolution, std::uint64_t seed = 1,
                         int num_threads = 0);

}  // namespace pcl_symmetry
