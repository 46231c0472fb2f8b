#pragma once

#include <vector>

#include "core/segmentation/regions.h"

namespace pcl_symmetry {

/// Region \p from became part of region \p into.
struct Merge {
  int into, from;
  double log_odds;  ///< that the two are one part, when they were merged
};

/// Merges of neighboring regions, those with the highest log odds first, until no two regions are neighbors.
struct MergeSequence {
  std::vector<Merge> merges;
  std::size_t num_likely = 0;  ///< Number of merges with positive log odds, before the first one without.
};

/// Merges regions, the pair that is most likely one part first. Log odds are updated after each merge.
/// \param regions by value: the merges are made on a copy.
MergeSequence mergeRegions(Regions regions, const MergeWeights& weights);

/// Makes the first merges of a sequence.
/// \param num_merges at most their number.
Regions merged(Regions regions, const std::vector<Merge>& merges, std::size_t num_merges);

}  // namespace pcl_symmetry
