#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/base/constants.h"
#include "core/evidence/plane_confidence.h"
#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

/// Parameters that affect the results of detection (Section 4.4). Unless stated otherwise, lengths are in radii of the
/// cloud and angles in radians.
struct DetectionRules {
  /// Which points are used.
  struct {
    double max_points = 20'000.0;          ///< points that represent a cloud at the default tolerance
    int density_samples = 1000;            ///< samples of the density; its slope has an error of 2 %
    int max_counted = 48, neighbors = 16;  ///< greatest number of neighbors counted, and mean number in a neighborhood
    double trimmed = 0.05;                 ///< share of the points trimmed at either end of the range of densities
    double uneven = 0.4, fully_uneven = 0.7;  ///< log ratios of densities at which thinning starts and is complete
  } points;

  /// Completion of groups.
  struct {
    int offsets_tried = 8;        ///< offsets along an object of planes at right angles; refinement bridges the gaps
    std::size_t max_closed = 16;  ///< symmetries whose group is completed: a cube has 9, an icosahedron 15
  } closure;

  /// Stages of refinement.
  struct {
    /// Bins beyond its own that refinement may move a candidate by. Departure from the paper: it allows 0; one bin
    /// allows for the noise of the sampled map.
    double max_drift = 1.0;
    int first_samples = 100;        ///< points reflected in the first stage
    double symmetric_merit = 0.93;  ///< merit of a symmetry: support of 97 % and conflict of 3 % give 0.97
    /// Greatest number of iterations of the three stages, and of candidates that are not likely.
    int coarse_iterations = 5, close_iterations = 6, full_iterations = 8, rough_iterations = 4;
    double close_slack = 0.1;   ///< deficit to the merit of a symmetry up to which a candidate is kept in any case
    double coarse_slack = 0.2;  ///< allowed deficit to that merit after the first stage, if there is a symmetry
    /// Number of candidates up to which those of less merit are kept after the first and the second stage.
    std::size_t kept_coarsely = 8, kept_closely = 4;
    int close_sample_factor = 4;      ///< samples of the second stage per sample of the first
    double narrowest_coarsely = 0.5;  ///< sigmas at the end of the first stage
    /// Standard errors of the plane below which a step ends the refinement of a likely symmetry.
    double settled_errors = 3.0;
  } stages;

  /// Planes on surfaces and in volumes.
  struct {
    double first_climb = 0.02, last_climb = first_climb / 8.0;  ///< first and last step of a climb, radians and radii
    int max_climb_steps = 24;                                   ///< greatest number of steps of a climb, of all lengths
    int climb_samples = 500;                                    ///< points used by climbs on whole clouds
    double min_gain = 0.005;                                    ///< least gain in merit for which a climb is kept
    double climbing_merit = 0.5;                                ///< least merit of planes that climb
    double climbing_confidence = 0.01;                          ///< least confidence of planes that climb
    double noisy_depth = 0.1;  ///< roughness, spacings, from which planes of scans climb: noise looks hidden
    double bandwidth = 1.5;    ///< bandwidth of a density, spacings; less shows single points, more blurs the shape
    int max_iterations = 6;    ///< Newton steps in a density, and iterations that refine a plane of a family
    int sample_factor = 10;    ///< samples of a density per sample of a surface
  } fit;

  /// Measuring a plane.
  struct {
    double surely_whole = 0.985;  ///< share within the tolerance from which no missing piece is assumed
    /// Offset stiffness above which open borders begin to excuse missing matches; at twice this value, they do so
    /// fully.
    double held_stiffness = 0.02;
    double moved_tolerances = 2.0;  ///< tolerances by which a plane has to move an informative sample of a scan
    double noisy_thinness = 3.0;    ///< tolerances within which a volume of points is a sheet or a line
    double round_spacings = 2.0;    ///< spacings within which points of a line do not resolve its cross-section
    double min_own_share = 0.1;  ///< least share of the points on the surface of the others by which shares are divided
    int screening_samples = 2000;                ///< samples for screening and for SymmetryPlane::deviation
    std::array<double, 2> tolerances{1.0, 2.0};  ///< tolerances at which shares are measured, see PlaneEvidence
  } measure;

