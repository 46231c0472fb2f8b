#pragma once

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct RefinementRules {
  // The normalized cloud
  double final_sigma_in_spacings = 3.0;  ///< narrowest weights; less leaves reflections between samples without any
  double volume_roughness = 0.36;        ///< spacings; points that fill a volume evenly have 0.42
  double volume_dimension = 2.6;         ///< greatest dimension of a few hundred points in a thin shell

  // Iterative Symmetric Points, of planes and of rotations
  double min_stiffness = 1e-3;  ///< share of the stiffest direction below which a direction is free
  double longest_step = 0.2;    ///< radians, extents of the samples or radii; longer steps leave the basin
  double reach_sigmas = 3.0;    ///< sigmas beyond which pairs have no weight
  double stands_still = 1e-7;   ///< radians, extents of the samples; a shorter step counts as none
  double rest_sigmas = 0.1;     ///< sigmas; a shorter step lets the weights narrow
  double hidden_depth = 0.1;    ///< sigmas behind the surface seen over which a pair loses its weight
};

inline constexpr RefinementRules kRefinement;

}  // namespace pcl_symmetry
