#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of publishedPlanes(); the defaults are the paper's.
struct PublishedOptions {
  LocalMaximaOptions maxima;     ///< thresholds of radius and Laplacian
  int num_points = 10'000;       ///< reflected, >= 10; drawn once for each maximum, so that the iteration converges
  int max_iterations = 500;      ///< >= 1; maxima that have not converged then are dropped
  int max_maxima = 0;            ///< strongest maxima that are refined, >= 0; 0 = all
  bool discard_unstable = true;  ///< drops maxima that run to another one; false keeps all where they end
  std::uint64_t seed = 1;        ///< of the points drawn
  int num_threads = 0;           ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Section 4.4 as the paper has it, readable in one go; detectPlanes() is the default and adds what follows. Each local
/// maximum of the map is refined by Iterative Symmetric Points with the closed form for pairs of points, weights of
/// constant width sigma and closest points by FLANN, until it converges. The paper discards a plane that leaves its
/// cell, which protects from a refinement that runs to another maximum: here a plane is discarded once its bin is
/// neither a neighbor of its maximum nor led to it by steepest ascent, and of planes that end in one bin the first
/// stays. Nothing is added or decided: kind is PlaneKind::Approximate, confidence 0, and the share, its limits and the
/// deviation, which only the decision measures, are NaN.
///
/// Departure from the paper: maxima of a map by voting are those of means over neighbors, because its bins have few
/// votes.
/// \param points 3 x N, finite, input units.
/// \param edt,map of these points, by any estimator; the paper's has 64 x 64 x 64 bins.
/// \return by falling score D; `support` is the mean weight of the pairs, `residual` as that of SymmetryPlane.
/// \throws std::invalid_argument for bad options.
std::vector<SymmetryPlane> publishedPlanes(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                                           const PublishedOptions& options = {});

/// The map that the paper's applications begin with: 64 x 64 x 64 bins in the ball of the EDT.
/// \param method exact (Section 4.2), sampled, or voting (Section 4.3) by two million pairs, near ones plane first.
SymmetryMap publishedMap(const PointsRef& points, const GaussianEdt& edt,
                         TransformMethod method = TransformMethod::Convolution, std::uint64_t seed = 1,
                         int num_threads = 0);

}  // namespace pcl_symmetry
