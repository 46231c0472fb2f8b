/// How far a registration is from the truth, up to the proper rotations that map the model onto itself.
#pragma once

#include <Eigen/Geometry>

#include "evaluate/references/reference_symmetries.h"

namespace pcl_symmetry::apps {

struct MotionError {
  double angle = 0.0;     ///< radians, in [0, pi]
  double distance = 0.0;  ///< at the center of the model, input units

  bool within(double max_angle, double max_distance) const { return angle <= max_angle && distance <= max_distance; }
};

/// Error of the motion that comes closest to being right.
///
/// Two planes of symmetry make a rotation about their common line, and every rotation that a finite set of planes
/// generates is made by two of them. About an axis of revolution any angle is right, and a half turn of it where a
/// plane lies across; about the center of a sphere any rotation is.
/// \param T_model_scan the answer.
/// \param
/// T_model_scan_true the truth.
/// \param symmetries of the model, in its frame.
MotionError motionError(const Eigen::Isometry3d& T_model_scan, const Eigen::Isometry3d& T_model_scan_true,
                        const ReferenceSymmetries& symmetries);

}  // namespace pcl_symmetry::apps
