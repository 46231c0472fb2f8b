#pragma once

#include <Eigen/Geometry>

#include "core/registration/posed_surface.h"

namespace pcl_symmetry {

struct SymmetricICPOptions {
  int num_points = 1000;    ///< of the scan, >= 1. chosen: half is less exact, twice takes twice the time
  double reach = 0.1;       ///< greatest distance of corresponding points, unit of the surfaces, > 0
  int max_iterations = 30;  ///< >= 1
  /// Square of the translation and 1 - cosine of the rotation of a step after which no further one is made, >= 0: as in
  /// pcl::Registration.
  double translation_epsilon = 1e-8, rotation_epsilon = 1e-8;
};

/// Iterated closest points with the symmetric objective (Rusinkiewicz 2019; not in the paper): the sum of
/// ((p - q) . (n_p + n_q))^2 over corresponding points p, q. The steps are those of
/// pcl::IterativeClosestPointWithNormals; the closest point of one step shortens the search of the next.
/// \param model normals of any sign.
/// \param start T_model_scan.
/// \return the refined T_model_scan; \p start where less than three points correspond or where they fix no pose.
Eigen::Isometry3d refinedBySymmetricICP(const PosedSurface& scan, const PosedSurface& model,
                                        const Eigen::Isometry3d& start, const SymmetricICPOptions& options);

}  // namespace pcl_symmetry
