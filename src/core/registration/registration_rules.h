#pragma once

#include "core/base/constants.h"

namespace pcl_symmetry {

/// The constants of this folder that change answers.
struct RegistrationRules {
  // Starts from frames
  int num_rotations = 8;                  ///< about an axis of revolution, steps of 45 degrees
  double same_rotation = 10.0 * kDegree;  ///< radians between rotations that are one: the search reaches further

  // Steps
  /// Share of the greatest entry that is added to the diagonal: directions that nothing fixes stay where they are.
  double relative_inertia = 1e-4;
  double inertia = 1e-6;        ///< added to the diagonal whatever its entries
  double min_deviation = 1e-7;  ///< radii; standard deviation of a residual, the rounding of floats

  // Merit of a pose
  float normal_share = 0.7f;      ///< of a point's support that depends on its normal
  double point_share = 0.1;       ///< of a residual along the surface: poses do not slide away on plain surfaces
  double min_judged = 0.05;       ///< share of the model's points that the scan must be able to judge
  double silhouette_share = 0.5;  ///< weight of a model point in free space against one of the scan

  // Search
  int screen_points = 80;   ///< of each cloud that poses are screened by
  int coarse_points = 120;  ///< that poses are improved coarsely by
  int fine_points = 400;    ///< that poses are improved finely by
  /// Radii, width of the Gaussian: half the gap between 1000 rotations at the rim, and as much for the positions.
  double screen_width = 0.2;
  int num_steps = 10;           ///< over which the Gaussian shrinks, coarsely and finely
  int outline_points = 200;     ///< of the model
  double coarse_width = 0.25;   ///< radii, width of the Gaussian at the start
  double fine_width = 0.05;     ///< radii, at the end
  double merge_angle = 0.2;     ///< radians; poses closer than this and than merge_distance are one
  double merge_distance = 0.1;  ///< radii

  // Poses of clouds that share a part, where no other pose convinces
  double min_confidence = 0.5;  ///< of a pose that convinces, that of CloudRegistration::converged()
  int num_part_poses = 12;      ///< by pairs of points
  int part_steps = 3;           ///< of their first fit
  double part_width = 0.1;      ///< radii, width of the Gaussian at its start

  // Evidence of a pose
  int evidence_points = 3000;       ///< of each cloud, that are looked at
  double tight_tolerance = 0.004;   ///< of the smaller cloud's diameter: distance within which surfaces agree, at least
  double tight_noises = 4.0;        ///< deviations of the noisier cloud within which surfaces agree, at least
  double facing_spacings = 1.5;     ///< between a point and the middle of the disc that it faces
  double facing_reach = 0.05;       ///< of the smaller cloud's diameter; what is farther away is another layer
  double min_noise = 0.0015;        ///< diameters; that of a close depth camera, less is no evidence for a pose
  double max_noise = 0.01;          ///< diameters; more is the curvature between few points
  double other_unit = 5.0;          ///< ratio of diameters from which a wrong unit is suspected
  double near_tolerance = 0.02;     ///< diameters, within which a surface that was to be seen was measured
  double min_cosine = 0.17;         ///< between ray and normal of a point that is to be seen: 80 degrees
  double hidden_depth = 0.08;       ///< radii of a surface, behind its own front
  int min_visible = 20;             ///< points that are to be seen; fewer are uninformative
  double some_not_measured = 0.1;   ///< share of the surface that is worth a word
  double agreeing_cosine = 0.7071;  ///< of the angle between normals of one surface: 45 degrees
  double like_merit = 0.05;         ///< between poses of which either may be right,
  double like_odds = 0.5;           ///< and share of the odds from which on they are equal: sampling changes them
  double same_pose = 0.03;          ///< diameters of a model, within which a symmetry brings it onto itself,
  double near_pose = 0.05;          ///< and one that ICP left near a pose does
  double symmetric_agreement = 0.9;  ///< of what a scan shows with itself; wrong poses of scans have 0.3 to 0.6
  double symmetric_aside = 0.05;     ///< share of it that may lie aside; a handle of a mug is 0.09
  double some_uniqueness = 0.9;      ///< below it another pose is worth a word
  double contact = 0.025;            ///< radii, width within which points of one surface lie on each other

  // Surfaces
  double max_roughness = 0.15;   ///< of the spacing; rougher surfaces take normals from more neighbors
  int num_rough_neighbors = 32;  ///< they halve the error of the normals
  int cells = 48;                ///< along each side of the grid of closest points
  int few_cells = cells / 2;     ///< cells for few points, as wide as a thousand points of a surface are apart
};

inline constexpr RegistrationRules kRegistration{};

}  // namespace pcl_symmetry
