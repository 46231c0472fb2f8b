#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct ScanRules {
  // Filter of depth images
  double even_share = 0.8;  ///< share of the pixels that measure the error; the rest has edges
  /// Root mean square of the smallest 80 % of normally distributed errors, in standard deviations.
  double trimmed_deviation = 0.6616;
  double min_error = 0.1;  ///< least error that is filtered, pixel sizes: smaller ones do not affect shapes
  /// Greatest growth of second differences at twice the distance; a Kinect has up to 1.6, shapes 4.
  double max_growth = 2.0;
  /// Tangent of the slant up to which neighbors count at the start.
  double slant_at_start = 1.0;
  /// Deviation, errors of an inverse depth, beyond which a pixel shows another surface.
  float surface_cut = 3.0f;
  /// Deviation from the plane of the neighbors, errors of an inverse depth, beyond which a pixel is a flying one: 1.2 %
  /// of normally distributed errors are greater.
  float flying_cut = 2.5f;
  int filter_rounds = 3;  ///< number of rounds, after which the weights are settled
  /// Least sum of the weights around a valid pixel; a leg of two pixels has ten.
  float fewest_neighbors = 4.0f;

  // Sides of the image that cut an object
  std::size_t grid_samples = 1000;  ///< points whose neighbors show the grid
  int grid_neighbors = 4;           ///< neighbors of a point in a grid of squares
  /// Least length of the mean of exp(4 i angle) over directions to neighbors; scans have 0.9, unorganized points 0.05.
  double min_grid = 0.5;
  /// Greatest angle between an image side and the pixel rows, radians. Points are up to 0.1 radians off the middle of
  /// the image, and its sides are 0.4 radians apart: the angle is the product of the two.
  double max_side_angle = 0.044;
  double side_angle_step = 0.1 * max_side_angle;
  int min_row = 10;  ///< least number of points of the last row; round ends of objects have fewer
  /// Least ratio of the points of the last row to the mean of the two rows before it; it is smaller at the ends of most
  /// objects.
  double min_row_ratio = 0.8;
  double beside_outline = 0.1;  ///< distance beside an outline at which the image is read, radii of the outline

  // Depth images made from points
  /// Mean number of points per pixel: on a surface that faces the viewer, one pixel in seven is then empty and can be
  /// closed.
  double points_per_pixel = 4.0;
  /// The same if the rays of a scene lie in rings; with 4, silhouettes would be as wide as the gaps.
  double points_per_ring_pixel = 1.3;
  double gap_of_rings = 3.0;    ///< least typical gap of rings, pixels; random points have 2, 64 rings of a LiDAR 3
  double longest_bridge = 3.0;  ///< longest gap that is bridged, typical gaps: a ring may miss a dark spot
  /// Accuracy of the pixel size, as a share of it: the number of points per pixel is within 10 %.
  double pixel_size_accuracy = 0.05;
  int closing_neighbors = 5;  ///< filled neighbors of eight that close a pixel
  int closing_passes = 3;     ///< number of passes, each of which narrows holes by a pixel on each side
  double small_hole = 0.01;   ///< largest hole that is closed, as a share of the filled pixels; handles are larger
  /// Largest hole in the image of a scene that is closed, in points that it would hold: a gap between samples of one of
  /// many surfaces.
  double largest_scene_hole = 100.0;
  /// Least number of the four directions in which a pixel inside the measured part has filled pixels; with 4, the sky
  /// between two objects would be outside.
  int inside_sides = 3;

  // Density of points as evidence of the viewpoint
  std::size_t density_points = 20'000;        ///< greatest number of points, which bounds the time of the search
  std::size_t density_samples = 1500;         ///< samples of the surface
  Eigen::Index coarse_density_samples = 300;  ///< samples that compare directions
  std::size_t fewest_density_samples = 20;    ///< least number of samples; fewer leave direction and distance to chance
  /// The density at a point comes from this fraction of the points, within the two limits below.
  std::size_t neighborhoods = 600;
  /// Least number of neighbors; the logarithm of the density has a variance of 1 / number.
  std::size_t fewest_density_neighbors = 12;
  std::size_t max_density_neighbors = 32;  ///< greatest number of neighbors; more round off edges
  float thickest = 0.5f;                   ///< greatest thickness over width of a neighborhood on a surface
  /// Least width over length of a neighborhood; less is a line, unless the surface slants by 80 degrees.
  float thinnest = 0.05f;
  double trimmed = 0.1;  ///< share of the samples that is trimmed at either end: edges and gaps
  /// Least squared cosine of the slant, 82 degrees: normals are not more certain than that.
  float min_sq_cosine = 0.02f;
  Eigen::Index density_patches = 64;  ///< patches of the surface, of 23 samples each
  double min_variance = 1e-3;  ///< least variance of the logarithm of the density: the accuracy, 3 %, of a perfect scan
  float largest_residual = 1.0f;  ///< greatest residual of the logarithm of the density; edges have more
  int num_directions = 128;       ///< directions of the search, 18 degrees apart: a quarter of the width of the minimum
  /// Greatest share of the variance that the best direction may leave before the refinement, which halves it at most.
  double hopeless = 1.5;
  int num_viewpoint_starts = 3;     ///< directions that are refined; with two, one scan in fifty is missed
  std::size_t max_viewpoints = 12;  ///< minima are 37 degrees apart: a dozen covers half of all directions
  double min_apart = 0.8;           ///< greatest cosine of the angle between starts
  double first_distance = 4.0;      ///< distance of the starts, radii: the object fills the image of a camera there
  /// Least distance of a viewpoint, radii. From 1.04 radii on, all points lie within 75 degrees of the middle.
  double min_distance = 1.3;
  /// Greatest distance of a viewpoint, radii; rays from there are parallel to within 2 degrees.
  double greatest_distance = 30.0;
  /// First step of the refinement, radians: the angle between neighboring directions. The logarithm of the distance
  /// changes by twice the step.
  double first_step = 0.2;
  double middle_step = 0.25 * first_step;
  double last_step = 0.25 * middle_step;  ///< half a degree, less than the error of the result
  int max_moves = 4;                      ///< greatest number of moves of one size

  // Errors of a depth camera
  /// Least distance of pixels whose errors are independent, pixels; a Kinect matches windows of up to 11.
  int window = 6;
  /// Greatest ratio of the deviation of pixels so far apart to the deviation of neighbors if each pixel has an error of
  /// its own.
  double max_own = 1.5;
  /// Greatest value of this ratio if neighbors share errors: 1.8 to 2.5 in frames of a Kinect, more where shapes bend.
  double max_shared = 2.2;

  // One view or several
  /// Depth behind others at which points are hidden, radii; more than the depth within a pixel of a slanting surface.
  double hidden_margin = 0.1;
  double max_hidden = 0.18;  ///< greatest share of hidden points; scans have up to 0.1, whole objects 0.3 and more
  /// Greatest share of layered points; 400 scans of models have less, 94 % of whole clouds more.
  double max_layered = 0.25;
  double steepest = 4.0;     ///< greatest depth over width within one surface: it slants by up to 76 degrees
  double roughnesses = 6.0;  ///< greatest distance between two points of one rough surface, roughnesses
  /// Greatest number of points examined; they leave the share uncertain by 0.011.
  Eigen::Index max_layer_samples = 2000;

  // Viewpoints that are inferred
  /// Greatest share of the variance of the density that a viewpoint may leave; scans leave 0.005 to 0.7, most whole
  /// clouds more than 1.
  double max_unexplained = 0.75;
  /// Greatest variance of the logarithm of the density over 64 patches; scans have 0.005, two put together 0.015.
  double max_uneven = 0.008;
  /// Share of the variance of the density, and of the variance that random points would have. If a viewpoint leaves
  /// less unexplained, more layers are allowed, as in leaves and wires.
  double surely_explained = 0.25;
  double surely_even = 0.25 * max_uneven;  ///< greatest variance over patches at which more layers are allowed
  /// Factor on the variance that the best viewpoint leaves, within which another viewpoint is as good: the true
  /// viewpoint of 1000 points is within it.
  double as_good = 1.3;
  /// Variance added to this limit: a depth camera is 3 degrees from the best viewpoint.
  double as_good_beyond = 2.0 * min_variance;
  /// Greatest variance that one of several viewpoints may leave; true ones leave 0.0023, two scans put together 0.006.
  double max_of_several = 0.003;
  /// Least number of points: they give 25 independent densities, a quarter of whose variance three parameters explain
  /// by chance.
  Eigen::Index fewest_points = 300;
  int border_samples = 2000;  ///< points examined for open borders
  /// Share of the surface near open borders from which on it is a wire; scans have up to 0.8, curves in space 1.
  double wire = 0.9;
};

inline constexpr ScanRules kScan;

}  // namespace pcl_symmetry
