#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/base/constants.h"
#include "core/evidence/plane_confidence.h"
#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

/// The numbers that answers of detection depend on (Section 4.4). Lengths are in radii of the cloud, angles in radians,
/// where no unit is given.
struct DetectionRules {
  /// Which points are used.
  struct {
    double max_points = 20'000.0;          ///< that represent a cloud at the default tolerance
    int density_samples = 1000;            ///< samples of the density; its slope has an error of 2 %
    int max_counted = 48, neighbors = 16;  ///< neighbors that are counted, and that a neighborhood has on average
    double trimmed = 0.05;                 ///< share of the points at either end that the range of densities leaves out
    double uneven = 0.4, fully_uneven = 0.7;  ///< log ratio of densities where thinning starts, and is complete
  } points;

  /// Completion of groups.
  struct {
    int offsets_tried = 8;        ///< along an object, of planes at right angles: refinement moves planes that far
    std::size_t max_closed = 16;  ///< symmetries whose group is completed: a cube has 9, an icosahedron 15
  } closure;

  /// Stages of refinement.
  struct {
    /// Bins beyond its own that refinement may move a candidate by. Departure from the paper, which has 0: one bin
    /// leaves room for the noise of the sampled map.
    double max_drift = 1.0;
    int first_samples = 100;        ///< points reflected in the first stage
    double symmetric_merit = 0.93;  ///< of a symmetry: support of 97 % and conflict of 3 % have 0.97
    int coarse_iterations = 5, close_iterations = 6, full_iterations = 8, rough_iterations = 4;
    double close_slack = 0.1;   ///< below the merit of a symmetry that a candidate may be after the second stage
    double coarse_slack = 0.2;  ///< below it that a candidate may be after the first stage, beside a symmetry
    std::size_t kept_coarsely = 8, kept_closely = 4;  ///< candidates of less merit that go on after either stage
    int close_sample_factor = 4;                      ///< samples of the second stage per sample of the first
    double narrowest_coarsely = 0.5;                  ///< sigmas at the end of the first stage
    double settled_error_share = 3.0;                 ///< standard errors; a shorter step of a symmetry is the last
  } stages;

  /// Planes on surfaces and in volumes.
  struct {
    double first_climb = 0.02, last_climb = first_climb / 8.0;  ///< steps of a climb, radians and radii
    int max_climbs = 24;                                        ///< steps of a climb, of all lengths
    int climb_samples = 500;                                    ///< points by which planes of whole clouds climb
    double min_gain = 0.005;                                    ///< merit that a climb has to gain
    double climbing_merit = 0.5;        ///< merit of planes that climb; those of less are no symmetries
    double climbing_confidence = 0.01;  ///< confidence of planes that climb
    double noisy_depth = 0.1;           ///< roughness, spacings, from which planes of scans climb: noise looks hidden
    double bandwidth = 1.5;             ///< of the density, spacings; less shows single points, more blurs the shape
    int max_iterations = 6;             ///< Newton steps in a density
    int sample_factor = 10;             ///< samples of a density per sample of a surface
  } fit;

  /// Measuring a plane.
  struct {
    double surely_whole = 0.985;    ///< share within the tolerance from which nothing needs to be missing
    double held_stiffness = 0.02;   ///< offset stiffness from which an open border begins to excuse; at twice, in full
    double moved_tolerances = 2.0;  ///< tolerances by which a plane has to move an informative sample of a scan
    double noisy_thinness = 3.0;    ///< tolerances within which a volume of points is a sheet or a line
    double round_spacings = 2.0;    ///< spacings within which points of a line do not resolve its cross-section
    double min_own_share = 0.1;     ///< of the points on the surface of the others; what divides shares is no less
    int screening_samples = 2000;   ///< samples of a quick look, and of SymmetryPlane::deviation
    std::array<double, 2> tolerances{1.0, 2.0};  ///< at which shares are measured, see PlaneEvidence
    double beside_outline = 0.1;  ///< share of its radius beside an outline at which the picture is looked up
  } measure;

