#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/registration/pose_scoring.h"

namespace pcl_symmetry {

struct PoseSearchOptions {
  int num_rotations = 1000;     ///< spread evenly over all rotations, tried beside the hypotheses, >= 0
  int num_screened = 60;        ///< of all starts, best first, that are improved coarsely, >= 1
  int num_refined = 20;         ///< of these, best first, that are improved finely, >= 1
  int max_poses = 4;            ///< returned, >= 1
  double coarse_width = 0.25;   ///< of the Gaussian in radii of the model, > 0, at the start ...
  double fine_width = 0.05;     ///< ... and at the end, > 0
  double merge_angle = 0.2;     ///< radians, >= 0: poses closer than this ...
  double merge_distance = 0.1;  ///< ... and this, in radii, are one, >= 0
  int num_threads = 0;          ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct RankedPose {
  Eigen::Isometry3d T_model_scan = Eigen::Isometry3d::Identity();
  PoseScore score;
};

/// Rotations spread evenly (super-Fibonacci spirals, Alexa 2022): the largest gap is about 160 / cbrt(n) degrees.
std::vector<Eigen::Matrix3d> uniformRotations(int num_rotations);

/// The translation that puts a turned scan where the model would have to be to be seen so: its outline as seen by the
/// scanner in the middle of the model's, its front at the model's front. Without a viewpoint the centers of mass meet.
Eigen::Isometry3d poseFromRotation(const Eigen::Matrix3d& R_model_scan, const PosedSurface& scan,
                                   const PosedSurface& model);

/// From hypotheses to a few distinct poses, best first: screened by score, improved by Gauss-Newton steps with a
/// shrinking Gaussian.
/// \param scan,model in frames of their own, in units of the model's radius, each about its own center.
/// \param hypotheses poses to try first, for instance of frames by symmetry: they are all improved.
std::vector<RankedPose> searchPoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<Eigen::Isometry3d>& hypotheses,
                                    const PoseSearchOptions& options = {});

}  // namespace pcl_symmetry
