#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/base/small_motion.h"
#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/pose_search.h"

namespace pcl_symmetry {

/// A point of a surface that the surface itself does not hide from a scanner.
struct VisiblePoint {
  Eigen::Index index;                ///< index in the order of the surface
  Eigen::Vector3d position, normal;  ///< frame of the scan; the normal has any sign
  double cosine;                     ///< cosine between normal and ray, > 0: its visible area
  /// Height above the measured surface on its ray, along the normal: positive in free space, infinity if the ray met no
  /// surface, and minus infinity if no ray passed.
  double height;
};

/// \param scan a scan, with what its scanner saw.
/// \param num_points number of points of the surface that are examined.
/// \param is_strict also leaves out points that are hidden slightly beside their rays: images made from points have
/// gaps, through which points at the back are visible.
std::vector<VisiblePoint> visiblePoints(const PosedSurface& surface, const PosedSurface& scan,
                                        const Eigen::Isometry3d& T_scan_surface, int num_points, bool is_strict);

/// Measures where two surfaces overlap at a pose, and whether they agree there.
///
/// Points that face the interior of the other surface have to lie on it; points beyond its border may lie anywhere but
/// in free space. Two scans that share a third of their surface are therefore decided as reliably as a scan and a
/// whole model.
/// \param scan,model in search frames, made with exact search.
PoseEvidence poseEvidence(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan);

/// Distances of some points of a surface, in its order, from the discs about their closest points on another surface;
/// the discs are as wide as the local spacing.
std::vector<float> discDistances(const PosedSurface& from, const PosedSurface& to, const Eigen::Isometry3d& T_to_from,
                                 int num_points);

/// \param tolerance diameters.
/// \return whether a motion maps 97 % of a whole model onto itself.
bool isSymmetry(const Eigen::Isometry3d& motion, const PosedSurface& model, double tolerance);

/// \return whether a scan is compatible with a motion being a symmetry of its object.
bool mayBeSymmetry(const Eigen::Isometry3d& motion, const PosedSurface& scan);

/// \return probability that the pose is right, in [0, 1], fitted by test/benchmark/fit_registration.py.
double poseConfidence(const PoseEvidence& evidence);

/// \return one sentence with the evidence against a pose.
std::string doubtOf(const PoseEvidence& evidence);

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
