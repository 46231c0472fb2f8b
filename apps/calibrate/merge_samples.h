/// What merges of patches meet on meshes that people have cut into parts.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/segmentation/merging/region_merging.h"

namespace pcl_symmetry::apps {

/// A merge that was made or refused, and what people say of it.
struct MergeSample {
  Cues cues;
  double together;  ///< share of the pairs of faces, one in each region, that people put into one segment, in [0, 1]
  double weight;    ///< product of the two areas, shares of the surface
};

/// One division of a mesh into patches, with the segments that people made.
struct PeopledDivision {
  PartEvidence evidence;
  std::vector<Eigen::MatrixXd> counts;  ///< per person: faces of each patch (row) in each segment (column)
};

/// \param people the segment of each face, by person.
PeopledDivision peopledDivision(PartEvidence evidence, const std::vector<std::vector<int>>& people);

/// The Rand distances that merging would give if it ended earlier or later.
struct MergeRun {
  std::vector<double> least_log_odds;  ///< falling: of the merges made so far
  std::vector<double> rand;            ///< mean over people after each merge; patches without any merge first
  std::vector<MergeSample> samples;    ///< merges until even odds and a few beyond

  /// \return the Rand distance where merging ends at these log odds.
  double randAt(double log_odds) const;
};

/// Merges all patches of a division.
MergeRun runMerges(const PeopledDivision& division, const MergeWeights& weights);

}  // namespace pcl_symmetry::apps
