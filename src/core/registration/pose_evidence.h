#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/pose_search.h"

namespace pcl_symmetry {

/// Measures where two surfaces overlap at a pose, and whether they agree there.
///
/// Points that face the inside of the other surface have to lie on it; points beyond its border may lie anywhere that
/// its scanner did not see to be empty. So a pose of two scans that share a third of their surface is decided as surely
/// as that of a scan on a whole model.
/// \param scan,model in search frames, made with exact search.
PoseEvidence poseEvidence(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan);

/// Distances of some points of a surface, in its order, from the discs about their closest points of another one, each
/// as wide as points are apart there.
std::vector<float> discDistances(const PosedSurface& from, const PosedSurface& to, const Eigen::Isometry3d& T_to_from,
                                 int num_points);

/// \param tolerance diameters.
/// \return whether a motion brings a whole model, but for a few points, onto itself.
bool isSymmetry(const Eigen::Isometry3d& motion, const PosedSurface& model, double tolerance);

/// \return whether what a scan shows leaves open that a motion is a symmetry of its object.
bool mayBeSymmetry(const Eigen::Isometry3d& motion, const PosedSurface& scan);

/// \return probability that the pose is right, in [0, 1], fitted by test/benchmark/fit_registration.py.
double poseConfidence(const PoseEvidence& evidence);

/// \return one sentence on what counts against a pose.
std::string doubtOf(const PoseEvidence& evidence);

}  // namespace pcl_symmetry