  /// Deciding.
  struct {
    double max_cut = 0.3;            ///< share of the outline that the picture may cut off; tables in frames: 0.36
    double hopeful_share = 0.93;     ///< of a quick look; less is no possible symmetry
    double screening_errors = 2.0;   ///< standard errors by which the share of a quick look may be too small
    double max_unmoved_share = 0.5;  ///< share of the points that an uninformative plane leaves in place
    double nothing_missing = 0.01;   ///< share of the surface; less is missing by chance
    double piece_missing = 0.03;     ///< share of the surface; more is a piece
    double odds_of_a_piece = 0.2;    ///< that a cloud lacks a piece although a plane explains all of it
    double as_likely = 0.05;         ///< difference of confidences that other samples of the same shape may reverse
    double min_informative = 0.1;    ///< least share of informative samples; below it confidence falls in proportion
    double coarsest = 3.0;           ///< greatest tolerances; a sensor that resolves less decides nothing
    double upright = 5.0 * kPi / 180.0;  ///< from upright or level within which a plane does not slant
    double touching = 0.05;              ///< diameters beyond the nearest support within which others carry, too
    double slanted_odds = 0.1;           ///< of a plane that slants over one that does not
    double no_surface = 1.5;             ///< tolerances from which neighboring points are too far apart for a surface
    int max_possible = 5;                ///< symmetries and possible planes together, where there are possible ones
    double slope_dip = 0.005;            ///< difference of D that rounding makes of a level slope
    double slope_angle = 0.2,
           slope_offset = 0.15;  ///< radians, radii: a plane and a better one may be on one slope within
  } decide;

  /// Polygons and families.
  struct {
    double contained_offset = 0.03,
           contained_angle = 3.0 * kDegree;  ///< by which a plane may miss a line that it contains
    std::size_t min_planes = 4;              ///< of a lattice; three fit too many by chance
    std::size_t max_pairs = 6;               ///< planes whose common lines are tried for a lattice
    double min_pair_angle = 0.1;             ///< between two planes; less moves their line too far
    double max_folded = 0.2;     ///< angles between neighboring planes of a lattice by which a found plane may miss one
    std::size_t max_planes = 8;  ///< planes whose common lines are tried for an axis
    double min_angle = 0.17;     ///< between two of them
    int screening_planes = 3, fitted_planes = 6,
        tested_planes = 8;       ///< planes of a family that screen it, fit its line, test it
    double rough_factor = 2.0;   ///< allowances in the screening
    double coplanar = 0.05;      ///< share of the largest singular value below which normals are coplanar
    double min_spread = 0.02;    ///< least eigenvalue of the mean outer product of normals, at most 1/3
    int rough_sample_share = 5;  ///< one sample in this many screens a family
    double worst_share = 0.5;    ///< confidence of the worst plane of a family, shares of that of a symmetry
    int refine_iterations = 6;   ///< of a plane of a family
  } families;

  /// Folds of noisy clouds, by their spectrum.
  struct {
    int max_frequency = 120, min_fold = 3;  ///< a cloud that is thinner on one side, or flat, has folds one and two
    int rings = 8, slabs = 4;               ///< about the line: rings for the fold, slabs for the angle of the planes
    int spectrum_samples = 20'000, halfway_samples = 5000;
    int compared_frequencies = 12;         ///< frequencies on either side that one is compared with
    double min_power = 20.0;               ///< round bodies in noise have 15 at most
    double stands_out = 4.0;               ///< medians of the powers beside it
    double max_gap = 0.125;                ///< between angles of folded points, angles between two planes
    double errors = 3.0;                   ///< standard errors by which the planes between those of a polygon are worse
    double odds_of_polygon = 4.0;          ///< of planes of a polygon over other planes of the same evidence
    std::size_t max_line_pairs = 4;        ///< planes whose common lines are tried
    std::array<int, 3> divisors{2, 3, 5};  ///< of parts of a polygon whose planes may differ
  } folds;