  /// Deciding.
  struct {
    double max_cut = 0.3;  ///< greatest share of the outline that the image border may cut off; tables in frames: 0.36
    double hopeful_share = 0.93;     ///< least screened share of a possible symmetry
    double screening_errors = 2.0;   ///< standard errors by which a screened share may be underestimated
    double max_unmoved_share = 0.5;  ///< share of the points left in place above which a plane is uninformative
    double nothing_missing = 0.01;   ///< missing share of the surface, below which it is missing by chance
    double piece_missing = 0.03;     ///< missing share of the surface, above which it is a piece
    double odds_of_a_piece = 0.2;    ///< odds that a piece is missing although a plane explains the whole cloud
    double as_likely = 0.05;       ///< difference of two confidences whose order other samples of the shape may reverse
    double min_informative = 0.1;  ///< share of informative samples below which confidence falls in proportion
    double max_resolution = 3.0;   ///< resolution, in greatest tolerances, above which a sensor decides nothing
    double upright = 5.0 * kDegree;  ///< a plane within this angle of upright or level does not slant
    double touching = 0.05;  ///< distance beyond the nearest support, diameters, within which other supports carry, too
    double slanted_odds = 0.1;  ///< odds of a slanted plane relative to another one
    /// Greatest share of the points that a plane maps into the hidden inside of a hollow body; closed bodies have 0.01.
    double max_inside = 0.05;
    double no_surface = 1.5;  ///< spacing in tolerances from which points are too sparse for a surface
    int max_possible = 5;  ///< greatest number of symmetries and possible planes together, if there are possible ones
    double slope_dip = 0.005;  ///< rise of D on the way to a better plane that counts as rounding
    /// Angle and offset to a better plane within which a plane may lie on its slope.
    double slope_angle = 0.2, slope_offset = 0.15;
  } decide;

  /// Polygons and families.
  struct {
    /// Greatest offset and angle between a line and a plane that contains it, radii and radians.
    double contained_offset = 0.03, contained_angle = 3.0 * kDegree;
    std::size_t min_planes = 4;         ///< least number of planes of a polygon; three fit too many polygons by chance
    std::size_t max_paired_planes = 6;  ///< greatest number of planes whose common lines are tried for a polygon
    double min_pair_angle = 0.1;  ///< least angle between two such planes; with smaller ones, their line is uncertain
    double max_folded = 0.2;  ///< greatest deviation from a plane of the polygon, in angles between neighboring planes
    std::size_t max_planes = 8;  ///< greatest number of planes whose common lines are tried for an axis
    double min_angle = 0.17;     ///< least angle between two such planes
    /// Numbers of planes of a family that screen it, that its line is fitted to, and that test it.
    int screening_planes = 3, fitted_planes = 6, tested_planes = 8;
    double rough_factor = 2.0;  ///< factor on the allowance in the screening
    double coplanar = 0.05;     ///< share of the greatest singular value up to which normals are coplanar
    /// Least eigenvalue of the mean outer product of the normals of planes through one point, at most 1/3.
    double min_spread = 0.02;
    int rough_sample_share = 5;  ///< number of samples per sample that screens a family
    double worst_share = 0.5;    ///< least confidence of the worst plane of a family, as a share of a symmetry's
  } families;

  /// Folds of noisy clouds, by their spectrum.
  struct {
    /// Limits of a fold; a cloud that is thinner on one side, or flat, has folds one and two.
    int max_frequency = 120, min_fold = 3;
    /// Number of rings about the line for the fold, and of slabs for the angle of the planes.
    int rings = 8, slabs = 4;
    /// Number of points that give the spectrum, and of points reflected in a halfway plane.
    int spectrum_samples = 20'000, halfway_samples = 5000;
    int compared_frequencies = 12;  ///< frequencies on either side with which a frequency is compared
    double min_power = 20.0;        ///< least power of a fold; round bodies in noise reach 15
    double stands_out = 4.0;        ///< least ratio to the median power of the frequencies beside it
    /// Greatest gap between angles of folded points, in angles between two planes; sparser points are uninformative.
    double max_gap = 0.125;
    double errors = 3.0;           ///< standard errors by which planes halfway between a polygon's must fit less well
    double odds_of_polygon = 4.0;  ///< odds of planes of a polygon relative to other planes with the same evidence
    std::size_t max_paired_planes = 4;  ///< greatest number of planes whose common lines are tried
    /// Divisors of a fold, for subsets of planes that may differ from the others.
    std::array<int, 3> divisors{2, 3, 5};
  } folds;

