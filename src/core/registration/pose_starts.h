#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

/// Rotations spread evenly over all rotations (super-Fibonacci spirals, Alexa 2022).
/// \param num_rotations n >= 0.
/// \return n rotations; every rotation is within about 160 / cbrt(n) degrees of one of them.
std::vector<Eigen::Matrix3d> uniformRotations(int num_rotations);

/// Completes rotations to poses: the translation puts a rotated scan where the model would look like it to the scanner.
///
/// As seen by the scanner, the middle of the scan's outline is put on the middle of the model's, and the front of the
/// scan on the front of the model. Without a viewpoint, the centers of mass are aligned.
class PoseStarts {
public:
  PoseStarts(const PosedSurface& scan, const PosedSurface& model);

  Eigen::Isometry3d pose(const Eigen::Matrix3d& R_model_scan) const;

private:
  bool from_outline_;
  Eigen::Matrix3Xd model_;
  Eigen::Matrix3d R_scanner_scan_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d scan_anchor_, model_anchor_ = Eigen::Vector3d::Zero();
};

/// The poses that align the symmetry frame of one cloud with that of another, in all ways that symmetry allows (Section
/// 5.1).
///
/// The axes of \p b may have any order and any signs that form a rotation: 24 ways for every equally good frame of \p a
/// that is a maximum. About an axis of revolution of \p a, the poses differ by steps of 45 degrees: between a scan and
/// a whole object, the handle of a mug may be hidden.
/// \param a,b frames of two clouds, each in its own input frame.
/// \return T_b_a; poses whose rotation is within 10 degrees of an earlier one are left out.
std::vector<Eigen::Isometry3d> frameHypotheses(const SymmetryFrame& a, const SymmetryFrame& b);

}  // namespace pcl_symmetry
