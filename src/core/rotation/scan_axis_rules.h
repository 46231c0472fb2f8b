#pragma once

#include <array>
#include <cstddef>

#include "core/base/constants.h"

namespace pcl_symmetry {

/// The numbers that axes of scans depend on. Lengths are in radii of the cloud, angles in radians, where no unit is
/// given.
struct ScanAxisRules {
  double usual_tolerance = 0.01;  ///< share of the diameter, where no planes are looked for
  int normal_samples = 600, normal_draws = 60, normals_in_draw = 8;  ///< that lines of bodies of revolution are from
  int from_normals = 3;                                              ///< lines kept of these
  double same_start_angle = 0.1, same_start_offset = 0.06;           ///< lines within both are one start
  double angle_of_fold = 3.0 * kDegree;                              ///< by which planes of scans are off
  double min_plane_angle = 0.13;                                     ///< between two planes that share a line
  int coarse_cells = 24, coarse_theta = 8, coarse_phi = 32, coarse_offset = 12, coarse_samples = 32;
  std::size_t coarse_maxima = 10;                         ///< of that axial transform
  double coarse_angle = 0.3, coarse_distance = 0.3;       ///< within which two of them are one
  double coarse_equal = 0.05;                             ///< D by which they are off their peaks
  int max_order = 12;                                     ///< bodies of more folds are nearly round to a scan
  int round_rotations = 10;                               ///< rotations that represent all, besides small ones
  double small_angle = 0.26, larger_angle = 0.7;          ///< angles that the fit of a round body uses
  double rough_factor = 3.0, rough_slack = 2.0;           ///< of max_off and max_far in screening; tolerances
  std::size_t max_planes_of_axes = 8;                     ///< planes whose common lines are starts
  double plane_share = 0.85;                              ///< share of such planes
  double same_axis_angle = 0.12, same_axis_offset = 0.1;  ///< no body has two axes nearer
  double fitted_angle = 0.02, fitted_offset = 0.02;       ///< lines within both are judged once
  std::size_t max_axes = 5;                               ///< axes; a polyhedron seen from a corner shows as many
  int max_points = 10'000;                                ///< points that rotations are judged by
  int scored_planes = 4;                                  ///< that D of a round body is the mean of
  int num_samples = 1000, num_few_samples = 300;          ///< points that judge a rotation exactly, and roughly
  double far_tolerances = 10.0;                           ///< tolerances, as ObjectSymmetryOptions::max_feature
  std::array<double, 6> fit_widths{8.0, 5.0, 3.0, 2.0, 1.5, 1.5};        ///< of the weights of a fit, tolerances
  std::array<double, 6> close_fit_widths{3.0, 2.0, 1.5, 1.0, 0.7, 0.7};  ///< the same, from a first fit on
  double min_empty_miss = 0.5;    ///< tolerances beside the rim from which points pull
  double fit_reach = 2.0;         ///< widths beyond which a match has no weight
  double fit_ridge = 1e-3;        ///< share of the trace that keeps free directions at rest
  double longest_step = 0.1;      ///< radians, radii, of a fit; starts are closer, larger steps leave the basin
  double fit_step = 1e-4;         ///< of derivatives, radians and radii
  double min_f = 1e-6;            ///< below any f that is not 0
  double slack_of_reach = 1.001;  ///< more than what distances are rounded by
  double max_off = 0.05, max_far = 0.0125;                  ///< shares thrown into empty space, of folds
  double max_round_off = 0.015, max_round_far = 0.004;      ///< the same of round bodies
  double round_on = 0.6, fold_on = 0.3, twofold_on = 0.75;  ///< shares that land on the surface, by kind
  double halfway_more = 0.06;  ///< share that rotations halfway throw more into empty space
  int num_plane_pairs = 24;    ///< pairs of perpendicular planes through a line that are screened
  double plane_slack = 2.0;    ///< tolerances of that screening
  double upright_angle = 6.0 * kDegree, crossing_gap = 0.06;  ///< by which lines may miss a right angle, each other
  double landed_counts = 0.1;                                 ///< what lands on the surface, of what is thrown off it
  double max_halfway = 0.3;                                   ///< share of the points from which on all folds are alike
  double negligible_share = 2e-3;                             ///< share of the points that is negligible
  double negligible_of_planes = 5e-3;                         ///< the same of planes, which are screened at steps
  double min_hold = 1e-3;  ///< least stiffness of a line that the scan holds; boxes have 0.05
};

inline constexpr ScanAxisRules kScanAxes;

}  // namespace pcl_symmetry
