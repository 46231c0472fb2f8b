#pragma once

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct RefinementRules {
  // The normalized cloud
  /// Narrowest weights, spacings; less leaves reflections between samples without any weight.
  double final_sigma_in_spacings = 3.0;
  /// Least roughness of points that fill a volume, spacings; evenly distributed ones have 0.42.
  double volume_roughness = 0.36;
  double volume_dimension = 2.6;  ///< greatest dimension of a few hundred points in a thin shell

  // Iterative Symmetric Points for planes and for rotations
  double min_stiffness = 1e-3;  ///< least stiffness of a constrained direction, as a share of the greatest
  /// Greatest step, radians and extents of the samples or radii; longer steps leave the basin.
  double longest_step = 0.2;
  double reach_sigmas = 3.0;   ///< distance beyond which pairs have no weight, sigmas
  double stands_still = 1e-7;  ///< step that counts as none, radians and extents of the samples
  double rest_sigmas = 0.1;    ///< step from which on the weights narrow, sigmas
  double hidden_depth = 0.1;   ///< depth behind the visible surface over which a pair loses its weight, sigmas
};

inline constexpr RefinementRules kRefinement;

}  // namespace pcl_symmetry
