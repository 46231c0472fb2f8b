#pragma once

#include <Eigen/Geometry>

#include "core/base/small_motion.h"
#include "core/registration/posed_surface.h"

namespace pcl_symmetry {

/// The uncertainty of a pose from least squares of point-to-plane distances: the inverse of their Hessian, corrected
/// for noise of the normals, times their mean square. An unconstrained direction has the variance of an unknown pose: a
/// uniform rotation, or a translation by a radius.
/// \param scan,model each about its own center, in units of the model's radius.
/// \param num_points number of points of the scan that the pose was fitted to, >= 1.
/// \param reach greatest distance of points that corresponded, > 0, radii.
/// \return covariance of the motion of the model's frame that corrects the pose; radians and radii.
Matrix6d poseCovariance(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan,
                        int num_points, double reach);

}  // namespace pcl_symmetry
