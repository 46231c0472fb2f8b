#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/registration/posed_surface.h"

namespace pcl_symmetry {

/// Rotations spread evenly over all rotations (super-Fibonacci spirals, Alexa 2022).
/// \param num_rotations n >= 0.
/// \return n rotations; every rotation is within about 160 / cbrt(n) degrees of one of them.
std::vector<Eigen::Matrix3d> uniformRotations(int num_rotations);

/// Completes rotations to poses: the translation puts a turned scan where the model has to be to be seen so.
///
/// As seen by the scanner, the middle of the scan's outline is put on the middle of the model's, and the front of the
/// scan on the front of the model. Without a viewpoint the centers of mass meet.
class PoseStarts {
public:
  PoseStarts(const PosedSurface& scan, const PosedSurface& model);

  /// \return T_model_scan of this rotation.
  Eigen::Isometry3d pose(const Eigen::Matrix3d& R_model_scan) const;

private:
  bool from_outline_;
  Eigen::Matrix3Xd model_;
  Eigen::Matrix3d R_scanner_scan_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d scan_anchor_, model_anchor_ = Eigen::Vector3d::Zero();
};

}  // namespace pcl_symmetry
