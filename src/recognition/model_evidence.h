#pragma once

#include <Eigen/Geometry>

#include "core/registration/posed_surface.h"
#include "pcl_symmetry/symmetry_database.h"

namespace pcl_symmetry::detail {

/// Steps of least squares that bring the visible surface of a model onto what a scanner measured along the same rays,
/// also beside the points of the scan: what was cut off from an object helps to pose it.
/// \param scan with what its scanner saw.
/// \return T_model_scan.
Eigen::Isometry3d posedInPicture(const PosedSurface& scan, const PosedSurface& model,
                                 const Eigen::Isometry3d& T_model_scan);

/// What speaks for a model at a pose.
/// \param scan made with exact search, as \p model.
ModelEvidence modelEvidence(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan);

}  // namespace pcl_symmetry::detail
