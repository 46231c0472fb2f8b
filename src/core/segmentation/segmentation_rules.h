#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct SegmentationRules {
  // Thickness of the body behind a patch
  int samples_of_patch = 6;  ///< for one median per patch
  int rays_of_sample = 6;    ///< into the body
  double cone_angle = 0.61;  ///< radians between the rays and the inward normal: 35 degrees
  float min_reach = 1e-4f;   ///< radii from the surface at which rays begin: beyond rounding, thinner than walls
  float cloud_reach = 2.5f;  ///< where rays of clouds begin, square roots of the area of a point: triangles overlap

  // Merging
  int num_patches = 200;          ///< fewer lose small parts; time and memory grow with the square
  std::size_t num_divisions = 4;  ///< whose merges are averaged: a Rand distance of 0.134 with one, 0.124 with four
  /// Least share of the surface, and in a cloud also of its points, in a part; ears are larger, noise is smaller.
  double min_part = 0.003;
  double part_cut_band = 0.03;  ///< square roots of the area of the surface, within which borders of parts may move
  double part_concavity =
      3.0;  ///< SplittingOptions::concavity_weight of these cuts; more lets borders follow every crease

  // Splitting
  double cut_band = 0.1;   ///< radii of the part, within which the minimum cut may lie
  double min_share = 0.1;  ///< of a part that a plane maps onto itself if the part is split; the paper's 10 %
  double max_share = 0.9;  ///< of a part that the plane maps onto itself, at most; the paper's 90 %

  // Divisions
  /// Share of the surface; smaller intersections of divisions join the closest larger one.
  double min_cell = 0.0005;
  /// Angles of a cloud over those of a mesh: normals of points spread a crease over several rows.
  float sharpened = 1.5f;
  double surely_one = 1.0;  ///< log odds from which on two regions are one part: probability 0.73

  // Labels that agree across a plane
  double global_share = 0.95;  ///< least share of the surface that such a plane maps onto itself
  double min_across = 0.2;     ///< share of a segment on the smaller side of a plane that it lies across

  // Orientation
  int orientation_rays = 2000;  ///< for each connected piece at most
  float ray_start = 2.0f;       ///< square roots of the area of an element, as cloud_reach

  // Patches
  float concave_detour = 4.0f;  ///< length that a radian of a concave edge adds

  // Regions
  double thinnest = 1e-3;           ///< radii; bound of the logarithm of the thickness
  double min_area = 1e-9;           ///< share of the surface; keeps regions without area out of 0 / 0
  double min_inner_sight = 0.05;    ///< the fitted weights know this bound
  double max_relative_sight = 1.5;  ///< the fitted weights know this bound

  // Symmetries of parts
  std::size_t max_planes = 20;   ///< strongest maxima that are features
  int feature_samples = 4000;    ///< on the surface of a part
  int published_samples = 1000;  ///< points reflected as published; the paper's 10 000 take minutes a mesh
  int refined_samples = 400;     ///< that Iterative Symmetric Points reflects
  float mapped = 0.5f;       ///< f from which on an element counts as mapped onto the surface, 0.83 sigma away from it
  MapSize map_size;          ///< of the transform of a part
  int num_map_samples = 64;  ///< of each bin
  /// Sigmas of the distance transform, width of the weights at the end of the refinement.
  double final_sigma = 0.5;
};

inline constexpr SegmentationRules kSegmentation{};

}  // namespace pcl_symmetry
