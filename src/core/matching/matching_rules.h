#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// Parameters that affect which shapes matching finds.
struct MatchingRules {
  // Signatures
  double signature_reach = 2.5;  // mean distances from the middle: half the side of the cube
  int normal_cells = 60;         // across the bounding ball, one normal each
  float min_spread = 0.05f;      // of the greatest root mean square: flat shapes are stretched no further
  int num_iterations = 4;        // of the search for the components of greatest variance
  // Power of their standard deviation that coefficients are divided by: what all shapes have in common counts less. 0
  // is the L2 distance of the signatures, 1 lets noise count as much as shape.
  double whitening = 0.4;
  double candidate_share = 0.02;      // of all compact forms, whose components are all compared
  Eigen::Index frame_points = 4'096;  // that the symmetry frame of a signature is made of

  // Descriptors of the paper
  double described_radius = 2.0;        // of the ball that they describe, mean distances of the points from the origin
  int transform_cells = 64;             // of the distance transform that planes are measured in,
  double transform_sigma = 1.0 / 16.0;  // and its width, radii: planes need a narrower one than positions

  // Views
  int outline_cells = 48;          // across the larger side of an outline
  int raster_cells = 32;           // across a raster
  float raster_reach = 2.5f;       // radii of the outline: half the side of a raster
  double outer_ring = 2.3;         // radii of the outline: outer edge of the rings
  float deepest = 2.0f;            // radii of the outline: greater depths count as this
  float magnitude_weight = 0.7f;   // of the magnitudes in ViewAgreement::distance
  int num_mean_views = 2;          // views of a shape whose mean distance ranks it: a scan lies between views
  double size_weight = 0.25;       // distance added by radii that differ by a factor of e; hidden parts change them
  std::size_t num_view_poses = 6;  // of each shape: its nearest views

  // A few points of a surface
  int num_surface_points = 5000;  // points that they are chosen from

  // Pairs of points
  int num_neighbors = 16;          // neighbors for a normal
  int num_pair_points = 250;       // of a shape
  int num_scan_points = 120;       // of a scan
  int num_references = 20;         // points of a scan that vote, each with all others
  double min_pair_distance = 0.2;  // radii: nearer points are too uncertain
  double mean_weight = 8.0;        // weight of a pair of mean frequency; it falls with the root of the frequency
  double max_weight = 64.0;        // of a rare pair
  double same_angle = 0.4;         // radians, poses that are one,
  double same_position = 0.15;     // and radii

  // Screening of poses
  int num_screened_points = 1000;  // of a shape
  int num_judged_points = 60;      // that all poses are judged by,
  double judged_width = 0.2;       // radii, with this width of the Gaussian
  int num_improved = 250;          // best poses of all shapes that are improved,
  int num_improved_points = 240;   // by this many points,
  int num_steps = 10;              // in as many steps,
  double first_width = 0.25;       // radii, from this width
  double last_width = 0.1;         // radii, to this one
};
inline constexpr MatchingRules kMatching;

}  // namespace pcl_symmetry
