#pragma once

#include <Eigen/Geometry>

#include "core/base/small_motion.h"
#include "core/registration/posed_surface.h"

namespace pcl_symmetry {

/// \return the matrix that multiplies v to x x v.
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& x);

/// \return the matrix that maps a small motion (rotation vector, translation) of frame A to that of frame B.
/// \param T_b_a maps points of A to B.
Matrix6d adjoint(const Eigen::Isometry3d& T_b_a);

/// The uncertainty of a pose from least squares of point-to-plane distances: the inverse of their Hessian, corrected
/// for noise of the normals, times their mean square. An unconstrained direction has the variance of an unknown pose: a
/// uniform rotation, or a translation by a radius.
/// \param scan,model each about its own center, in units of the model's radius.
/// \param num_points number of points of the scan that the pose was fitted to, >= 1.
/// \param reach greatest distance of points that corresponded, > 0, radii.
/// \return covariance of the motion of the model's frame that corrects the pose; radians and radii.
Matrix6d poseCovariance(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan,
                        int num_points, double reach);

/// Least squares in a small motion (rotation vector, translation).
class MotionEquations {
public:
  /// \param unit unit of the lengths, > 0, in which rotations and translations have equal weight.
  explicit MotionEquations(double unit) : unit_(unit) {}

  /// Adds w (n . (x + rotation x x + translation) - n . y)^2.
  void addPlane(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& n, double weight) {
    of_planes_.add(x.cross(n) / unit_, n, n.dot(y - x) / unit_, weight);
  }

  /// Adds w |x + rotation x x + translation - y|^2, the sum of addPlane() over three perpendicular normals.
  void addPoint(const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
    of_points_.add(x / unit_, (y - x) / unit_, 1.0, weight);
  }

  /// The least-squares motion, without motion along unconstrained directions.
  Eigen::Isometry3d motion() const;

private:
  double unit_;
  WeightedProducts of_planes_;  // rows of lever, normal and distance
  WeightedProducts of_points_;  // rows of arm, displacement and 1
};

}  // namespace pcl_symmetry
