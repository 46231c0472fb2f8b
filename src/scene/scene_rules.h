#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/constants.h"

namespace pcl_symmetry::detail {

/// Parameters that affect the objects of a scene. Not in the paper.
struct SceneRules {
  // Scale, supporting planes and clusters
  std::size_t scale_samples = 1000;  ///< points that spacing and roughness are measured at
  /// Greatest distance of points from their supporting plane, spacings and roughnesses.
  double plane_spacings = 2.0, plane_roughnesses = 4.0;
  /// Least size of a part whose attachment another part of its object hides, as a share of the least size of an object,
  /// and greatest distance of the two in the picture, pixels.
  double hidden_part = 0.25;
  int hidden_border = 3;
  double cluster_spacings = 4.0;  ///< greatest distance between neighboring points of one object, spacings
  int max_planes = 6;             ///< greatest number of planes: a table, a floor, three walls and a large box
  double min_share = 0.08;        ///< least share of the points of planes that are tried
  double bare_share = 0.25;       ///< least share of the points in a support without objects
  /// Share of the points of a plane, on one side of it, that show on which side the scene is.
  double telling_share = 0.003;
  double attached = 10.0;           ///< depth behind a plane within which other faces of a body begin, plane distances
  double footprint_trim = 0.05;     ///< share of the points of a plane trimmed at each end of its footprint
  int consensus_iterations = 1000;  ///< draws of sample consensus; a plane of 20 % of the points needs 600
  std::size_t consensus_points = 10'000;  ///< points by which draws are judged
  int fit_rounds = 3;                     ///< rounds that remove the feet of objects from the fit of a plane
  double fit_deviations = 3.0;            ///< distance within which points count in that fit, medians of the distances
  /// A cluster with this share of its points within this many plane distances is a remainder of a plane.
  double remainder = 2.0, remainder_share = 0.9;

  // Objects on supports
  double above_share = 0.98;  ///< least share of the points of an object above a plane that it stands on or in front of
  /// Greatest depth by which an object may seem to reach into its support, plane distances.
  double support_margin = 2.0;
  /// Distance around an object within which the noise of its support is measured, cluster distances.
  double around = 10.0;
  std::size_t min_around = 50;   ///< least number of points there; with fewer, chance passes for noise
  double rises = 4.0;            ///< height above which points are feet of an object, deviations of that noise
  double rises_at_least = 0.25;  ///< least value of that height on any plane, even an exact one, spacings
  /// Depth to which a model may reach into the support of its object, plane distances: cameras measure a table and the
  /// objects on it with different errors, 10 mm apart at 1 m.
  double model_margin = 3.0;
  double wider = 1.5;  ///< least radius of a table, floor or wall beside a single object, radii of the object
  /// Least rms distance of the points of a support that is a slice of a curved body from it, plane distances; points
  /// spread evenly have 0.58.
  double curved = 0.35;
  /// Least confidence of planes, besides the best one, that complete an object; all of 79 such answers in real frames
  /// are right.
  double sure = 0.8;

  // Bulges of a wall or a table
  /// Greatest rms distance of the points of a piece from their plane, tolerances; 17 pieces of the wall in PCL's stereo
  /// image have 0.5 to 2.4.
  double bulge_tolerances = 3.0;
  /// Least share of the outline of a piece along which the surface continues, and greatest share in front of something
  /// farther away. Such pieces have 0.3 to 0.94 and 0.01 to 0.02 in PCL's frames of a stereo camera and of a Kinect;
  /// flat objects on tables have 0.22 to 0.43 in front of something farther away.
  double goes_on = 0.25, before_farther = 0.05;
  double depth_errors = 4.0;  ///< greatest distance of neighbors on one surface, errors of the sensor's depths

  // Convex pieces. Of 107 labeled objects in 37 frames, 103 are found with an overlap of one half; without separation,
  // 91.
  double voxel_spacings = 2.6;     ///< edge of a voxel, spacings: 5 mm for a Kinect at 1 m
  double supervoxel_voxels = 4.0;  ///< edge of a supervoxel, voxels
  float concavity = 10.0f;         ///< angle by which a surface may bend inwards within one object, degrees
  float smoothness = 0.1f;         ///< PCL's default: patches with a step between them are separate
  /// Least number of common neighbors of two patches of one piece; with none, one patch at an edge joins a stack.
  std::uint32_t common_neighbors = 1;
  std::uint32_t fewest = 15;  ///< least number of supervoxels of a piece; smaller ones are joined with a neighbor

  // Joining by symmetry. Lengths are in diagonals of the union unless stated otherwise.
  std::size_t reflected = 500;  ///< points of a piece that are reflected; a share of one half is known to 2 %
  /// Least share of the points with images in known space that a symmetry maps onto the surface.
  double explained = 0.9;
  double informative = 0.1;  ///< least share of the points whose images lie in known space; less is not decisive
  double same_angle = 5.0 * kDegree;  ///< angle within which planes and axes are one, radians
  double same_offset = 0.03;          ///< offset within which planes and axes are one
  /// Height above the foot of the larger piece from which a piece hangs: noise has half of it, handles have twice.
  double hangs = 0.1;
  double trimmed = 0.02;  ///< share of the points trimmed at a foot or a top: flying pixels
  /// Radius within which a normal is estimated, spacings: it averages the noise of a camera.
  double normal_spacings = 5.0;
  double level = 0.3;    ///< least horizontal part of a normal that shows where an upright axis is
  int axis_rounds = 5;   ///< rounds of the fit of an axis to normals
  double misses = 0.05;  ///< distance by which a normal may miss the axis; normals that miss it by more weigh less
  double points_to = 15.0 * kDegree;  ///< angle within which a normal points to the axis, radians
  double round_share = 0.7;  ///< least share of such normals on a round piece; faces of a square box have a third
  double walls = 0.1;        ///< least share of the points of a round piece with a level normal
  double beside = 0.5;       ///< least share of the lower height that pieces side by side have in common
  double own = 0.25;         ///< least share of the points of both pieces that their own symmetries explain
  double flat = 0.1;         ///< greatest thickness over length of a flat piece, both root mean squares
  int planes_of_axis = 4;    ///< planes that represent an axis, 45 degrees apart
};

inline constexpr SceneRules kScene;
// Standard deviation over the median of absolute values, for a normal distribution.
inline constexpr double kDeviationPerMedian = 1.4826;

}  // namespace pcl_symmetry::detail
