#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/base/constants.h"

namespace pcl_symmetry {

/// Parameters that affect the search for rotations. Lengths are in radii of the bounding ball and angles in radians,
/// unless stated otherwise.
struct RotationRules {
  // Failures, as shares of the surface
  // Tolerances beyond which a piece of surface sticks out: 10 % of the diameter, as in BOP.
  double far_tolerances = 10.0;
  double far_of_feature = 0.125;  // greatest share of the surface that may stick out, as a share of max_feature
  double min_far = 0.002;         // least value of that share: single samples at sharp edges are far by chance
  double optimism = 1.3;          // true excess divided by the fitted cloud's; 1.28 on 98 groups of 354 models of PSB
  double share_unit = 0.02;       // uncertainty of a share: with it, the confidences of these groups are calibrated
  double share_errors = 0.5;      // standard errors by which that uncertainty grows for few points
  // Greatest excess of the worst of the rotations that represent all rotations, whose mean may be 1.
  double max_worst = 1.25;
  double max_errors = 3.0;    // standard errors by which a share of some of the points may be off
  double gain_of_fit = 0.03;  // share of the surface that a close fit may gain
  // Least ratio of the excess halfway between the rotations of a fold to the excess of the fold itself.
  double clear_factor = 1.5;
  double clear_excess = 0.2;  // least difference of these two excesses

  // Resolution of points
  double min_own_share = 0.5;  // least share of the points within the tolerance of the surface of the others
  // Resolution of a sparse surface that is accepted, tolerances: its uncertainty lowers the confidence.
  double surface_slack = 1.5;
  int body_neighbors = 50;  // neighbors by which solid bodies are recognized, at most a quarter of the points
  // Least thickness over length of such a neighborhood in a body: 0.75 inside, balls of 200 points 0.57 to 0.69, bowls
  // as thin as their spacing 0.45.
  double body_thickness = 0.56;
  // Fewer neighbors, which distinguish a body from walls a few spacings thick, whose two surfaces are flat.
  int close_neighbors = 8;
  // Least thickness over length of such a neighborhood: 0.4 in a body, at most 0.25 in a flat surface.
  double close_thickness = 0.32;
  int border_neighbors = 30;  // neighbors by which the border of a body is recognized
  // Least distance of a border point from their mean, in distances of the farthest one: 3/8 at a flat border, 0.14
  // inside by chance.
  double border_offset = 0.27;
  // Tolerance for points compared one by one, in median distances to the closest point: 8 % of images are within it by
  // chance.
  double single_distance = 0.5;
  Eigen::Index max_single_points = 50'000;  // greatest number of points that are compared one by one

  // Fits: Iterative Symmetric Points, whose steps and weights kRefinement limits
  int num_overlap_points = 256;   // points of overlap()
  int num_rough_points = 200;     // points of rough fits
  int num_close_points = 1000;    // points of close fits
  int num_some_points = 600;      // points that show whether a close fit is worth judging by all points
  int rough_iterations = 8;       // greatest number of iterations of rough fits
  int close_iterations = 12;      // greatest number of iterations of close fits
  double first_tolerances = 2.0;  // width of the weights at the start, tolerances, unless first_spacings is more
  // Width of the weights at the start, spacings of the points, unless first_tolerances is more.
  double first_spacings = 1.0;
  double last_tolerances = 0.7;   // width of the weights at the end, tolerances, unless last_roughnesses is more
  double last_roughnesses = 3.0;  // width of the weights at the end, roughnesses, unless last_tolerances is more
  double settled_step = 2e-4;     // step that ends the fit: a hundredth of the default tolerance
  Eigen::Index max_fitted = 6;    // greatest number of rotations of a large group that are fitted, spread over it
  double rough_overlap = 0.6;     // least overlap of a set before its fit
  double fair_overlap = 0.7;      // least overlap of a set after its rough fit

  // Axes
  double same_line = 0.05;        // angle and distance within which lines are one
  double min_line_overlap = 0.6;  // least overlap of a line that is tried
  int num_first_points = 48;      // points that rule out most lines
  double first_overlap = 0.42;    // least overlap of these points: min_line_overlap less three standard errors
  // Greatest number of directions kept for each order: as many as axes of order 5 of the icosahedron.
  std::size_t max_directions = 6;
  double min_angle = 0.17;  // least angle between kept directions
  double near_best = 0.05;  // deficit of the overlap to the best one up to which a smaller fold is as likely
  int small_fold = 6;       // folds up to this one are tried whatever the overlap of greater ones
  // Greatest surplus of the overlap of the rotation by half the angle of a fold over the overlap of the fold.
  double half_allowance = 0.03;
  double min_overlap = 0.5;      // least overlap of the likeliest rotation about a line before its fit
  double clearly_better = 0.02;  // least surplus of the overlap of a greater fold over a smaller one
  std::size_t max_axes = 12;     // greatest number of axes: enough to determine any finite group
  std::size_t max_folds = 3;     // greatest number of folds of a line that are fitted, the greatest first
  int min_pattern = 3;           // least fold of equal pieces around a line that are a pattern rather than features
  double pattern_excess = 0.5;   // excess of the worst rotation from which a pattern is searched for
  // A bar 3 % as thick as long keeps its corners, a polygon of 12 sides is round.
  double max_tolerance_of_radius = 0.06;

