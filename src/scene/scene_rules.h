#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/constants.h"

namespace pcl_symmetry::detail {

/// Parameters that affect the objects of a scene. Not in the paper.
struct SceneRules {
  // Scale, supporting planes and clusters.
  std::size_t scale_samples = 1000;                      ///< points that spacing and roughness are measured at
  double plane_spacings = 2.0, plane_roughnesses = 4.0;  ///< from a supporting plane within which points belong to it
  double cluster_spacings = 4.0;                         ///< between points of one object
  int max_planes = 6;                                    ///< a table, a floor, three walls and a large box
  double min_share = 0.08;                               ///< of the points, of planes that are tried
  double bare_share = 0.25;                              ///< least share of the points in a support without objects
  double telling_share = 0.01;            ///< of the points of a plane, beside it, that show on which side the scene is
  double attached = 10.0;                 ///< plane distances behind a plane within which other faces of a body begin
  double footprint_trim = 0.05;           ///< share of the points of a plane beyond each end of its footprint
  int consensus_iterations = 1000;        ///< a plane of 20 % of the points needs 600
  std::size_t consensus_points = 10'000;  ///< that draws are judged by
  int fit_rounds = 3;                     ///< that take the feet of objects out of the fit of a plane
  double fit_deviations = 3.0;            ///< medians of the distances within which points count in it
  double remainder = 2.0, remainder_share = 0.9;  ///< plane distances, and share of a cluster within: rest of a plane

  // Objects on supports.
  double above_share = 0.98;     ///< of the points of an object above a plane that it stands on or before
  double support_margin = 2.0;   ///< plane distances that an object may seem to reach into its support at most
  double around = 10.0;          ///< cluster distances around an object in which the noise of its support is taken
  std::size_t min_around = 50;   ///< points there; fewer take chance for noise
  double rises = 4.0;            ///< deviations of that noise that the foot of an object rises above
  double rises_at_least = 0.25;  ///< spacings that a foot rises above on any plane, also an exact one
  /// Plane distances that a model may reach into the support of its object: cameras measure a table and what stands on
  /// it with different errors, 10 mm apart at 1 m.
  double model_margin = 3.0;

  // Convex pieces: of 107 labeled objects in 37 frames 103 are found with an overlap of one half, 91 without
  // separation.
  double voxel_spacings = 2.6;         ///< edge of a voxel: 5 mm for a Kinect at 1 m
  double supervoxel_voxels = 4.0;      ///< edge of a supervoxel
  float concavity = 10.0f;             ///< degrees by which a surface may bend inward within one object
  float smoothness = 0.1f;             ///< PCL's default: patches with a step between them are apart
  std::uint32_t common_neighbors = 1;  ///< of two patches of one piece; with none, one patch at an edge joins a stack
  std::uint32_t fewest = 15;           ///< supervoxels of a piece; smaller pieces are joined with a neighbor

  // Joining by symmetry. Lengths are in diagonals of the union where no unit is given.
  std::size_t reflected = 500;  ///< points of a piece; a share of one half is known to 2 %
  double explained = 0.9;       ///< share of the points landing in known space that a symmetry maps to the surface
  double informative = 0.1;     ///< share of the points that lands in known space; less decides nothing
  double same_angle = 5.0 * kPi / 180.0;  ///< radians within which planes and axes are one
  double same_offset = 0.03;              ///< diagonals within which planes and axes are one
  double hangs = 0.1;                     ///< height above the foot of the larger piece: noise has half, handles twice
  double trimmed = 0.02;                  ///< share of the points below a foot or above a top: flying pixels
  double normal_spacings = 5.0;           ///< radius that a normal is taken from: averages the noise of a camera
  double level = 0.3;                     ///< horizontal part of a normal that tells where an upright axis is
  int axis_rounds = 5;                    ///< of the fit of an axis to normals
  double misses = 0.05;                   ///< by which a normal may miss the axis; later ones weigh less
  double points_to = 15.0 * kPi / 180.0;  ///< radians within which a normal points to the axis
  double round_share = 0.7;               ///< share of such normals; faces of a square box have a third
  double walls = 0.1;                     ///< share of the points of a round piece with a level normal
  double beside = 0.5;                    ///< share of the lower height that pieces side by side have in common
  double own = 0.25;                      ///< share of the points of both that their own symmetries explain
  double flat = 0.1;                      ///< thickness over length, both root mean squares
  int planes_of_axis = 4;                 ///< that represent an axis, 45 degrees apart
};

inline constexpr SceneRules kScene;
inline constexpr double kDeviationPerMedian = 1.4826;  // of absolute values, normal distribution

}  // namespace pcl_symmetry::detail
