#pragma once

#include "core/base/constants.h"

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct RegistrationRules {
  // Starts from frames
  int num_rotations = 8;  ///< rotations about an axis of revolution: steps of 45 degrees
  /// Angle within which rotations count as one, radians: the search reaches farther.
  double same_rotation = 10.0 * kDegree;

  // Steps
  /// Share of the greatest diagonal entry that is added to the diagonal, so that unconstrained directions do not move.
  double relative_inertia = 1e-4;
  double inertia = 1e-6;        ///< constant added to the diagonal
  double min_deviation = 1e-7;  ///< least standard deviation of a residual, radii: the rounding of floats

  // Merit of a pose
  float normal_share = 0.7f;  ///< share of a point's support that depends on its normal
  /// Weight of a residual along the surface, so that poses do not slide away on plain surfaces.
  double point_share = 0.1;
  /// Least share of the model's points that conflicts are divided by, even if the scan judges fewer.
  double min_judged = 0.05;
  double silhouette_share = 0.5;  ///< weight of a model point in free space relative to a point of the scan

  // Search
  int screen_points = 80;   ///< points of each cloud for screening
  int coarse_points = 120;  ///< points of each cloud for coarse improvement
  int fine_points = 400;    ///< points of each cloud for fine improvement
  /// Width of the Gaussian, radii: half the gap between 1000 rotations at the rim, and as much for the positions.
  double screen_width = 0.2;
  int num_steps = 10;           ///< steps over which the Gaussian narrows, in the coarse and in the fine improvement
  int outline_points = 200;     ///< points of the model that give its outline
  double coarse_width = 0.25;   ///< width of the Gaussian at the start, radii
  double fine_width = 0.05;     ///< width of the Gaussian at the end, radii
  double merge_angle = 0.2;     ///< angle, radians; poses within this and merge_distance are one
  double merge_distance = 0.1;  ///< distance, radii; poses within this and merge_angle are one

  // Poses of clouds that share a part, if no other pose is convincing
  double min_confidence = 0.5;  ///< least confidence of a convincing pose, as in CloudRegistration::converged()
  int num_part_poses = 12;      ///< number of poses from pairs of points
  int part_steps = 3;           ///< steps of the first fit of these poses
  double part_width = 0.1;      ///< width of the Gaussian at the start of that fit, radii

  // Evidence of a pose
  int evidence_points = 3000;      ///< points of each cloud that are examined
  double tight_tolerance = 0.004;  ///< least distance within which surfaces agree, diameters of the smaller cloud
  double tight_noises = 4.0;       ///< least distance within which surfaces agree, deviations of the noisier cloud
  double facing_spacings = 1.5;    ///< distance between a point and the middle of the disc that it faces, spacings
  /// Greatest distance of a surface that a point faces, diameters of the smaller cloud; farther ones are another layer.
  double facing_reach = 0.05;
  double min_noise = 0.0015;  ///< least noise, diameters, of a close depth camera; less is no evidence for a pose
  double max_noise = 0.01;    ///< greatest noise, diameters: more is the curvature between few points
  double other_unit = 5.0;    ///< ratio of diameters above which a wrong unit is suspected
  /// Distance within which a surface that should be visible counts as measured, diameters.
  double near_tolerance = 0.02;
  double min_cosine = 0.17;    ///< least cosine between ray and normal of a point that should be visible: 80 degrees
  double hidden_depth = 0.08;  ///< depth behind the front of a surface at which its points are hidden, radii
  int min_visible = 20;        ///< least number of points that should be visible; fewer are uninformative
  double some_not_measured = 0.1;   ///< share of the surface above which doubtOf() mentions that it was not measured
  double agreeing_cosine = 0.7071;  ///< least cosine between normals of one surface: 45 degrees
  double like_merit = 0.05;         ///< deficit in merit to the best pose up to which a pose may be right
  /// Share of the best odds above which a pose counts as equally likely, because sampling changes odds; the same of
  /// poses beside the best one, whose odds depend on how the bodies fit.
  double like_odds = 0.5, beside_odds = 0.1;
  double beside_aside = 0.025;  ///< greatest excess of PoseEvidence::aside of such poses, half of a small handle
  double slide = 0.25;          ///< rotation or translation to poses beside the best one, radians or radii
  double same_pose = 0.03;      ///< distance within which a symmetry maps a model onto itself, diameters
  /// Distance within which the motion to another pose may be a symmetry that ICP has not reached, diameters.
  double near_pose = 0.05;
  /// Agreement of a scan with its image under a symmetry; wrong poses of scans have 0.3 to 0.6.
  double symmetric_agreement = 0.9;
  /// Greatest share of the scan that may lie aside under a symmetry; the handle of a mug is 0.09.
  double symmetric_aside = 0.05;
  /// PoseEvidence::outside of a pose with a confidence of one half; 127 of 128 right poses of real scans have less.
  double max_outside = 0.045;
  double some_uniqueness = 0.9;  ///< uniqueness below which doubtOf() mentions other poses
  double contact = 0.025;        ///< width within which points of one surface lie on each other, radii

  // Surfaces
  double max_roughness = 0.15;   ///< greatest roughness, spacings; rougher surfaces take normals from more neighbors
  int num_rough_neighbors = 32;  ///< neighbors for normals of rough surfaces, which halve the error
  int cells = 48;                ///< cells along each side of the grid of closest points
  /// Cells along each side for few points, as wide as the spacing of a thousand points of a surface.
  int few_cells = cells / 2;
};

inline constexpr RegistrationRules kRegistration{};

}  // namespace pcl_symmetry
