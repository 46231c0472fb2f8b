#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// Parameters that affect which shapes matching finds.
struct MatchingRules {
  // Signatures
  // Half the side of the cube of a signature, mean distances of the points from the middle.
  double signature_reach = 2.5;
  int normal_cells = 60;  // cells with one normal each, across the bounding ball
  // Least root mean square along an axis, as a share of the greatest: flat shapes are stretched no further.
  float min_spread = 0.05f;
  int num_iterations = 4;  // iterations of the search for the components of greatest variance
  // Power of their standard deviation by which coefficients are divided: what all shapes have in common counts less.
  // With 0, it is the L2 distance of the signatures; with 1, noise counts as much as shape.
  double whitening = 0.4;
  double candidate_share = 0.02;      // share of all compact forms whose components are all compared
  Eigen::Index frame_points = 4'096;  // points that determine the symmetry frame of a signature

  // Descriptors of the paper
  // Radius of the ball that descriptors describe, mean distances of the points from the origin.
  double described_radius = 2.0;
  int transform_cells = 64;             // cells of the distance transform in which planes are measured
  double transform_sigma = 1.0 / 16.0;  // width of that transform, radii: planes need a narrower one than positions

  // Views
  int outline_cells = 48;          // cells across the larger side of an outline
  int raster_cells = 32;           // cells across a raster
  float raster_reach = 2.5f;       // half the side of a raster, radii of the outline
  double outer_ring = 2.3;         // outer edge of the rings, radii of the outline
  float deepest = 2.0f;            // greatest depth, radii of the outline: greater ones count as this
  float magnitude_weight = 0.7f;   // weight of the magnitudes in ViewAgreement::distance
  int num_mean_views = 2;          // views of a shape whose mean distance ranks it: a scan lies between views
  double size_weight = 0.25;       // distance added by radii that differ by a factor of e; hidden parts change them
  std::size_t num_view_poses = 6;  // nearest views of each shape that give poses

  // A few points of a surface
  int num_surface_points = 5000;  // points from which they are selected

  // Pairs of points
  int num_neighbors = 16;          // neighbors that determine a normal
  int num_pair_points = 250;       // points of a shape
  int num_scan_points = 120;       // points of a scan
  int num_references = 20;         // points of a scan that vote, each paired with all others
  double min_pair_distance = 0.2;  // least distance, radii: nearer points are too uncertain
  double mean_weight = 8.0;        // weight of a pair of mean frequency; it falls with the root of the frequency
  double max_weight = 64.0;        // greatest weight, of rare pairs
  double same_angle = 0.4;         // angle within which poses count as one, radians
  double same_position = 0.15;     // distance within which poses count as one, radii

  // Screening of poses
  int num_screened_points = 1000;  // points of a shape
  int num_judged_points = 60;      // points by which all poses are judged
  double judged_width = 0.2;       // width of the Gaussian for that, radii
  int num_improved = 250;          // best poses of all shapes that are improved
  int num_improved_points = 240;   // points by which they are improved
  int num_steps = 10;              // steps of the improvement
  double first_width = 0.25;       // width of the Gaussian at the first step, radii
  double last_width = 0.1;         // width of the Gaussian at the last step, radii
};
inline constexpr MatchingRules kMatching;

}  // namespace pcl_symmetry
