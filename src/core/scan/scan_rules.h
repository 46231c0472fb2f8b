#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct ScanRules {
  // Filter of depth images
  double even_share = 0.8;  ///< share of the pixels that measure the error; the rest has edges
  /// Root mean square of the least 80 % of normal errors, per standard deviation.
  double trimmed_deviation = 0.6616;
  double min_error = 0.1;   ///< pixel sizes; smaller errors do no harm to shapes
  double max_growth = 2.0;  ///< growth of second differences at twice the distance; a Kinect has up to 1.6, shapes 4
  /// Tangent of the slant up to which neighbors count at the start.
  double slant_at_start = 1.0;
  /// Errors of an inverse depth beyond which a pixel shows another surface.
  float surface_cut = 3.0f;
  /// The same from the plane of the neighbors, beyond which a pixel is a flying one: 1.2 % of normal errors are
  /// greater.
  float flying_cut = 2.5f;
  int filter_rounds = 3;  ///< after which the weights are settled
  /// Least sum of the weights around a valid pixel; a leg of two pixels has ten.
  float fewest_neighbors = 4.0f;

  // Sides of the image that cut an object
  std::size_t grid_samples = 1000;  ///< points whose neighbors show the grid
  int grid_neighbors = 4;           ///< in a grid of squares
  /// Length of the mean of exp(4 i angle) over directions to neighbors; scans have 0.9, points without order 0.05.
  double min_grid = 0.5;
  /// Radians between a side and the rows: that of the middles, 0.1, times that between sides, 0.4.
  double max_side_angle = 0.044;
  double side_angle_step = 0.1 * max_side_angle;
  int min_row = 10;  ///< points of the last row; round ends of objects have fewer
  /// Points of the last row over the mean of the next two rows: less at the ends of most objects.
  double min_row_ratio = 0.8;

  // Depth images made of points
  /// On average: on a surface that faces the viewer, one pixel in seven is then empty and can be closed.
  double points_per_pixel = 4.0;
  /// The same where the rays of a scene lie in rings; at 4, silhouettes are as wide as the gaps.
  double points_per_ring_pixel = 1.3;
  double gap_of_rings = 3.0;          ///< typical gap in pixels; points at random have 2, 64 rings of a LiDAR 3
  double longest_bridge = 3.0;        ///< typical gaps that are bridged: a ring may miss a dark spot
  double pixel_size_accuracy = 0.05;  ///< share of the size; leaves the points in a pixel off by 10 %
  int closing_neighbors = 5;          ///< filled neighbors of eight that close a pixel
  int closing_passes = 3;             ///< each narrows holes by a pixel on each side
  double small_hole = 0.01;           ///< share of the filled pixels; handles are larger
  double largest_scene_hole = 100.0;  ///< points; a gap between samples of one surface of many
  /// Directions of four with filled pixels; with 4, the sky between two objects would not be inside.
  int inside_sides = 3;

  // Density of points as a sign of the viewpoint
  std::size_t density_points = 20'000;        ///< at most; bounds the time of the search
  std::size_t density_samples = 1500;         ///< of the surface
  Eigen::Index coarse_density_samples = 300;  ///< that compare directions
  std::size_t fewest_density_samples = 20;    ///< fewer leave direction and distance to chance
  /// The density at a point comes from this fraction of the points, within the bounds below.
  std::size_t neighborhoods = 600;
  std::size_t fewest_density_neighbors = 12;  ///< the logarithm of the density has a variance of 1 / number
  std::size_t max_density_neighbors = 32;     ///< more round off edges
  float thickest = 0.5f;                      ///< thickness over width of a neighborhood of a surface
  float thinnest = 0.05f;                     ///< width over length; less is a line, unless it slants by 80 degrees
  double trimmed = 0.1;                       ///< share of the samples at either end: edges and gaps
  float min_sq_cosine = 0.02f;                ///< of the slant, 82 degrees: normals are not surer than that
  Eigen::Index density_patches = 64;          ///< of the surface, 23 samples each
  double min_variance = 1e-3;                 ///< of the logarithm of the density: the accuracy, 3 %, of a perfect scan
  float largest_residual = 1.0f;              ///< of the logarithm of the density; edges have more
  int num_directions = 128;                   ///< 18 degrees apart, a quarter of the width of the minimum
  /// Share of the variance that the best direction may leave before the search, which halves it at most.
  double hopeless = 1.5;
  int num_viewpoint_starts = 3;     ///< two miss one scan in fifty
  std::size_t max_viewpoints = 12;  ///< minima are 37 degrees apart: a dozen covers half of all directions
  double min_apart = 0.8;           ///< cosine of that angle between starts
  double first_distance = 4.0;      ///< radii; distance of a camera whose image the object fills
  double min_distance = 1.3;        ///< radii; points lie within 75 degrees of the middle from 1.04 radii on
  double greatest_distance = 30.0;  ///< radii; rays from there are parallel to within 2 degrees
  /// Radians, and halves of the logarithm of the distance: the distance between directions.
  double first_step = 0.2;
  double middle_step = 0.25 * first_step;
  double last_step = 0.25 * middle_step;  ///< half a degree, less than the error of the result
  int max_moves = 4;                      ///< of one size

  // Errors of a depth camera
  int window = 6;  ///< pixels between two whose errors are independent; a Kinect matches windows of up to 11
  /// Deviation of such pixels over that of neighbors, at most, where each pixel has an error of its own.
  double max_own = 1.5;
  /// Deviation of such pixels over that of neighbors, at most: 1.8 to 2.5 in frames of a Kinect, more where shapes
  /// bend.
  double max_shared = 2.2;

  // One view or several
  double hidden_margin = 0.1;  ///< radii; more than the depth within a pixel of a slanting surface
  double max_hidden = 0.18;    ///< share of the points; scans have up to 0.1, whole objects 0.3 and more
  double max_layered = 0.25;   ///< share of the points; 400 scans of models have less, 94 % of whole clouds more
  double steepest = 4.0;       ///< depth over width of one surface: it slants by up to 76 degrees
  double roughnesses = 6.0;    ///< between two points of one rough surface at most
  Eigen::Index max_layer_samples = 2000;  ///< leave the share uncertain by 0.011

  // Viewpoints that are inferred
  /// Share of the variance of the density; scans leave 0.005 to 0.7, most whole clouds more than 1.
  double max_unexplained = 0.75;
  /// Variance of the logarithm of the density over 64 patches; scans have 0.005, two put together 0.015.
  double max_uneven = 0.008;
  /// Share of the variance, and of that of points at random, left from which on more layers are allowed: leaves, wires.
  double surely_explained = 0.25;
  double surely_even = 0.25 * max_uneven;  ///< variance over patches up to which more layers are allowed
  double as_good = 1.3;  ///< variance left by the true viewpoint of 1000 points over that left by the best one
  double as_good_beyond =
      2.0 * min_variance;  ///< variance of the logarithm: a depth camera 3 degrees from the best viewpoint
  /// Variance that one of several viewpoints may leave; true ones leave 0.0023, two scans put together 0.006.
  double max_of_several = 0.003;
  /// 25 independent densities, of which three numbers explain a quarter by chance.
  Eigen::Index fewest_points = 300;
  int border_samples = 2000;  ///< points examined for open borders
  double wire = 0.9;          ///< share of the surface near open borders; scans have up to 0.8, curves in space 1
};

inline constexpr ScanRules kScan;

}  // namespace pcl_symmetry
