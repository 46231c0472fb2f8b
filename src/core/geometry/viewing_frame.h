#pragma once

#include <Eigen/Geometry>

namespace pcl_symmetry {

/// The axes of a camera: a right-handed frame whose third axis looks along a direction. The turn about that direction
/// is arbitrary, but the same for the same direction.
/// \param forward unit vector, input frame.
/// \return rotation R_camera_input: rows right, down and forward in the input frame.
inline Eigen::Matrix3d viewingFrame(const Eigen::Vector3d& forward) {
  Eigen::Matrix3d R_camera_input;
  R_camera_input.row(2) = forward;
  R_camera_input.row(0) = forward.unitOrthogonal();
  R_camera_input.row(1) = forward.cross(R_camera_input.row(0).transpose());
  return R_camera_input;
}

}  // namespace pcl_symmetry
