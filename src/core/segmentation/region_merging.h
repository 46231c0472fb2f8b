#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/segmentation/part_evidence.h"
#include "core/segmentation/regions.h"

namespace pcl_symmetry {

/// Region \p from became part of region \p into.
struct Merge {
  int into, from;
  double log_odds;  ///< that the two are one part, when they were merged
};

/// Merges neighboring regions, the pair that is most likely one part first, until no two regions are neighbors. Log
/// odds are updated after each merge.
/// \param regions by value: the merges are made on a copy.
std::vector<Merge> mergeRegions(Regions regions, const MergeWeights& weights);

/// What the merges of one division into patches say about pairs of elements.
struct MergedDivision {
  std::vector<int> cell;        ///< of each element, from 0: regions that are surely one part
  Eigen::MatrixXf probability;  ///< cells x cells: that two of them are one part, in [0, 1]
};

/// Merges the patches of a division. Two cells are one part with the least probability among the merges that join them.
/// \param num_parts 0, or the number of regions that are left: those joined later are surely not one part.
MergedDivision mergedDivision(const PartEvidence& evidence, const MergeWeights& weights, int num_parts);

/// The same surface, looked at in a mirror.
/// \param reflected the element at the reflection of each element.
MergedDivision reflectedDivision(const MergedDivision& division, const std::vector<int>& reflected);

}  // namespace pcl_symmetry
