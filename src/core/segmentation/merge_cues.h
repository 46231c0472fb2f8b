#pragma once

#include <array>

namespace pcl_symmetry {

/// What speaks for or against two neighboring regions being one part.
enum Cue {
  kAlways,             ///< 1
  kContact,            ///< length of the common border over the shorter perimeter, in [0, 1]
  kSmallArea,          ///< log of the smaller area, a share of the surface
  kLargeArea,          ///< log of the larger area, a share of the surface
  kSupportDifference,  ///< root mean square difference of their support for the planes of the surface, in [0, 1]
  kImages,             ///< 1 if some plane reflects each onto the other, else 0
  kEdgeConcavity,      ///< mean concavity of the edges along the border, radians
  kPatchConcavity,     ///< mean concavity between the patches on both sides of the border, as PatchBorder
  kInnerConcavity,     ///< mean concavity between the patches within the two regions, as PatchBorder
  kThicknessRatio,     ///< |log| of the ratio of their thicknesses
  kConstriction,       ///< log of the thickness of the thinner region over the thickness at the border
  kSight,              ///< share of the pairs of patches, one in each region, with a free line of sight within the body
  kRelativeSight,      ///< kSight over the same share within the regions
  kSightOfSmall,       ///< kSight * kSmallArea
  kNumCues
};
using Cues = std::array<double, kNumCues>;

/// Log odds per unit of each cue, in the order of Cue.
using MergeWeights = std::array<double, kNumCues>;

}  // namespace pcl_symmetry
