#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct SegmentationRules {
  // Thickness of the body behind a patch
  int samples_of_patch = 6;  ///< samples of a patch that give its median
  int rays_of_sample = 6;    ///< rays from a sample into the body
  double cone_angle = 0.61;  ///< greatest angle between the rays and the inward normal, radians: 35 degrees
  /// Distance from the surface at which rays begin, radii: beyond rounding, thinner than walls.
  float min_reach = 1e-4f;
  /// Distance at which rays of clouds begin, square roots of the area of a point, because triangles overlap.
  float cloud_reach = 2.5f;

  // Merging
  int num_patches = 200;  ///< patches of a division; fewer lose small parts, and time and memory grow with the square
  /// Divisions whose merges are averaged: a Rand distance of 0.134 with one, of 0.124 with four.
  std::size_t num_divisions = 4;
  /// Least share of the surface, and in a cloud also of its points, of a part; ears are larger, noise is smaller.
  double min_part = 0.003;
  /// Distance within which borders of parts may move, square roots of the area of the surface.
  double part_cut_band = 0.03;
  /// SplittingOptions::concavity_weight of these cuts; more lets borders follow every crease.
  double part_concavity = 3.0;

  // Splitting
  double cut_band = 0.1;   ///< distance from the old border within which the minimum cut may lie, radii of the part
  double min_share = 0.1;  ///< least share of a part that a plane maps onto itself for a split; the paper's 10 %
  double max_share = 0.9;  ///< greatest share of a part that the plane maps onto itself for a split; the paper's 90 %

  // Divisions
  /// Least share of the surface of an intersection of divisions; smaller ones join the closest larger one.
  double min_cell = 0.0005;
  /// Factor on the angles of a cloud, whose normals spread a crease over several rows; 1 for a mesh.
  float sharpened = 1.5f;
  double surely_one = 1.0;  ///< least log odds with which two regions are surely one part: probability 0.73

  // Labels that are symmetric in a plane
  double global_share = 0.95;  ///< least share of the surface that such a plane maps onto itself
  double min_across = 0.2;     ///< least share of a segment on the smaller side of a plane that it lies across

  // Orientation
  int orientation_rays = 2000;  ///< greatest number of rays for each connected piece
  float ray_start = 2.0f;       ///< distance at which these rays begin, square roots of the area of an element

  // Patches
  float concave_detour = 4.0f;  ///< factor by which a radian of a concave edge adds to the length of a step

  // Regions
  double thinnest = 1e-3;           ///< least thickness, radii; bounds its logarithm
  double min_area = 1e-9;           ///< least area, share of the surface; avoids 0 / 0 for regions without area
  double min_inner_sight = 0.05;    ///< least share of sight within regions; the weights were fitted with this bound
  double max_relative_sight = 1.5;  ///< greatest relative sight; the weights were fitted with this bound

  // Symmetries of parts
  std::size_t max_planes = 20;   ///< greatest number of maxima that are features, strongest first
  int feature_samples = 4000;    ///< samples on the surface of a part
  int published_samples = 1000;  ///< points reflected as published; the paper's 10 000 take minutes a mesh
  int refined_samples = 400;     ///< points that Iterative Symmetric Points reflects
  float mapped = 0.5f;       ///< f from which an element counts as mapped onto the surface: 0.83 sigmas away from it
  MapSize map_size;          ///< bins of the transform of a part
  int num_map_samples = 64;  ///< samples of that transform
  /// Width of the weights at the end of the refinement, sigmas of the distance transform.
  double final_sigma = 0.5;
};

inline constexpr SegmentationRules kSegmentation{};

}  // namespace pcl_symmetry