  /// Symmetries of parts.
  struct {
    int num_seeds = 24, num_directions = 8;        ///< balls of each radius, and directions beside their principal axes
    std::array<double, 3> radii{0.25, 0.35, 0.5};  ///< of the balls: limbs to halves of a shape
    double min_ball = 0.04, largest_ball = 0.6;    ///< share of the points of a ball
    double min_support = 0.7;                      ///< share of the points of a ball that match
    double farthest_plane = 0.5;                   ///< radii of the ball, from its middle
    double min_part = 0.04, largest_part = 0.9;    ///< share of the points of a part
    double min_edge = 0.4, edge_per_share = 0.5;   ///< longest edge of a part, edges of a disc, and more per share
    double longer_edge = 0.15, shared_part = 0.5;  ///< longer by this where better parts hold at most that share
    double same_part = 0.5;                        ///< share that regions of planes of one part have in common
    std::size_t max_planes_of_part = 9;            ///< those of a cube
    std::array<double, 2> longest_edges_before{1.0, 0.6};  ///< more than that of a part before either round, as above
    int iterations = 6;                                    ///< of a plane of a part
    std::size_t ball_samples = 200, region_samples = 400;  ///< points that are reflected
    int num_region_samples = 4000;                         ///< of a cloud: a part of 4 % has 160
    int num_smoothing = 11, num_connecting = 6;            ///< neighbors that smooth what matches, and that connect it
    double matched_support = 0.8;                          ///< mean support of a neighborhood that matches
    float counterpart = 0.5f;                              ///< support that connects a sample with its counterpart
  } parts;
};

inline constexpr DetectionRules kDetection;

/// A rule that differs between the kinds of cloud.
template <typename T>
struct KindRule {
  T surface, scan, volume;  ///< of points

  constexpr T operator[](CloudKind kind) const {
    return kind == CloudKind::Scan ? scan : kind == CloudKind::Volume ? volume : surface;
  }
};

/// What differs between the kinds of cloud in detection (Section 4.4).
struct KindRules {
  // clang-format off
  //                                        surface     scan   volume

  // The points show all sides. A scan shows too little to complete groups of planes, candidates of little merit may be
  // symmetries, and point-to-plane steps slide along flat pieces; planes of noisy scans climb within the last stage.
  KindRule<bool> shows_all                {    true,   false,    true};
  // Points resolve a surface, whose normals are known. Otherwise the points are made evenly dense, one half of them is
  // compared with the other, and planes of a polygon are judged together, as noise hides single ones.
  KindRule<bool> resolves_surface         {    true,    true,   false};
  // Open borders tell what was cut off.
  KindRule<bool> may_lack_piece           {    true,   false,   false};

  // Refinement: the last stage reflects one sample in this many: a scan is limited by what it shows.
  KindRule<int> full_stride               {       1,       4,       1};
  // Candidates that never settle reflect one sample in this many; ...
  KindRule<int> rough_stride              {      10,      20,      10};
  // ... those with less merit never settle.
  KindRule<double> settled_merit          {    0.83,    0.93,    0.83};

  // Evidence: planes are judged by one sample in this many; 0 = by all points.
  KindRule<int> judged_stride             {       0,       4,       0};
  // Families: share of the surface seen that their planes map on average.
  KindRule<double> family_share           {    0.92,    0.98,    0.92};
  // Share of the surface by which planes of a family may differ, at this many points or more.
  KindRule<double> family_allowance       {   0.015,   0.015,   0.012};
  KindRule<double> points_of_allowance    {     0.0,     0.0, 10000.0};
  // Points that judge a family; a look-up in a density costs a tenth of a search.
  KindRule<int> family_samples            {    1500,    1500,   15000};
  // clang-format on
};

inline constexpr KindRules kKindRules;

}  // namespace pcl_symmetry