  /// Symmetries of parts.
  struct {
    /// Number of balls of each radius, and of directions in addition to their principal axes.
    int num_seeds = 24, num_directions = 8;
    std::array<double, 3> radii{0.25, 0.35, 0.5};  ///< radii of the balls, from limbs to halves of a shape
    double min_ball = 0.04, largest_ball = 0.6;    ///< least and greatest share of the points in a ball
    double min_support = 0.7;                      ///< least share of matching points in a ball
    double farthest_plane = 0.5;  ///< greatest distance of a plane from the middle of its ball, radii of the ball
    double min_part = 0.04, largest_part = 0.9;  ///< least and greatest share of the points in a part
    /// Typical edge of a part, in edges of a disc, and its increase per share of the points.
    double min_edge = 0.4, edge_per_share = 0.5;
    /// Greatest excess edge of a part, and greatest share of its points in better parts if it has an excess edge.
    double longer_edge = 0.15, shared_part = 0.5;
    double same_part = 0.5;              ///< share of their points above which two regions belong to one part
    std::size_t max_planes_of_part = 9;  ///< greatest number of planes of a part without an axis: a cube has nine
    std::array<double, 2> longest_edges_before{1.0, 0.6};  ///< greatest excess edge of a region before each round
    int iterations = 6;                                    ///< iterations that refine a plane of a part
    std::size_t ball_samples = 200, region_samples = 400;  ///< points that are reflected in a ball, and in a region
    int num_region_samples = 4000;                         ///< samples of a cloud for regions; a part of 4 % has 160
    int num_smoothing = 11, num_connecting = 6;  ///< numbers of neighbors used to smooth and to connect matches
    double matched_support = 0.8;                ///< least mean support of a matching neighborhood
    float counterpart = 0.5f;                    ///< least support that connects a sample with its counterpart
  } parts;
};

inline constexpr DetectionRules kDetection;

/// A parameter that depends on the kind of cloud.
template <typename T>
struct KindRule {
  T surface, scan, volume;  ///< value for points of each kind

  constexpr T operator[](CloudKind kind) const {
    return kind == CloudKind::Scan ? scan : kind == CloudKind::Volume ? volume : surface;
  }
};

/// Parameters of detection that depend on the kind of cloud (Section 4.4).
struct KindRules {
  // clang-format off
  //                                        surface     scan   volume

  // Refinement: num_refine_samples divided by this is the number of samples that the last stage reflects. Scans are
  // limited by their visible part.
  KindRule<int> full_divisor              {       1,       4,       1};
  // num_refine_samples divided by this is the number of samples reflected for candidates that are not likely.
  KindRule<int> rough_divisor             {      10,      20,      10};
  // Least merit of candidates that may be symmetries; others take fewer samples and iterations.
  KindRule<double> likely_merit           {    0.83,    0.93,    0.83};

  // Families: least mean share of the visible surface that their planes map onto the surface.
  KindRule<double> family_share           {    0.92,    0.98,    0.92};
  // Share of the surface by which the planes of a family may differ, at points_of_allowance points or more.
  KindRule<double> family_allowance       {   0.015,   0.015,   0.012};
  KindRule<double> points_of_allowance    {     0.0,     0.0, 10000.0};
  // Number of points that judge a family; a look-up in a density costs a tenth of a search.
  KindRule<int> family_samples            {    1500,    1500,   15000};
  // clang-format on
};

inline constexpr KindRules kKindRules;

}  // namespace pcl_symmetry