  // Groups
  double axes_meet = 0.1;     // difference up to which the angles between two found axes and two axes of a group agree
  double across_step = 0.02;  // step of the search for half turns about axes perpendicular to the main one
};
inline constexpr RotationRules kRotation;

/// Parameters of the axes of scans. Unless stated otherwise, lengths are in radii of the cloud and angles in radians.
struct ScanAxisRules {
  /// Samples, draws, and normals per draw, for lines of bodies of revolution.
  int normal_samples = 600, normal_draws = 60, normals_in_draw = 8;
  int from_normals = 3;                  ///< greatest number of such lines that are kept
  double angle_of_fold = 3.0 * kDegree;  ///< error of the angles between planes of scans, radians
  double min_plane_angle = 0.13;         ///< least angle between two planes that give a common line
  /// Coarse axial transform: cells along an edge of its distance field, bins of the directions and offsets, samples.
  int coarse_cells = 24, coarse_theta = 8, coarse_phi = 32, coarse_offset = 8, coarse_samples = 32;
  /// Greatest distance of an axis from the middle of the cloud in the coarse axial transform.
  double coarse_reach = 0.67;
  std::size_t coarse_maxima = 10;  ///< greatest number of maxima of the coarse axial transform
  double coarsely_same = 0.3;      ///< radians and radii within which two of these maxima are one
  double coarse_equal = 0.05;      ///< greatest deficit of D to the peak for an order that may be the axis'
  int max_order = 12;              ///< greatest order: bodies of more folds look nearly round in a scan
  int round_rotations = 10;        ///< rotations that represent rotations by any angle, in addition to small ones
  double small_angle = 0.26, larger_angle = 0.7;  ///< angles that the fit of a round body uses
  double rough_factor = 3.0;                      ///< factor on max_off and max_far in screening
  double screening_slack = 2.0;        ///< greatest distance of a point on the surface in screening, tolerances
  std::size_t max_planes_of_axes = 8;  ///< greatest number of planes whose common lines are tried
  double plane_share = 0.85;           ///< least share of these planes
  /// Limits within which two axes are one: no body has two nearer ones.
  double same_axis_angle = 0.12, same_axis_offset = 0.1;
  double fitted_same = 0.02;  ///< radians and radii within which lines are judged only once
  std::size_t max_axes = 5;   ///< greatest number of axes; a polyhedron seen from a corner shows as many
  int scored_planes = 4;      ///< planes over which D of a round body is averaged
  int num_samples = 1000, num_few_samples = 300;  ///< points for measuring and for screening a rotation
  using Widths = std::array<double, 6>;
  Widths fit_widths{8.0, 5.0, 3.0, 2.0, 1.5, 1.5};        ///< widths of the weights of a fit, tolerances
  Widths close_fit_widths{3.0, 2.0, 1.5, 1.0, 0.7, 0.7};  ///< the same for a fit that starts where another fit ended
  double min_free_miss = 0.5;  ///< distance from the rim, tolerances, from which points in free space pull the line
  double fit_reach = 2.0;      ///< distance beyond which a match has no weight, widths
  double fit_ridge = 1e-3;     ///< ridge that keeps unconstrained directions at rest, as a share of the trace
  /// Greatest step of a fit, radians and radii; starts are closer, and larger steps leave the basin.
  double longest_step = 0.1;
  double fit_step = 1e-4;         ///< step of the derivatives, radians and radii
  double min_f = 1e-6;            ///< least f, below any f that is not 0
  double slack_of_reach = 1.001;  ///< factor on the reach, greater than the rounding of distances
  /// Greatest shares of the points mapped into free space, and far into it, for folds.
  double max_off = 0.05, max_far = 0.25 * max_off;
  double max_round_off = 0.015, max_round_far = 0.004;  ///< the same for round bodies
  /// Least shares of the points mapped onto the surface, for round bodies, for folds, and for folds of 2.
  double round_on = 0.6, fold_on = 0.3, twofold_on = 0.75;
  double halfway_more = 0.06;  ///< least additional share of the points that rotations halfway map into free space
  int num_plane_pairs = 24;    ///< number of pairs of perpendicular planes through a line that are screened
  /// Limits for lines that cross at a right angle: angle and distance.
  double upright_angle = 6.0 * kDegree, crossing_gap = 0.06;
  /// Weight of the share on the surface relative to that in free space, in the choice of a pair of planes.
  double landed_counts = 0.1;
  /// Additional share of the points that rotations halfway map into free space, above which more makes no difference.
  double max_halfway = 0.3;
  double negligible_share = 2e-3;      ///< unit of shares in the log odds: less is negligible
  double negligible_of_planes = 5e-3;  ///< the same for planes, which are screened in steps
  double max_off_body = 0.3;           ///< greatest share of the points that a nearly round body has off its round part
  double min_mapped = 0.25;     ///< least share of these points that a plane through the axis maps onto the surface
  double min_stiffness = 1e-3;  ///< least stiffness of a line that the scan constrains; boxes have 0.05
};

inline constexpr ScanAxisRules kScanAxes;

}  // namespace pcl_symmetry
