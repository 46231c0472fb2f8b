#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/segmentation/adjacency.h"
#include "core/segmentation/part_evidence.h"

namespace pcl_symmetry {

/// Evidence of whether two neighboring regions are one part.
enum Cue {
  kAlways,             ///< 1
  kContact,            ///< length of the common border over the shorter perimeter, in [0, 1]
  kSmallArea,          ///< log of the smaller area, a share of the surface
  kLargeArea,          ///< log of the larger area, a share of the surface
  kSupportDifference,  ///< root mean square difference of their support for the planes of the surface, in [0, 1]
  kImages,             ///< 1 if some plane reflects each onto the other, else 0
  kEdgeConcavity,      ///< mean concavity of the edges along the border, radians
  kPatchConcavity,  ///< mean concavity between the patches on both sides of the border, as PatchBorder::patch_concavity
  kInnerConcavity,  ///< mean concavity between the patches within the two regions, as PatchBorder::patch_concavity
  kThicknessRatio,  ///< |log| of the ratio of the thicknesses of the two regions
  kConstriction,    ///< log of the thickness of the thinner region over the thickness at the border
  kSight,           ///< share of the pairs of patches, one in each region, with a free line of sight within the body
  kRelativeSight,   ///< kSight divided by the same share within the regions
  kSightOfSmall,    ///< kSight * kSmallArea
  kNumCues
};
using Cues = std::array<double, kNumCues>;

/// Log odds per unit of each cue, in the order of Cue.
using MergeWeights = std::array<double, kNumCues>;

/// Regions of a surface that are merged; initially one per patch. A region has the number of one of its patches.
class Regions {
public:
  /// One region per patch.
  explicit Regions(const PartEvidence& evidence);

  /// \return the number of patches; regions have numbers below it.
  int size() const { return static_cast<int>(areas_.size()); }

  /// \return area of a region, as a share of the surface.
  double area(int region) const { return areas_[region]; }

  /// \return the region of each patch.
  const std::vector<int>& ofPatches() const { return region_; }

  /// The cues of two neighbors.
  Cues cues(int a, int b) const;

  /// Makes \p b part of \p a; they need not be neighbors.
  void merge(int a, int b);

  /// Sums along the border of two regions, weighted by length.
  struct Border {
    double length = 0.0, edge_concavity = 0.0, patch_concavity = 0.0, log_thickness = 0.0;
    void operator+=(const Border& other);
  };
  /// \return the borders of a region, by neighbor.
  const std::map<int, Border>& borders(int region) const { return borders_.borders(region); }

private:
  int imageOf(int region, const Eigen::MatrixXf& shared) const;

  std::vector<int> region_;              ///< region of each patch
  std::vector<double> areas_;            ///< shares of the surface
  std::vector<double> log_thickness_;    ///< sums over patches, weighted by area
  std::vector<double> perimeters_;       ///< input units
  std::vector<Border> inside_;           ///< sums over the borders between patches of one region
  Eigen::MatrixXf sight_;                ///< sums over pairs of patches, weighted by both areas
  Eigen::MatrixXf support_;              ///< planes x regions, sums over patches, weighted by area
  std::vector<Eigen::MatrixXf> images_;  ///< per plane: area of the reflection of a region (column) in a region
  Adjacency<Border> borders_;
};

/// Region \p from became part of region \p into.
struct Merge {
  int into, from;
  double log_odds;  ///< log odds that the two are one part, when they were merged
};

/// Merges neighboring regions, the pair that is most likely one part first, until no two regions are neighbors. Log
/// odds are updated after each merge.
std::vector<Merge> mergeRegions(Regions regions, const MergeWeights& weights);

/// Probabilities that pairs of elements are in one part, from the merges of one division into patches.
struct MergedDivision {
  std::vector<int> cell;        ///< cell of each element, from 0: cells are regions that are surely one part
  Eigen::MatrixXf probability;  ///< cells x cells, probability that two cells are one part, in [0, 1]
};

/// Merges the patches of a division. The probability that two cells are one part is the least one among the merges that
/// join them.
/// \param num_parts 0, or the number of remaining regions: regions that are merged later are surely not one part.
MergedDivision mergedDivision(const PartEvidence& evidence, const MergeWeights& weights, int num_parts);

/// The same division, reflected.
/// \param reflected the element at the reflection of each element.
MergedDivision reflectedDivision(const MergedDivision& division, const std::vector<int>& reflected);

}  // namespace pcl_symmetry
