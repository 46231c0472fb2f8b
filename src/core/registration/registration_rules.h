#pragma once

#include "core/base/constants.h"

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct RegistrationRules {
  // Starts from frames
  int num_rotations = 8;                  ///< about an axis of revolution, steps of 45 degrees
  double same_rotation = 10.0 * kDegree;  ///< radians; closer rotations count as one, as the search reaches further

  // Steps
  /// Share of the greatest entry that is added to the diagonal: unconstrained directions do not move.
  double relative_inertia = 1e-4;
  double inertia = 1e-6;        ///< added to the diagonal whatever its entries
  double min_deviation = 1e-7;  ///< radii; standard deviation of a residual, the rounding of floats

  // Merit of a pose
  float normal_share = 0.7f;  ///< share of a point's support that depends on its normal
  double point_share =
      0.1;  ///< weight of a residual along the surface, so that poses do not slide away on plain surfaces
  double min_judged = 0.05;       ///< share of the model's points that the scan must be able to judge
  double silhouette_share = 0.5;  ///< weight of a model point in free space against one of the scan

  // Search
  int screen_points = 80;   ///< points of each cloud for screening
  int coarse_points = 120;  ///< points of each cloud for coarse improvement
  int fine_points = 400;    ///< points of each cloud for fine improvement
  /// Radii, width of the Gaussian: half the gap between 1000 rotations at the rim, and as much for the positions.
  double screen_width = 0.2;
  int num_steps = 10;           ///< over which the Gaussian shrinks, coarsely and finely
  int outline_points = 200;     ///< of the model
  double coarse_width = 0.25;   ///< radii, width of the Gaussian at the start
  double fine_width = 0.05;     ///< radii, at the end
  double merge_angle = 0.2;     ///< radians; poses closer than this and than merge_distance are one
  double merge_distance = 0.1;  ///< radii

  // Poses of clouds that share a part, if no other pose is convincing
  double min_confidence = 0.5;  ///< least confidence of a convincing pose, as in CloudRegistration::converged()
  int num_part_poses = 12;      ///< by pairs of points
  int part_steps = 3;           ///< of their first fit
  double part_width = 0.1;      ///< radii, width of the Gaussian at its start

  // Evidence of a pose
  int evidence_points = 3000;       ///< points of each cloud that are examined
  double tight_tolerance = 0.004;   ///< of the smaller cloud's diameter: distance within which surfaces agree, at least
  double tight_noises = 4.0;        ///< deviations of the noisier cloud within which surfaces agree, at least
  double facing_spacings = 1.5;     ///< between a point and the middle of the disc that it faces
  double facing_reach = 0.05;       ///< share of the smaller cloud's diameter; surfaces farther away are another layer
  double min_noise = 0.0015;        ///< diameters; that of a close depth camera, less is no evidence for a pose
  double max_noise = 0.01;          ///< diameters; more is the curvature between few points
  double other_unit = 5.0;          ///< ratio of diameters from which a wrong unit is suspected
  double near_tolerance = 0.02;     ///< diameters within which a surface that should be visible counts as measured
  double min_cosine = 0.17;         ///< between ray and normal of a point that should be visible: 80 degrees
  double hidden_depth = 0.08;       ///< radii of a surface, behind its own front
  int min_visible = 20;             ///< points that should be visible; fewer are uninformative
  double some_not_measured = 0.1;   ///< share of the surface that is worth mentioning
  double agreeing_cosine = 0.7071;  ///< of the angle between normals of one surface: 45 degrees
  double like_merit = 0.05;         ///< difference in merit of poses of which either may be right,
  double like_odds = 0.5;           ///< and share of the odds above which they count as equal: sampling changes them
  double same_pose = 0.03;          ///< diameters of a model within which a symmetry maps it onto itself,
  double near_pose = 0.05;          ///< and one that ICP left near a pose does
  double symmetric_agreement =
      0.9;  ///< agreement of a scan with its image under a symmetry; wrong poses of scans have 0.3 to 0.6
  double symmetric_aside = 0.05;  ///< share of the scan that may lie aside; the handle of a mug is 0.09
  double some_uniqueness = 0.9;   ///< below it another pose is worth mentioning
  double contact = 0.025;         ///< radii, width within which points of one surface lie on each other

  // Surfaces
  double max_roughness = 0.15;   ///< of the spacing; rougher surfaces take normals from more neighbors
  int num_rough_neighbors = 32;  ///< they halve the error of the normals
  int cells = 48;                ///< along each side of the grid of closest points
  int few_cells = cells / 2;     ///< cells for few points, as wide as a thousand points of a surface are apart
};

inline constexpr RegistrationRules kRegistration{};

}  // namespace pcl_symmetry
