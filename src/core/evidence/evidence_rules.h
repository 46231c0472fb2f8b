#pragma once

#include <cstddef>

namespace pcl_symmetry {

/// The numbers that the evidence of a plane depends on, beside EvidenceUnits and what is fitted (confidence_fit.h).
struct EvidenceRules {
  // Surface of samples.
  float disc_radius = 1.25f;  ///< spacings, of the disc that a sample represents; 1 in 135 holds no other sample
  float max_roughness = 0.25f,
        trust_width = 0.1f;              ///< roughness, spacings, at which normals mean nothing; volumes: 0.42
  float new_point_factor = 1.41421356f;  ///< distance of a new point from a plane over that of its nine points

  // Support.
  float normal_reach = 0.01f;  ///< reach across the surface, radii of the points
  float rough_reach = 3.0f;    ///< the same in units of the roughness: 99.7 % of Gaussian noise
  float normal_angle = 0.5f;   ///< radians between normals that agree
  float surely = 0.99999f;     ///< share of a reach that rounding does not exceed
  float most = 9.0f;           ///< squared deviation that counts as no support
  double tilt_ridge = 1e-4;    ///< far below the stiffness of tilts that are held

  double exact_depth = 4e-3;          ///< error of a depth, radii, up to which a pixel without depth saw nothing
  float empty_without_depth = 0.15f;  ///< the same as a share where errors are larger

  // Confidence.
  double coarsest = 3.0;         ///< tolerances; by default, points with a wider spacing decide at what they resolve
  double coarsest_part = 1.5;    ///< of flat clouds, and of scans so wide, which lose confidence beyond
  double surely_coarser = 0.05;  ///< share by which spacing raises the tolerance of such a scan
  double lost_per_coarseness = 2.0;  ///< log odds per tolerance beyond
  double unknown_share = 0.5;        ///< units of a share per share that is uninformative

  // Where a cloud ends.
  float min_explained = 0.4f, explained = 0.75f;  ///< share of an edge from which its region is missing, and fully
  float standard_errors = 1.96f;                  ///< of that share
  double min_piece = 0.002;                       ///< share of the surface of a piece that was cut off
  std::size_t min_of_piece = 8;                   ///< samples of it
  double far_view = 100.0;                        ///< radii, from where rays are parallel
  double layered_sheet = 0.1;                     ///< layered share of open sheets; 38 of 40 cut objects have more
  double few_borders = 0.6, borders_everywhere = 0.75;  ///< share near borders to trust them fully, or not at all
  float in_front = 3.0f, behind = 4.0f;                 ///< spacings by which a piece reaches behind the last points
  float runs_into = 0.65f, closes = 0.8f;               ///< cosine of normals at a cut, and where a surface closes
  float last_points = 2.0f;                             ///< depth of these points, spacings
  double outliers = 0.002;                              ///< share of the points
  float outliers_within = 8.0f;                         ///< spacings in which they are looked for first
  double points_per_square = 160.0;                     ///< for each square of the side of a box of cells
  int max_steps = 200;                                  ///< between convex hulls
  float min_gain = 0.02f;                               ///< share of the squared distance that a step shortens
  float no_distance = 1.0f;                             ///< spacings, of hulls that overlap

  // Planes of cuts.
  int cut_draws = 1000, max_cuts = 4;  ///< a box that crops a corner has three sides
  float cut_band = 1.5f;               ///< spacings about the plane of a cut in which points belong to it
  double max_beyond = 0.002;           ///< share of the points beyond it
  std::size_t min_of_cut = 15;         ///< border points
  double min_at_border = 0.12;         ///< share of the points in the band at borders; cuts have 0.6 to 0.9
  double min_spread = 2.0;             ///< spacings that border points spread in both directions

  // Density of points that resolve no surface.
  int max_cells = 160;               ///< along the longest side
  double cell_size = 0.5;            ///< bandwidths
  double margin = 4.0;               ///< bandwidths around the points
  double kernel_reach = 3.0;         ///< standard deviations
  double cell_variance = 1.0 / 3.0;  ///< squared cells that spreading and reading add
  double min_variance = 0.1;         ///< squared cells; less needs no blur
  double step = 0.5;                 ///< bandwidths by which the farthest points move in a difference
  double longest_step = 3.0;         ///< differences, as far as the quadric holds
  double settled = 0.01;             ///< bandwidths; far below the error of a plane
  double min_curvature = 1e-3;       ///< share of the greatest
};

inline constexpr EvidenceRules kEvidence;

}  // namespace pcl_symmetry
