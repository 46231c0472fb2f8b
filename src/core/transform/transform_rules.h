#pragma once

#include <Eigen/Core>
#include <cstddef>
#include "core/base/constants.h"

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct TransformRules {
  // Axes
  int num_rotations = 12;  ///< rotations between 0 and pi that represent rotations by any angle
  /// Difference up to which values of D count as equal: at the axis of a bottle they differ by 0.001, of a rim with
  /// five spokes by 0.010.
  double equal_orders = 0.005;
  std::size_t max_axis_bins = 50'000;  ///< greatest number of bins that are examined, strongest first
  int starts_per_maximum = 6;  ///< bins from which each maximum is searched, because some are shoulders of others
  /// Least value of a bin, as a share of min_value: D between bins is up to 50 % greater.
  double min_of_bin = 0.6;
  double same_start = 0.14;  ///< angle between starts below which they lead to one maximum, radians: its half width
  double same_maximum = 15.0 * kDegree;  ///< angle below which maxima may be one, radians
  double same_offset = 3.0;              ///< distance below which maxima may be one, sigmas
  int more_samples = 4;                  ///< factor on the samples of the map for climbing
  int halvings = 6;                      ///< halvings of the steps, down to 0.05 degrees

  // Bundles of lines
  /// Greatest factor on the distance between lines, by which rows are closer: two whole cells instead of 0.9 sigmas.
  double max_stretch = 1.12;
  double near_whole = 0.1;        ///< cells; at whole distances, all points of a row would be rounded to the same side
  double less_than_whole = 0.87;  ///< factor by which rows are then moved closer

  // Distance transform
  /// Width of the Gaussian in cells, unless the points are sparse. The paper: "according to the maximal frequency of
  /// the grid in order to avoid aliasing". At one cell look-ups alias, at four the peaks of D are twice as wide.
  double sigma_in_cells = 2.0;
  double margin_in_sigmas = 2.0;  ///< empty margin around the ball: outside the grid, f = exp(-2^2) = 0.018 at most
  /// Distance beyond which f is 0: f = exp(-2.6^2) = 1.16e-3 there, less than 3e-4 of its integral lies beyond.
  double reach_in_sigmas = 2.6;
  /// Greatest width for sparse points, radii: a surface of a dozen points has no gaps, and the shape is not a ball.
  double max_spacing = 0.25;
  Eigen::Index num_dense = 200'000;  ///< points from which a cloud is dense enough for usual grids
  std::size_t dense_per_cell = 8;    ///< points per cell of a slice from which thinning pays off
  int slots_per_cell = 4;  ///< slots of a cell along each axis; thinning adds up to sqrt(3) / 4 cells to a distance
  double of_interpolation = 1.0 / 12.0;  ///< variance of a value between cells, a mean over a box of one cell

  // Planes through points
  double pivot_step = 1.0;  ///< distance between points, and between planes at the far end of the shape, cells
  /// The same for planes that multiresolution does not refine; PRST has an error of 0.7 %.
  double coarse_pivot_step = 3.0;

  // Votes
  double near_share = 0.2;          ///< share of the pairs that are drawn plane first
  std::size_t num_vote_blocks = 8;  ///< partial maps, added up in their order
};

inline constexpr TransformRules kTransform{};

}  // namespace pcl_symmetry
